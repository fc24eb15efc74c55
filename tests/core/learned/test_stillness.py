# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is clean and stays bit for bit: planes and smooth places, but nothing that is noisy."""

import numpy as np
import pytest
import region_cases
from checks import random_rotation
from framelet.core import denoise
from meshes import flipped, noisy, prism, quad_grid, triangle_grid, triangle_torus, union


def still_of(mesh):
    """Return which vertices of a mesh keep all bits."""
    return (denoise(mesh).vertices == mesh.vertices).all(axis=1)


def half_rough(build=triangle_grid):
    """Return a sheet that is flat for x up to 4 and rough above."""
    mesh = build(17, 17)
    points = mesh.vertices.copy()
    heights = 0.2 * np.random.default_rng(5).normal(size=len(points))
    points[:, 2] = np.where(points[:, 0] > 4, heights, 0)
    return mesh.with_vertices(points)


def box(size=8):
    """Return a closed cube whose flat sides are cut into triangles."""
    return region_cases.box(size)[0]


FLAT = {
    "half a sheet": half_rough,
    "half an irregular sheet": lambda: half_rough(lambda *sizes: flipped(triangle_grid(*sizes), seed=1)),
    "quads": lambda: half_rough(quad_grid),
    "sheets beside others": lambda: union(half_rough(), noisy(triangle_torus(), np.random.default_rng(0))),
}


@pytest.mark.parametrize("name", FLAT)
def test_flat_parts_are_still_beside_noise(name, rng):
    """However they lie; vertices whose faces are all bent are still by chance only."""
    mesh = FLAT[name]()
    is_flat = (mesh.vertices[:, 0] < 3.5) & (np.abs(mesh.vertices[:, 2]) == 0)
    is_bent = (mesh.vertices[:, 0] > 5.5) & (mesh.vertices[:, 0] < 19)
    mesh = mesh.with_vertices(mesh.vertices @ random_rotation(rng))
    still = still_of(mesh)
    assert is_flat.sum() > 20 and still[is_flat].all()
    assert is_bent.sum() > 100 and still[is_bent].mean() < 0.06


@pytest.mark.parametrize(
    "build", [box, lambda: prism(24), triangle_grid, quad_grid], ids=["cube", "prism", "triangles", "quads"]
)
def test_cubes_prisms_and_sheets_are_still_as_a_whole(build, rng):
    mesh = build()
    assert still_of(mesh.with_vertices(mesh.vertices @ random_rotation(rng) * 3.0)).all()


def test_clean_surfaces_are_still_and_noisy_ones_are_not(rng):
    clean = triangle_torus(40, 60)
    assert still_of(clean).all()
    for sigma in (0.02, 0.1, 0.5):
        assert not still_of(noisy(clean, rng, sigma)).any()


def test_a_spike_on_a_clean_surface_is_not_still():
    clean = triangle_torus(40, 60)
    points = clean.vertices.copy()
    points[1234] *= 1.3
    still = still_of(clean.with_vertices(points))
    assert not still[1234] and still.mean() > 0.95


def test_the_clean_half_of_a_surface_is_still(rng):
    clean = triangle_torus(60, 120)
    is_noisy = clean.vertices[:, 0] > 0
    mesh = clean.with_vertices(np.where(is_noisy[:, None], noisy(clean, rng, 0.2).vertices, clean.vertices))
    still, far = still_of(mesh), np.abs(clean.vertices[:, 0]) > 0.6
    assert still[~is_noisy & far].mean() > 0.95
    assert still[is_noisy & far].mean() < 0.05
