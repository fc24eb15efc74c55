# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Filtered positions, unfolding, and the choice of a recipe, against their definitions."""

from itertools import pairwise

import numpy as np
import pytest
from checks import assert_same_bits, lengths
from framelet.core import connect
from framelet.core.automatic import patches, score
from framelet.core.automatic.patches import trial_part
from framelet.core.automatic.problem import NormalProblem
from framelet.core.automatic.recipes import RECIPES
from framelet.core.automatic.roughness import Roughness
from framelet.core.automatic.smooth_positions import ORDER, RingAverages, smooth_positions
from framelet.core.denoising.constraints import find_constraints
from framelet.core.normals.folds import unfold
from framelet.core.normals.noise_sample import area_vectors
from framelet.core.settings import PRESETS
from kinds import ALONE, BLOCKS, KIND, KINDS
from meshes import MESHES, faces_of, noisy, triangle_grid, triangle_torus, union
from twins import faces_across, newell

ROUNDING = 1e-12


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
    ring_mean = problem_of(mesh).ring_mean
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
    found = unfold(points, wanted, mesh, problem_of(mesh).ring_mean)
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
    large = triangle_torus(80, 100)
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


def test_rims_of_parts_do_not_touch_themselves(rng, monkeypatch):
    """A vertex that is not manifold in the part is not in the mesh either."""
    mesh = noisy(triangle_torus(40, 50), rng, 0.4)
    pages = MESHES["three pages"]()
    both = union(mesh, pages)
    monkeypatch.setattr(patches, "WHOLE", 100)
    monkeypatch.setattr(patches, "FACES_IN_PATCH", 61)
    found = {}
    for rounds in (0, patches.TRIMMINGS):
        monkeypatch.setattr(patches, "TRIMMINGS", rounds)
        found[rounds] = part = trial_part(both.vertices.T, both)
        assert part.counts.any() and part.surface.n_faces > 100
    untrimmed, part = found.values()
    assert connect(untrimmed.surface).is_non_manifold[untrimmed.vertices < mesh.n_vertices].any()
    assert not connect(part.surface).is_non_manifold[part.vertices < mesh.n_vertices].any()


def judged(risk, first, second):
    """Return what `score.scores` takes."""
    return np.stack((risk, first, second), axis=1)


def test_scores_are_risks_times_powers_of_roughness():
    of = score.scores
    risk, plain = np.array([0.5, 0.2, 0.3]), np.ones(3)
    assert of(judged(risk, plain, plain)).argmin() == 1
    assert of(judged(risk, np.array([1.0, 99.0, 1.1]), plain)).argmin() == 2
    assert of(judged(risk, plain, np.array([1.0, 99.0, 1.1]))).argmin() == 2
    # Risks below zero lift all of them: their differences stay.
    lifted = of(judged(risk - 0.4, plain, plain))
    assert np.abs(np.diff(lifted) - np.diff(risk)).max() < 1e-12
    assert lifted.min() == pytest.approx(score.UNCERTAINTY)
    # The stronger, the more smoothness counts; at strength 0 the risk alone does.
    smoother = np.array([0.5, 1.0, 1.0])
    assert of(judged(risk, smoother, plain)).argmin() == 1
    assert of(judged(risk, smoother, plain), strength=8.0).argmin() == 0
    assert np.allclose(of(judged(risk, smoother, plain), strength=0.0), risk + score.UNCERTAINTY)
    # Where all are perfectly smooth, the risk alone decides.
    assert np.allclose(of(judged(risk, 0 * plain, 0 * plain)), risk + score.UNCERTAINTY)


def test_scores_after_a_rehearsal_are_powers_of_all_that_is_known(rng):
    table, angles = rng.uniform(0.1, 2.0, (7, 3)), rng.uniform(1.0, 9.0, 7)
    found = np.log(score.scores(table, angles, strength=1.3))
    risk, first, second, angle = score.REHEARSED
    expected = risk * np.log(table[:, 0] + score.UNCERTAINTY) + angle * np.log(angles)
    expected += 1.3 * (first * np.log(table[:, 1]) + second * np.log(table[:, 2]))
    assert np.abs((found - expected) - (found - expected)[0]).max() < 1e-12
    alike = np.tile(table[:1], (7, 1))
    assert score.scores(alike, angles).argmin() == angles.argmin()


def test_roughness_against_a_loop(rng):
    mesh = noisy(triangle_torus(8, 10), rng)
    problem = problem_of(mesh)
    counted = rng.random(mesh.n_vertices) < 0.8
    quarter, bend = Roughness(problem, counted).of(mesh.vertices.T)
    normals = np.array([newell(mesh.vertices[face]) for face in faces_of(mesh)])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    apart, bends = [], []
    for face, near in enumerate(faces_across(mesh)):
        corners = faces_of(mesh)[face]
        pairs = [other for corner, other in zip(corners, near, strict=True) if counted[corner]]
        apart += [np.linalg.norm(normals[face] - normals[other]) for other in pairs]
        if len(pairs) == len(near):
            bends.append(np.linalg.norm(normals[face] - normals[near].mean(axis=0)))
    assert quarter == pytest.approx(np.sort(apart)[len(apart) // 4], rel=1e-9)
    assert bend == pytest.approx(np.sqrt(np.mean(np.square(bends))), rel=1e-9)


def test_roughness_of_nothing():
    mesh = MESHES["single triangle"]()
    assert Roughness(problem_of(mesh), np.ones(3, bool)).of(mesh.vertices.T) == (0.0, 0.0)


@KIND
def test_smoothing_before_acts_on_the_noise_alike(kind, rng):
    """What a recipe is told of the noise that is left is what smoothing does to a number at each vertex."""
    problem = problem_of(noisy(KINDS[kind](), rng))
    start = problem.start(4)
    assert_same_bits(start.points, smooth_positions(problem.noisy, problem.rings, 4))
    heights = np.tile(problem.sample, (3, 1))
    assert np.abs(start.sample - smooth_positions(heights, problem.rings, 4)[1]).max() < 1e-12
    assert problem.start(4) is start
    assert 0 <= problem.units[4] <= 2
    assert_same_bits(problem.start(0).points, problem.noisy)
    assert_same_bits(problem.start(0).sample, problem.sample)


def test_vertices_that_may_not_move_stay_where_they_were_before_smoothing(rng):
    mesh = noisy(triangle_torus(8, 10), rng)
    movable = rng.random(mesh.n_vertices) < 0.5
    settings = PRESETS["AUTO"].settings
    constraints = find_constraints(mesh, connect(mesh), settings, movable, np.dtype(float))
    for recipe in RECIPES:
        points = problem_of(mesh).run(recipe, constraints)
        assert_same_bits(points[:, ~movable], mesh.vertices.T[:, ~movable])
        assert (points != mesh.vertices.T).any()
