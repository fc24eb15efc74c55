# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Closed meshes keep their volume."""

import numpy as np
import pytest
from checks import assert_same_bits, edge_length, lengths
from framelet.core import PRESETS, DenoiseSettings, Region, denoise
from framelet.core.limits.volume import volume_offset
from meshes import (
    flipped,
    noisy,
    octahedron,
    prism,
    quad_torus,
    tetrahedron,
    triangle_grid,
    triangle_torus,
    union,
)
from region_cases import METHODS
from twins import signed_volume

SHRINKING = DenoiseSettings(method="POSITIONS", frame="BOX_SPLINE_111", lambda_=2.0, iterations=30)
MESHES = {
    "torus": triangle_torus,
    "irregular torus": lambda: flipped(triangle_torus()),
    "quad torus": lambda: quad_torus(12, 16),
    "two parts": lambda: union(triangle_torus(), flipped(triangle_torus(6, 9))),
    "prism": prism,
    "octahedron": octahedron,
    "tetrahedron": tetrahedron,
}


def change(mesh, vertices):
    before = signed_volume(mesh)
    return (signed_volume(mesh.with_vertices(vertices)) - before) / before


@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize("preset", [*METHODS, "SHRINKING"])
def test_the_volume_stays(name, preset, rng):
    mesh = noisy(MESHES[name](), rng, 0.1)
    settings = SHRINKING if preset == "SHRINKING" else PRESETS[preset].settings
    result = denoise(mesh, settings, region=Region(keep_volume=True))
    assert abs(change(mesh, result.vertices)) < 1e-5
    assert result.report.volume_change == pytest.approx(change(mesh, result.vertices), abs=1e-9)
    assert result.report.folded_faces <= result.report.folded_faces_before


def test_without_it_the_volume_does_change(rng):
    """So that the test above means something."""
    mesh = noisy(triangle_torus(), rng, 0.1)
    assert denoise(mesh, SHRINKING).report.volume_change < -0.05


def test_single_precision_far_away_is_good_enough(rng):
    mesh = noisy(triangle_torus(24, 32), rng, 0.1)
    mesh = mesh.with_vertices((mesh.vertices + 100.0).astype(np.float32))
    result = denoise(mesh, SHRINKING, region=Region(keep_volume=True))
    assert abs(change(mesh, result.vertices)) < 1e-4


def test_meshes_turned_inside_out_keep_it_too(rng):
    mesh = noisy(triangle_torus(), rng, 0.1)
    mesh = mesh.with_vertices(mesh.vertices * [-1, 1, 1])
    assert signed_volume(mesh) * signed_volume(triangle_torus()) < 0
    result = denoise(mesh, SHRINKING, region=Region(keep_volume=True))
    assert abs(change(mesh, result.vertices)) < 1e-5


def test_vertices_that_stay_do_so(rng):
    mesh = noisy(triangle_torus(24, 32), rng, 0.1)
    movable = mesh.vertices[:, 0] > 0
    lines = mesh.edges[np.flatnonzero(movable[mesh.edges].all(axis=1))[:3]]
    result = denoise(mesh, SHRINKING, movable=movable, region=Region(keep_volume=True, feature_edges=lines))
    assert_same_bits(result.vertices[~movable], mesh.vertices[~movable])
    assert abs(change(mesh, result.vertices)) < 1e-5


def test_the_limit_comes_first(rng):
    mesh = noisy(triangle_torus(), rng, 0.1)
    limit = 0.02 * edge_length(mesh)
    region = Region(keep_volume=True, max_displacement=limit)
    result = denoise(mesh, SHRINKING, region=region)
    assert lengths(result.vertices - mesh.vertices).max() <= limit * (1 + 1e-12)
    free = denoise(mesh, SHRINKING, region=Region(max_displacement=limit))
    assert abs(result.report.volume_change) <= abs(free.report.volume_change)


def test_open_meshes_have_none_to_keep(rng):
    mesh = noisy(triangle_grid(), rng)
    settings = PRESETS["TRI_2"].settings
    result = denoise(mesh, settings, region=Region(keep_volume=True))
    assert_same_bits(result.vertices, denoise(mesh, settings).vertices)
    assert result.report.volume_change is None


@pytest.mark.parametrize("target", [0.0, 1.0, -3.0, 20.0])
@pytest.mark.parametrize("area", [3.0, 0.2])
def test_the_offset_solves_a_cubic(target, area):
    offset = volume_offset(lambda t: 2.0 + 3.0 * t + 0.5 * t**2 + 0.1 * t**3, target, area)
    assert 2.0 + 3.0 * offset + 0.5 * offset**2 + 0.1 * offset**3 == pytest.approx(target, abs=1e-5)


def test_an_offset_that_cannot_be_found_is_the_closest():
    """A volume that saturates, as with a limit on the displacements."""
    asked = []

    def volume_at(t):
        asked.append(t)
        return 1.0 + np.tanh(t)

    offset = volume_offset(volume_at, 5.0, 1.0)
    assert 1.0 + np.tanh(offset) == max(1.0 + np.tanh(t) for t in asked) > 1.99
    assert len(asked) < 40


def test_nothing_to_do_is_done_at_once():
    asked = []
    assert volume_offset(lambda t: asked.append(t) or 2.0, 2.0, 1.0) == 0.0
    assert asked == [0.0]
    assert volume_offset(lambda _: 3.0, 2.0, 0.0) == 0.0
