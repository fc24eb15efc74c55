# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The fit of vertices to normals against the linear problem that it solves, dense."""

import numpy as np
import pytest
from checks import assert_same_bits
from framelet.core import connect
from framelet.core.averages.ring_means import RingMeans
from framelet.core.blocks import Blocks
from framelet.core.learned import normal_equations, screened_fit, unfolding
from framelet.core.learned.engine import FaceEngine, long_edges
from framelet.core.mesh.geometry import fan_areas
from kinds import ALONE, KIND, KINDS
from learned_twins import chebyshev_steps, face_order, fit_problem, ring_matrix, slow_start
from meshes import MESHES, faces_of, noisy, quad_torus, triangle_grid, triangle_torus
from twins import newell

SINGLE = 1e-4
FITTED = {
    **{name: KINDS[name] for name in ("irregular torus", "quad torus", "mixed sheet", "prism", "border")},
    "non-manifold": KINDS["three pages"],
    "soup": KINDS["soup"],
    "single triangle": MESHES["single triangle"],
}
FIT = pytest.mark.parametrize("name", FITTED)


def fit_of(mesh, blocks=ALONE, **sizes):
    return FaceEngine(mesh, connect(mesh), blocks, **sizes).fit


def points_of(mesh):
    return np.ascontiguousarray(mesh.vertices.T, np.float32)


def normals_of(mesh):
    """Return unit normals of the faces of the graph, shape (F, 3); zero for faces without area."""
    faces = faces_of(mesh)
    vectors = np.array([newell(mesh.vertices[faces[f]]) for f in face_order(mesh)])
    return vectors / np.maximum(np.linalg.norm(vectors, axis=1), 1e-30)[:, None]


def needle_weights(mesh):
    """Return 1 for each face of the graph, and less where it is thin."""
    weights, faces = [], faces_of(mesh)
    for f in face_order(mesh):
        points = mesh.vertices[faces[f]]
        longest = max(((points - np.roll(points, 1, axis=0)) ** 2).sum(axis=1))
        weights.append(min(1.0, 10 * 2 * np.linalg.norm(newell(points)) / max(longest, 1e-30)) ** 2)
    return weights


def wanted(mesh, rng, amount=0.4):
    """Return the normals of the mesh, somewhat turned, shape (3, F), float32."""
    normals = normals_of(mesh) + amount * rng.normal(size=(len(face_order(mesh)), 3))
    return np.ascontiguousarray((normals / np.linalg.norm(normals, axis=1)[:, None]).T, np.float32)


def expected_fit(mesh, normals, n_steps, held=(), weights=None):
    """Return what the steps give, the energies before, after and at the minimum, and all eigenvalues."""
    weights = needle_weights(mesh) if weights is None else weights
    form, gradient, valence = fit_problem(mesh, normals.T.astype(float), weights)
    free = np.repeat(~np.isin(np.arange(mesh.n_vertices), held) & (valence > 0), 3)
    form, gradient = form[np.ix_(free, free)], gradient[free]
    scale = np.repeat(2 * valence, 3)[free]
    own, values = chebyshev_steps(
        form, gradient, scale, n_steps, normal_equations.LOWEST, normal_equations.HIGHEST
    )
    best = -np.linalg.lstsq(form, gradient, rcond=None)[0]
    energies = [0.5 * x @ form @ x + gradient @ x for x in (0 * own, own, best)]
    motion = np.zeros(3 * mesh.n_vertices)
    motion[free] = own
    return mesh.vertices + motion.reshape(-1, 3), energies, values


AS_SOLVED = {"least_outliers": 2.0, "rounds": 0}
"""The linear problem alone, without outliers."""


@FIT
@pytest.mark.parametrize("is_held", [False, True])
def test_the_fit_is_a_polynomial_in_the_dense_problem(name, is_held, rng):
    """And comes near the minimum of the energy; what is held keeps its bits."""
    mesh = noisy(FITTED[name](), rng)
    normals, points = wanted(mesh, rng), points_of(mesh)
    is_free = rng.random(mesh.n_vertices) < 0.6 if is_held else np.ones(mesh.n_vertices, bool)
    held = np.flatnonzero(~is_free)
    given = points.copy()
    found = fit_of(mesh).fit(points, normals, is_free, **AS_SOLVED)
    expected, (before, after, best), values = expected_fit(mesh, normals, screened_fit.STEPS, held)
    assert np.abs(found.T - expected).max() < SINGLE
    assert_same_bits(found[:, held], points[:, held])
    assert_same_bits(points, given)
    assert values.max() < normal_equations.HIGHEST
    assert best <= after <= before + 1e-12
    if is_free.any() and mesh.n_faces > 1:
        assert after - best < 0.05 * (before - best)


@pytest.mark.parametrize("is_held", [False, True])
@pytest.mark.parametrize("name", ["torus", "quads", "sheet"])
@pytest.mark.usefixtures("exact")
def test_outliers_are_held_at_the_height_of_their_rings(name, is_held, rng):
    """Two fits, the second from where outliers are as high as those around that are none."""
    clean = {"torus": triangle_torus, "quads": quad_torus, "sheet": triangle_grid}[name](14, 16)
    mesh = spiked(noisy(clean, rng, 0.02), rng)
    normals, points = np.ascontiguousarray(normals_of(clean).T, np.float32), points_of(mesh)
    is_free = rng.random(mesh.n_vertices) < 0.7 if is_held else np.ones(mesh.n_vertices, bool)
    held, weights = np.flatnonzero(~is_free), needle_weights(mesh)
    first = expected_fit(mesh, normals, screened_fit.STEPS, held)[0]
    far = mesh.edges[long_edges(mesh, connect(mesh))].tolist()
    start, sure = slow_start(mesh.vertices, first, is_free, ring_matrix(mesh, far))
    assert sure > 1e-3 and 3 <= (start != mesh.vertices).any(axis=1).sum() < 20
    given = points.copy()
    found = fit_of(mesh).fit(points, normals, is_free, rounds=0)
    second = expected_fit(mesh.with_vertices(start), normals, screened_fit.STEPS, held, weights)[0]
    assert np.abs(found.T - second).max() < 5 * SINGLE
    assert np.abs(first - second).max() > 0.1
    assert_same_bits(found[:, held], points[:, held])
    assert_same_bits(points, given)


def spiked(mesh, rng, n_spikes=6, height=2.0):
    """Return a mesh with a few of its vertices far off."""
    points = mesh.vertices.copy()
    chosen = rng.permutation(mesh.n_vertices)[:n_spikes]
    edge = np.linalg.norm(points[mesh.edges[0, 0]] - points[mesh.edges[0, 1]])
    points[chosen] += height * edge * rng.normal([0, 0, 3], 1, (n_spikes, 3))
    return mesh.with_vertices(points)


def test_spikes_do_not_lift_what_is_around():
    """With the right normals a spike comes down, and what is around it stays as low as it is."""
    clean = triangle_grid(31, 31)
    points = clean.vertices.copy()
    points[480, 2] = 4.0
    normals = np.ascontiguousarray(normals_of(clean).T, np.float32)
    found = fit_of(clean).fit(points_of(clean.with_vertices(points)), normals)
    assert np.abs(found[2]).max() < 0.02 * 4.0
    assert np.abs(np.delete(found[2], 480)).max() < 0.02


def test_what_does_not_move_is_no_outlier(monkeypatch):
    """Means of zeros that rounding makes negative once made outliers without a direction, and NaN of them."""
    exact = RingMeans.averaged

    def rounded(self, field, n_averages):
        return exact(self, field, n_averages) - np.float32(1e-9)

    monkeypatch.setattr(RingMeans, "averaged", rounded)
    sheet = triangle_grid(31, 31)
    points = sheet.vertices.copy()
    points[[200, 480, 700], 2] = 4.0
    normals = np.ascontiguousarray(normals_of(sheet).T, np.float32)
    assert np.isfinite(fit_of(sheet).fit(points_of(sheet.with_vertices(points)), normals)).all()


def test_gaussian_noise_has_no_outliers(rng):
    """Nothing is held elsewhere, so that the fit of white noise is the linear problem alone."""
    clean = triangle_torus(30, 60)
    mesh = noisy(clean, rng, 0.1)
    normals = np.ascontiguousarray(normals_of(clean).T, np.float32)
    fit = fit_of(mesh)
    solved = fit._solved(
        points_of(mesh), normals, fit._needle_weights(points_of(mesh)), screened_fit.STEPS, None
    )
    assert fit._without_outliers(points_of(mesh), solved, None, None, screened_fit.LEAST_OUTLIERS) is None


def test_needles_count_less(rng):
    mesh = noisy(KINDS["mixed sheet"](), rng)
    thin = mesh.vertices * [1, 0.02, 1]
    mesh = mesh.with_vertices(thin)
    found = fit_of(mesh)._needle_weights(points_of(mesh))
    expected = needle_weights(mesh)
    assert np.abs(found - expected).max() < 1e-4
    assert min(expected) < 0.5


@pytest.mark.parametrize("build", [triangle_torus, quad_torus, MESHES["mixed sheet"]])
def test_with_the_normals_that_are_there_little_moves(build):
    """Quads are not flat, so that no vertices fit their normals exactly."""
    mesh = build()
    normals = np.ascontiguousarray(normals_of(mesh).T, np.float32)
    found = fit_of(mesh).fit(points_of(mesh), normals)
    sizes = mesh.face_sizes()
    assert np.abs(found.T - mesh.vertices).max() < (1e-5 if sizes.max() == 3 else 0.1)


def test_right_normals_bring_noisy_vertices_back(rng):
    clean = triangle_torus(30, 60)
    mesh = noisy(clean, rng, 0.2)
    found = fit_of(mesh).fit(points_of(mesh), np.ascontiguousarray(normals_of(clean).T, np.float32))
    fitted = normals_of(mesh.with_vertices(found.T.astype(float)))
    cosines = [(n * normals_of(clean)).sum(axis=1) for n in (normals_of(mesh), fitted)]
    before, after = (np.degrees(np.arccos(np.clip(c, -1, 1))).mean() for c in cosines)
    assert after < 0.25 * before


def test_folded_faces_are_unfolded():
    mesh = triangle_grid(9, 9)
    points = mesh.vertices.copy()
    points[40] += [1.6, 0.3, 0.0]
    normals = np.ascontiguousarray(normals_of(mesh).T, np.float32)
    found = fit_of(mesh).fit(points_of(mesh.with_vertices(points)), normals)
    cosines = [
        (normals_of(mesh.with_vertices(x)) * normals.T).sum(axis=1) for x in (points, found.T.astype(float))
    ]
    assert cosines[0].min() < 0 and cosines[1].min() > unfolding.LEAN


def test_what_cannot_be_unfolded_is_finite_and_stays_held(rng):
    mesh = noisy(triangle_grid(7, 7), rng)
    normals = rng.normal(size=(3, mesh.n_faces)).astype(np.float32)
    normals /= np.linalg.norm(normals, axis=0)
    is_free = rng.random(mesh.n_vertices) < 0.5
    points = points_of(mesh)
    found = fit_of(mesh).fit(points, normals, is_free)
    assert np.isfinite(found).all()
    assert_same_bits(found[:, ~is_free], points[:, ~is_free])


@FIT
def test_threads_and_blocks_do_not_change_a_bit(name, rng):
    mesh = noisy(FITTED[name](), rng)
    normals, results = wanted(mesh, rng, 1.0), []
    for threads in (1, 2, 3):
        with Blocks(threads, 7) as blocks:
            results.append(fit_of(mesh, blocks, faces_at_once=5).fit(points_of(mesh), normals))
    assert_same_bits(results[1], results[0])
    assert_same_bits(results[2], results[0])


@KIND
def test_area_vectors_of_fans(kind, rng):
    mesh = noisy(KINDS[kind](), rng)
    for face in faces_of(mesh):
        if len(face) >= 3:
            corners = [mesh.vertices[v][:, None].astype(np.float32) for v in face]
            area = newell(mesh.vertices[face])
            arms = [corner - corners[0] for corner in corners[1:]]
            assert np.abs(np.stack(fan_areas(arms))[:, 0] - 2 * area).max() < 1e-5
            assert abs(unfolding.doubled_areas(corners)[0] - 2 * np.linalg.norm(area)) < 1e-5
