# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The largest displacement, the direction along normals, and all limits under moving and renumbering."""

import numpy as np
import pytest
from checks import assert_same_bits, edge_length, lengths, preset_settings, random_rotation
from framelet.core import PRESETS, Region, denoise
from framelet.core.mesh.geometry import vertex_normals
from meshes import flipped, noisy, triangle_grid, triangle_torus
from region_cases import METHODS, renumbered


@pytest.mark.parametrize("preset", METHODS)
def test_no_vertex_moves_farther(preset, rng):
    mesh = noisy(triangle_torus(), rng)
    settings = PRESETS[preset].settings
    free = lengths(denoise(mesh, settings, region=Region(repair_folds=False)).vertices - mesh.vertices)
    limit = float(np.median(free))
    region = Region(max_displacement=limit, repair_folds=False)
    moved = lengths(denoise(mesh, settings, region=region).vertices - mesh.vertices)
    assert moved.max() <= limit * (1 + 1e-12)
    near = free < limit
    assert np.abs(moved - free)[near].max() < 1e-12
    assert np.abs(moved - limit)[~near].max() < 1e-12


def test_a_limit_of_0_moves_nothing(rng):
    mesh = noisy(triangle_torus(), rng)
    result = denoise(mesh, PRESETS["TRI_2"].settings, region=Region(max_displacement=0.0, keep_volume=True))
    assert_same_bits(result.vertices, mesh.vertices)


@pytest.mark.parametrize("preset", METHODS)
def test_vertices_move_along_the_normals_of_the_denoised_surface(preset, rng):
    mesh = noisy(triangle_torus(), rng)
    settings = PRESETS[preset].settings
    free = denoise(mesh, settings, region=Region(repair_folds=False)).vertices
    normals = vertex_normals(mesh.with_vertices(free))
    region = Region(along_normals=True, repair_folds=False)
    moved = denoise(mesh, settings, region=region).vertices - mesh.vertices
    assert lengths(np.cross(moved, normals)).max() < 1e-12
    assert np.abs(((free - mesh.vertices - moved) * normals).sum(axis=1)).max() < 1e-12


def test_on_a_plane_vertices_do_not_slide(rng):
    """Noise within a plane stays, noise across it goes."""
    mesh = triangle_grid(12, 14)
    mesh = mesh.with_vertices(mesh.vertices + rng.normal(0, 0.15, mesh.vertices.shape))
    settings = PRESETS["TRI_2"].settings
    slides = denoise(mesh, settings).vertices - mesh.vertices
    moved = denoise(mesh, settings, region=Region(along_normals=True)).vertices - mesh.vertices
    assert lengths(moved[:, :2]).mean() < 0.5 * lengths(slides[:, :2]).mean()


def test_folds_come_after_the_limit(rng):
    mesh = noisy(flipped(triangle_torus()), rng, 0.4)
    limit = 0.1 * edge_length(mesh)
    region = Region(max_displacement=limit, keep_volume=True)
    result = denoise(mesh, PRESETS["BILATERAL"].settings, region=region)
    assert lengths(result.vertices - mesh.vertices).max() <= limit * (1 + 1e-12)
    assert result.report.folded_faces <= result.report.folded_faces_before


@pytest.fixture
def case(rng):
    """An irregular noisy torus with everything that a region has."""
    mesh = noisy(flipped(triangle_torus()), rng)
    weights = np.clip(mesh.vertices[:, 0] * 0.4 + 0.6, 0, 1)
    edges = mesh.edges[rng.permutation(mesh.n_edges)[:30]]
    return mesh, {
        "weights": weights,
        "feature_edges": edges,
        "max_displacement": 0.3 * edge_length(mesh),
        "along_normals": True,
        "keep_volume": True,
        "weld_distance": 0.0,
    }


def run(mesh, values, preset="TRI_2", **given):
    return denoise(mesh, preset_settings(preset, **given), region=Region(**values), dtype=np.float64).vertices


def test_moving_and_turning(case, rng):
    mesh, values = case
    rotation, shift = random_rotation(rng), np.array([3.0, -2.0, 5.0])
    turned = run(mesh.with_vertices(mesh.vertices @ rotation + shift), values)
    assert np.abs(turned - run(mesh, values) @ rotation - shift).max() < 1e-8


@pytest.mark.parametrize("scale", [1e-6, 1e6, 2.0**-40])
def test_scaling(scale, case):
    mesh, values = case
    scaled = values | {"max_displacement": values["max_displacement"] * scale}
    found = run(mesh.with_vertices(mesh.vertices * scale), scaled) / scale
    assert np.abs(found - run(mesh, values)).max() < 1e-8


def test_renumbering(case, rng):
    mesh, values = case
    other, new = renumbered(mesh, rng)
    weights = np.empty(mesh.n_vertices)
    weights[new] = values["weights"]
    given = values | {"weights": weights, "feature_edges": new[values["feature_edges"]]}
    assert np.abs(run(other, given)[new] - run(mesh, values)).max() < 1e-8


def test_threads_and_inputs(case):
    mesh, values = case
    values["weights"].flags.writeable = values["feature_edges"].flags.writeable = False
    results = [run(mesh, values, threads=threads) for threads in (1, 2, 4)]
    assert_same_bits(results[0], results[1])
    assert_same_bits(results[0], results[2])
