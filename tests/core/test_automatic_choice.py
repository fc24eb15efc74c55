# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Filtered positions, unfolding, and the choice of a recipe, against their definitions."""

from itertools import pairwise

import numpy as np
import pytest
from checks import assert_same_bits, lengths
from framelet.core import SurfaceMesh, connect
from framelet.core.automatic import choose, patches
from framelet.core.automatic.patches import trial_part
from framelet.core.automatic.recipes import NormalProblem
from framelet.core.automatic.smooth_positions import ORDER, RingAverages, smooth_positions
from framelet.core.blocks import Blocks
from framelet.core.normals.folds import unfold
from framelet.core.normals.noise_sample import area_vectors
from meshes import MESHES, faces_of, noisy, soup, triangle_grid, triangle_torus, union

ROUNDING = 1e-12
ALONE = Blocks(1)
KINDS = {
    **{
        name: MESHES[name]
        for name in ("irregular torus", "quad torus", "mixed sheet", "prism", "three pages")
    },
    "border": MESHES["irregular grid"],
    "soup": lambda: soup(0, shortest=1),
    "empty faces": lambda: SurfaceMesh.from_faces(np.eye(5, 3), [(), (0, 1, 2), (), (2, 4, 0), (3,), ()]),
}
KIND = pytest.mark.parametrize("kind", KINDS)
BLOCKS = pytest.mark.parametrize("blocks", [ALONE, Blocks(1, 7)], ids=["one block", "blocks"])


@KIND
@BLOCKS
def test_averages_over_rings(kind, blocks, rng):
    """On a manifold border over the border alone, so that it does not shrink inwards."""
    mesh = KINDS[kind]()
    connectivity = connect(mesh)
    rings = RingAverages(connectivity, blocks)
    means = rings.outward(rings.mean(rings.inward(np.eye(mesh.n_vertices))))
    found = 0.5 * means + 0.5 * np.eye(mesh.n_vertices)
    expected = np.zeros_like(found)
    for v, (a, b) in enumerate(pairwise(connectivity.ring_offset)):
        near, ends = connectivity.ring[a:b], connectivity.boundary_neighbors[v]
        near = ends if ends[0] >= 0 else near
        np.add.at(
            expected[v], [v, *near], [0.5 if len(near) else 1.0, *[0.5 / max(len(near), 1)] * len(near)]
        )
    assert np.abs(found - expected).max() < ROUNDING
    assert np.abs(found.sum(axis=1) - 1).max() < ROUNDING
    for k in (1, 3):
        power = np.linalg.matrix_power(np.eye(len(found)) - np.linalg.matrix_power(found, k), ORDER)
        smooth = smooth_positions(mesh.vertices.T.copy(), rings, k).T
        assert np.abs(smooth - (mesh.vertices - power @ mesh.vertices)).max() < ROUNDING


@pytest.mark.parametrize("kind", ["irregular torus", "border", "mixed sheet", "three pages"])
@pytest.mark.parametrize(("dtype", "error"), [(np.float64, 1e-11), (np.float32, 1e-5)])
def test_many_averages_at_once_are_those_one_by_one(kind, dtype, error, rng):
    """The series in Chebyshev polynomials against powers of the averages."""
    mesh = noisy(KINDS[kind](), rng)
    rings = RingAverages(connect(mesh), ALONE)
    means = rings.outward(rings.mean(rings.inward(np.eye(mesh.n_vertices))))
    average, one = 0.5 * means + 0.5 * np.eye(mesh.n_vertices), np.eye(mesh.n_vertices)
    for k in (16, 64):
        missing = np.linalg.matrix_power(one - np.linalg.matrix_power(average, k), ORDER)
        expected = mesh.vertices - missing @ mesh.vertices
        found = smooth_positions(mesh.vertices.T.astype(dtype), rings, k).T
        assert found.dtype == dtype
        assert np.abs(found - expected).max() < error


def test_affine_positions_are_kept_inside_a_regular_grid():
    mesh = triangle_grid(40, 41)
    smooth = smooth_positions(mesh.vertices.T.copy(), RingAverages(connect(mesh), ALONE), 2).T
    x, y = np.abs(mesh.vertices[:, :2].T)
    inside = (np.minimum(x, 40 - x) > 10) & (np.minimum(y, 39 - y) > 10)  # k ORDER averages reach as far
    assert inside.sum() > 300
    assert np.abs(smooth - mesh.vertices)[inside].max() < ROUNDING
    assert np.abs(smooth[:, 2]).max() == 0


def problem_of(mesh):
    return NormalProblem(mesh.vertices.T.copy(), mesh, connect(mesh), 0.1, ALONE)


def test_folded_faces_are_unfolded():
    mesh = triangle_grid(7, 7)
    up = np.tile([[0.0], [0.0], [1.0]], mesh.n_faces)
    ring_mean = problem_of(mesh)._ring_mean
    points = mesh.vertices.T.copy()
    up *= np.sign(area_vectors(points, mesh)[2, 0])
    assert unfold(points, up, mesh, ring_mean) is points
    folded = points.copy()
    folded[:, 24] += [1.6, 0.3, 0.0]
    assert ((area_vectors(folded, mesh) * up).sum(axis=0) < 0).any()
    given = folded.copy()
    found = unfold(folded, up, mesh, ring_mean)
    assert ((area_vectors(found, mesh) * up).sum(axis=0) >= 0).all()
    assert_same_bits(folded, given)
    far = lengths((points - points[:, 24:25]).T) > 3.5
    assert_same_bits(found[:, far], points[:, far])


def test_what_cannot_be_unfolded_is_not_made_worse(rng):
    mesh = triangle_grid(7, 7)
    wanted = rng.normal(size=(3, mesh.n_faces))
    points = mesh.vertices.T.copy()
    found = unfold(points, wanted, mesh, problem_of(mesh)._ring_mean)
    before, after = (
        (np.einsum("cf,cf->f", area_vectors(x, mesh), wanted) < 0).sum() for x in (points, found)
    )
    assert 0 < after <= before


def test_small_meshes_are_tried_whole():
    mesh = triangle_torus()
    part = trial_part(mesh.vertices.T, mesh)
    assert part.surface is mesh
    assert part.counts.all() and np.array_equal(part.vertices, np.arange(mesh.n_vertices))


@pytest.mark.parametrize("kind", ["triangles", "mixed"])
def test_parts_of_large_meshes(kind, rng):
    large = triangle_torus(60, 80)
    mesh = noisy(
        large if kind == "triangles" else union(large, MESHES["mixed sheet"](), MESHES["prism"]()), rng
    )
    part = trial_part(mesh.vertices.T, mesh)
    least = patches.FACES_IN_PATCH + 1
    assert least < part.surface.n_faces <= patches.N_PATCHES * least < mesh.n_faces
    assert_same_bits(part.surface.vertices, mesh.vertices[part.vertices])
    assert np.array_equal(part.vertices, np.unique(part.vertices))
    faces = {tuple(face) for face in faces_of(mesh)}
    found = [tuple(part.vertices[face].tolist()) for face in faces_of(part.surface)]
    assert len(set(found)) == len(found) and set(found) <= faces
    assert 0.1 < part.counts.mean() < 0.9
    on_rim = connect(part.surface).is_boundary & ~connect(mesh).is_boundary[part.vertices]
    assert on_rim.any() and not (part.counts & on_rim).any()
    # Wherever a vertex counts, all of its faces are there.
    sizes = [np.bincount(m.corner_vertex, minlength=m.n_vertices) for m in (part.surface, mesh)]
    assert (sizes[0] == sizes[1][part.vertices])[part.counts].all()


def test_the_best_has_the_lowest_risk_times_squared_roughness():
    best = choose._best
    assert best([0.5, 0.2, 0.3], [1.0, 1.0, 1.0]) == 1
    assert best([0.5, 0.2, 0.3], [1.0, 2.0, 1.1]) == 2
    assert best([0.3, 0.3], [0.0, 0.0]) == 0
    assert best([0.5], [1.0]) == 0
