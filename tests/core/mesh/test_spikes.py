# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Spikes are found on clean and noisy meshes, and nothing else is; flattened they lie in the surface."""

import numpy as np
import pytest
from checks import assert_same_bits
from framelet.core import RegionError
from framelet.core.mesh.spikes import find_spikes, flattened
from meshes import noisy, pyramid, quad_torus, triangle_grid, triangle_torus, union


def with_spikes(surface, rng, number, height):
    """Return a mesh some of whose vertices, which are not close to each other, stick out, and these."""
    chosen = rng.permutation(surface.n_vertices)[:1]
    for vertex in rng.permutation(surface.n_vertices):
        if np.linalg.norm(surface.vertices[chosen] - surface.vertices[vertex], axis=1).min() > 1.8:
            chosen = np.append(chosen, vertex)
    chosen = np.sort(chosen[:number])
    points = surface.vertices.astype(float)
    directions = rng.standard_normal((len(chosen), 3))
    points[chosen] += height * directions / np.linalg.norm(directions, axis=1)[:, None]
    return surface.with_vertices(points), chosen


@pytest.mark.parametrize("sigma", [0.0, 0.2])
@pytest.mark.parametrize("unit", [1e-4, 1.0, 1e4])
def test_all_spikes_are_found_and_nothing_else(sigma, unit, rng):
    torus = triangle_torus(24, 72)
    clean = noisy(torus, rng, sigma) if sigma else torus
    surface, chosen = with_spikes(clean, rng, 12, 4.0)
    assert len(chosen) == 12
    surface = surface.with_vertices(unit * surface.vertices)
    assert np.flatnonzero(find_spikes(surface)).tolist() == chosen.tolist()


@pytest.mark.parametrize("surface", [triangle_torus(), quad_torus(), triangle_grid(), pyramid()])
def test_clean_meshes_have_none(surface):
    assert not find_spikes(surface).any()


def test_strong_noise_is_no_spike(rng):
    assert not find_spikes(noisy(triangle_torus(24, 72), rng, 0.4)).any()


def test_flattened_spikes_lie_in_the_surface_and_all_else_keeps_its_bits(rng):
    torus = triangle_torus(24, 72)
    surface, chosen = with_spikes(torus, rng, 12, 4.0)
    result = flattened(surface, find_spikes(surface))
    rest = np.setdiff1d(np.arange(torus.n_vertices), chosen)
    assert_same_bits(result[rest], surface.vertices[rest])
    assert np.linalg.norm(result[chosen] - torus.vertices[chosen], axis=1).max() < 0.1


def test_a_small_mesh_beside_a_large_one_is_no_spike():
    far = triangle_grid(3, 2)
    far = far.with_vertices(far.vertices + 100.0)
    assert not find_spikes(union(triangle_torus(), far)).any()


@pytest.mark.parametrize("given", [{"length": 1.0}, {"length": float("nan")}, {"most": 0}])
def test_wrong_numbers_are_refused(given):
    with pytest.raises(RegionError, match="spike"):
        find_spikes(triangle_grid(), **given)
