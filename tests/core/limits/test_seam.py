# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the vertices beside a seam move in common fades in; the rest of their motion is made in full."""

import numpy as np
import pytest
from checks import assert_same_bits
from framelet.core.limits.seam import RINGS, fade_shift_in, faded_in, rings_beside
from framelet.core.mesh.geometry import vertex_normals
from meshes import flipped, mixed_sheet, triangle_torus
from region_cases import rings_from


@pytest.fixture
def torus():
    """A torus, its normals in rows, and the half of it that stays."""
    mesh = triangle_torus(24, 64)
    return mesh, vertex_normals(mesh).T, mesh.vertices[:, 0] <= 0.1


@pytest.mark.parametrize("make", [triangle_torus, lambda: flipped(triangle_torus()), mixed_sheet])
def test_rings_match_a_loop(make, rng):
    mesh = make()
    for share in (0.0, 0.02, 0.5, 1.0):
        stays = rng.random(mesh.n_vertices) < share
        expected = np.minimum(rings_from(mesh, stays), RINGS)
        assert rings_beside(stays, mesh.edges).tolist() == expected.tolist()


def test_the_share_grows_smoothly():
    share = faded_in(np.arange(8))
    assert share[0] == 0.0
    assert (share[RINGS:] == 1.0).all()
    assert (np.diff(share[: RINGS + 1]) > 0).all()
    assert np.allclose(share[: RINGS + 1] + share[RINGS::-1], 1.0)


def test_a_shift_fades_in(torus):
    mesh, normals, stays = torus
    found = normals * np.where(stays, 0.0, -0.3)
    fade_shift_in(found, normals, stays, np.zeros(0, int), mesh.edges)
    expected = normals * (-0.3 * faded_in(rings_beside(stays, mesh.edges)))
    assert np.abs(found - expected).max() < 1e-12


def test_a_shift_that_is_not_across_the_surface_is_not_one(torus, rng):
    mesh, normals, stays = torus
    along = np.cross(normals.T, rng.normal(size=3)).T * ~stays
    found = along.copy()
    fade_shift_in(found, normals, stays, np.zeros(0, int), mesh.edges)
    assert np.abs(found - along).max() < 1e-12


def test_noise_is_removed_up_to_the_seam(torus, rng):
    """Motions of chance, without a shift: they must not be damped."""
    mesh, normals, stays = torus
    motion = normals * (rng.normal(0, 0.2, mesh.n_vertices) * ~stays)
    found = motion.copy()
    fade_shift_in(found, normals, stays, np.zeros(0, int), mesh.edges)
    changed = np.linalg.norm(found - motion, axis=0)
    assert changed.max() < 0.1
    assert (changed > 0.02).mean() < 0.01


def test_noise_and_shift_together(torus, rng):
    mesh, normals, stays = torus
    height = (rng.normal(0, 0.2, mesh.n_vertices) - 0.5) * ~stays
    found = normals * height
    fade_shift_in(found, normals, stays, np.zeros(0, int), mesh.edges)
    ring = rings_beside(stays, mesh.edges)
    left = (found * normals).sum(axis=0)
    assert abs(left[ring == 1].mean()) < 0.3
    assert left[ring == 1].std() == pytest.approx(height[ring == 1].std(), rel=0.2)
    assert_same_bits(found[:, ring == RINGS], (normals * height)[:, ring == RINGS])


def test_pinned_vertices_and_whole_meshes_are_left_alone(torus, rng):
    mesh, normals, stays = torus
    motion = normals * -0.3 * ~stays
    pinned = rng.permutation(mesh.n_vertices)[:200]
    found = motion.copy()
    fade_shift_in(found, normals, stays, pinned, mesh.edges)
    assert_same_bits(found[:, pinned], motion[:, pinned])
    assert (found != motion).any()
    for all_or_none in (np.zeros_like(stays), np.ones_like(stays)):
        found = motion.copy()
        fade_shift_in(found, normals, all_or_none, np.zeros(0, int), mesh.edges)
        assert_same_bits(found, motion)


def test_small_parts_move_in_full(torus):
    """A ring of a few vertices tells nothing of a shift: what they have in common may be chance."""
    mesh, normals, _ = torus
    center = mesh.vertices - mesh.vertices[100]
    for radius in (0.01, 0.5):
        stays = np.linalg.norm(center, axis=1) > radius
        motion = normals * -0.3 * ~stays
        found = motion.copy()
        fade_shift_in(found, normals, stays, np.zeros(0, int), mesh.edges)
        assert_same_bits(found, motion)
    stays = np.linalg.norm(center, axis=1) > 2.5
    found = normals * -0.3 * ~stays
    fade_shift_in(found, normals, stays, np.zeros(0, int), mesh.edges)
    ring = rings_beside(stays, mesh.edges)
    assert np.linalg.norm(found[:, ring == 1], axis=0).max() < 0.1
