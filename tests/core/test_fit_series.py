# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Many vertex steps as a short series: next to the same steps one by one, with and without constraints."""

import numpy as np
import pytest
from checks import assert_same_bits
from framelet.core.blocks import Blocks
from framelet.core.denoising.constraints import Constraints
from framelet.core.normals.fit_series import LEFT_OUT, share_of_step, step_series
from framelet.core.normals.neighbors import faces_of_vertices
from framelet.core.normals.vertex_fit import VertexFit
from meshes import MESHES, noisy, triangle_torus

NEAR = 5 * LEFT_OUT
ALONE = Blocks(1)


def unit_rows(vectors):
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def fit_of(mesh, rng, blocks=ALONE):
    normals = unit_rows(rng.normal(size=(mesh.n_faces, 3)))
    return VertexFit(mesh, faces_of_vertices(mesh), blocks).steps(mesh.vertices.T.copy(), normals.T)


def one_by_one(fit, n_steps, constraints=None, origin=None):
    *_, (points, _) = fit.points(n_steps, constraints, origin)
    return points


@pytest.mark.parametrize("n_steps", [1, 2, 8, 25, 50])
def test_the_series_is_the_sum_of_powers(n_steps):
    series = step_series(n_steps)
    x = np.linspace(0, 1, 301)
    found = np.polynomial.chebyshev.chebval(2 * x - 1, series)
    assert np.abs(found - sum(x**power for power in range(n_steps))).max() < 2 * LEFT_OUT
    assert len(series) < 0.6 * n_steps or n_steps < 25


@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize("n_steps", [1, 8, 50])
def test_a_series_comes_next_to_all_the_steps(name, n_steps, rng):
    """Also where faces name a vertex twice, vertices are not manifold, or normals fit to nothing."""
    mesh = noisy(MESHES[name](), rng)
    fit = fit_of(mesh, rng)
    ticks = []
    found = fit.after(n_steps, tick=ticks.append)
    expected = one_by_one(fit, n_steps)
    first = np.linalg.norm(one_by_one(fit, 1) - mesh.vertices.T, axis=0)
    assert np.abs(found - expected).max() < NEAR * first.max()
    assert len(ticks) == n_steps and min(ticks) >= 0
    assert np.abs(expected - mesh.vertices.T).max() > 0.01


def test_constraints_hold(rng):
    mesh = noisy(MESHES["triangle torus"](), rng)
    fit = fit_of(mesh, rng)
    start = mesh.vertices.T
    rail = unit_rows(rng.normal(size=(9, 3))).T
    constraints = Constraints(np.arange(20, 40), np.arange(50, 59), rail)
    for origin in (start, start + rng.normal(0, 0.05, start.shape)):
        found = fit.after(200, constraints, origin)
        assert_same_bits(found[:, 20:40], start[:, 20:40] + (origin - start)[:, 20:40])
        apart = found[:, 50:59] - origin[:, 50:59]
        assert np.abs(apart - rail * (rail * apart).sum(axis=0)).max() < 1e-12
        expected = one_by_one(fit, 200, constraints, origin)
        assert np.abs(found - expected).max() < 20 * LEFT_OUT
        assert np.abs(found - start)[:, 60:].max() > 0.1


@pytest.mark.parametrize("constrained", [False, True])
def test_threads_do_not_change_the_series(constrained, rng):
    mesh = noisy(triangle_torus(20, 40), rng)
    constraints = Constraints(np.arange(5), np.zeros(0, np.intp), np.zeros((3, 0))) if constrained else None
    results = []
    for threads in (1, 2, 4):
        with Blocks(threads, block_size=64) as blocks:
            fit = fit_of(mesh, np.random.default_rng(3), blocks)
            results.append(fit.after(20, constraints, mesh.vertices.T + 0.1))
    for result in results[1:]:
        assert_same_bits(results[0], result)


@pytest.mark.parametrize(("n_all", "n_steps"), [(50, 18), (8, 6), (3, 7), (0, 4)])
def test_shares_add_up(n_all, n_steps):
    shares = [share_of_step(n_all, step, n_steps) for step in range(1, n_steps + 1)]
    assert sum(shares) == n_all
    assert max(shares) - min(shares) <= 1
