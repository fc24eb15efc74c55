# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Weights blend, weight 0 keeps bits, and the seam between a region and the rest is smooth."""

import numpy as np
import pytest
from checks import assert_same_bits, edge_length, lengths
from framelet.core import PRESETS, DenoiseSettings, Region, denoise
from framelet.core.mesh.geometry import vertex_normals
from meshes import noisy, triangle_grid, triangle_torus
from region_cases import METHODS, dihedral_angles, rings_from

SHRINKING = DenoiseSettings(method="POSITIONS", frame="BOX_SPLINE_111", lambda_=2.0, iterations=30)
"""Removes so much that a torus becomes visibly thinner, and a hard seam would be a step."""


@pytest.mark.parametrize("preset", METHODS)
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_weight_0_keeps_bits(preset, dtype, rng):
    mesh = noisy(triangle_torus(), rng)
    vertices = mesh.vertices.astype(dtype)
    vertices[::3, 1] = -0.0
    mesh = mesh.with_vertices(vertices)
    weights = rng.random(mesh.n_vertices)
    weights[::2] = 0.0
    region = Region(weights=weights, keep_volume=True, along_normals=True, max_displacement=0.3)
    result = denoise(mesh, PRESETS[preset].settings, region=region)
    assert_same_bits(result.vertices[::2], mesh.vertices[::2])
    assert result.report.n_moved <= np.count_nonzero(weights)
    assert result.report.n_moved > 0.5 * np.count_nonzero(weights)


@pytest.mark.parametrize("preset", METHODS)
def test_weights_are_shares_of_the_motion(preset, rng):
    mesh = noisy(triangle_torus(), rng)
    weights = rng.uniform(0.1, 1.0, mesh.n_vertices)
    settings = PRESETS[preset].settings
    whole = denoise(mesh, settings, region=Region(repair_folds=False)).vertices - mesh.vertices
    region = Region(weights=weights, repair_folds=False)
    part = denoise(mesh, settings, region=region).vertices - mesh.vertices
    assert lengths(whole).max() > 0.01
    assert np.abs(part - weights[:, None] * whole).max() < 1e-12


def test_weight_0_is_as_good_as_not_movable(rng):
    mesh = noisy(triangle_torus(), rng)
    movable = rng.random(mesh.n_vertices) < 0.5
    settings = PRESETS["TRI_2"].settings
    by_weights = denoise(mesh, settings, region=Region(weights=movable.astype(float)))
    assert_same_bits(by_weights.vertices, denoise(mesh, settings, movable=movable).vertices)


@pytest.fixture
def half(rng):
    """A torus with noise along its normals, half of it selected, and the rings counted from the seam."""
    clean = triangle_torus(24, 64)
    height = rng.normal(0, 0.2 * edge_length(clean), (clean.n_vertices, 1))
    mesh = clean.with_vertices(clean.vertices + height * vertex_normals(clean))
    movable = clean.vertices[:, 0] > 0.1
    return clean, mesh, movable, rings_from(mesh, ~movable)


@pytest.mark.parametrize("keep_volume", [False, True])
@pytest.mark.parametrize("run", [*METHODS, "SHRINKING"])
def test_the_seam_is_no_step(run, keep_volume, half):
    """The mean height over the clean surface, which is 0 outside, changes ring by ring, not at once."""
    clean, mesh, movable, ring = half
    settings = SHRINKING if run == "SHRINKING" else PRESETS[run].settings
    region = Region(weights=movable.astype(float), keep_volume=keep_volume)
    result = denoise(mesh, settings, region=region).vertices
    whole = denoise(mesh, settings).vertices

    def heights(vertices):
        return ((vertices - clean.vertices) * vertex_normals(clean)).sum(axis=1) / edge_length(clean)

    height, deep = heights(result), abs(heights(whole).mean())
    means = [height[ring == k].mean() for k in range(9)]
    noise_of_means = 0.2 / np.sqrt(np.count_nonzero(ring == 1))
    steps = np.abs(np.diff(means))
    assert steps[0] < max(0.4 * deep, 3 * noise_of_means)
    assert steps.max() < max(0.5 * deep, 3 * noise_of_means)
    if run == "SHRINKING":
        assert deep > 1.0  # so that there is something to step over


@pytest.mark.parametrize("preset", METHODS)
def test_displacements_jump_no_more_across_the_seam_than_inside(preset, half):
    _, mesh, movable, ring = half
    moved = denoise(mesh, PRESETS[preset].settings, movable=movable).vertices - mesh.vertices
    one, other = mesh.edges.T
    jump = lengths(moved[one] - moved[other])
    low, high = np.minimum(ring[one], ring[other]), np.maximum(ring[one], ring[other])
    across, inside = jump[(low == 0) & (high == 1)], jump[low >= 3]
    assert np.sqrt(np.mean(across**2)) < np.sqrt(np.mean(inside**2))


@pytest.mark.parametrize("preset", METHODS)
def test_beside_clean_vertices_the_seam_is_as_flat_as_the_inside(preset, rng):
    """Noise in the selection alone: the angles at the seam must not stick out."""
    clean = triangle_grid(30, 40)
    movable = clean.vertices[:, 0] > 19.5
    ring = rings_from(clean, ~movable)
    height = np.where(movable, rng.normal(0, 0.2, clean.n_vertices), 0.0)
    mesh = clean.with_vertices(clean.vertices + height[:, None] * [0, 0, 1])
    result = denoise(mesh, PRESETS[preset].settings, movable=movable).vertices
    edges, angle = dihedral_angles(mesh.with_vertices(result))
    low, high = ring[edges].min(axis=1), ring[edges].max(axis=1)
    inner = (np.abs(clean.vertices[edges, 1] + 14.5) < 12).all(axis=1)
    at_seam, is_inside = (low <= 1) & (high >= 1) & inner, (low >= 3) & (high <= 8) & inner
    before = dihedral_angles(mesh)[1][is_inside].mean()
    assert angle[at_seam].mean() < max(1.1 * angle[is_inside].mean(), 0.03 * before)
