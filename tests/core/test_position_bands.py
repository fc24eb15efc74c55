# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bands of positions and averages in rounds, against their definitions as dense matrices and loops."""

import numpy as np
import pytest
from checks import assert_same_bits, lengths
from framelet.core import connect
from framelet.core.automatic.position_bands import LEAST_AVERAGES, NUMBERS, shrink_positions
from framelet.core.automatic.problem import NormalProblem
from framelet.core.automatic.recipes import RECIPES
from framelet.core.automatic.smooth_positions import (
    ORDER,
    RingAverages,
    low_pass_changes,
    often_averaged,
    smooth_positions,
)
from framelet.core.normals.noise_sample import normals_of
from framelet.core.normals.pilot import unit_columns
from kinds import ALONE, BLOCKS, KIND, KINDS
from meshes import faces_of, noisy, triangle_torus
from twins import faces_touching

CRISP = next(recipe for recipe in RECIPES if recipe.n_rounds and not recipe.n_averages)
REFINED = [recipe for recipe in RECIPES if recipe.is_refined]
MANIFOLD = ["irregular torus", "border", "mixed sheet"]


def average_matrix(rings, n):
    """Return A = (I + P) / 2 as a dense matrix."""
    one = np.eye(n)
    return 0.5 * one + 0.5 * rings.outward(rings.mean(rings.inward(one)))


def low_pass_matrix(average, k):
    one = np.eye(len(average))
    return one - np.linalg.matrix_power(one - np.linalg.matrix_power(average, k), ORDER)


@KIND
@BLOCKS
def test_several_low_passes_at_once_are_those_one_by_one(kind, blocks, rng):
    mesh = noisy(KINDS[kind](), rng)
    rings = RingAverages(connect(mesh), blocks)
    fields = rng.normal(size=(mesh.n_vertices, 4))
    given = fields.copy()
    changes = low_pass_changes(fields, rings, (5, 1, 16))
    average = average_matrix(rings, mesh.n_vertices)
    for k, change in zip((5, 1, 16), changes, strict=True):
        expected = low_pass_matrix(average, k) @ rings.outward(given)
        assert np.abs(rings.outward(fields + change) - expected).max() < 1e-11
    assert_same_bits(fields, given)


@pytest.mark.parametrize("kind", [*MANIFOLD, "three pages"])
@pytest.mark.parametrize("k", [1, 2, 16, 64])
def test_averages_of_energies(kind, k, rng):
    """Nearly the power of the matrix; constants stay as they are."""
    mesh = KINDS[kind]()
    rings = RingAverages(connect(mesh), ALONE)
    energies = rng.exponential(size=(mesh.n_vertices, 2))
    found = rings.outward(often_averaged(rings.inward(energies), rings, k))
    expected = np.linalg.matrix_power(average_matrix(rings, mesh.n_vertices), k) @ energies
    assert np.abs(found - expected).max() < 0.02
    assert np.abs(often_averaged(np.ones_like(energies), rings, k) - 1).max() < 1e-12


@pytest.mark.parametrize("kind", MANIFOLD)
def test_shrinkage_of_bands_against_dense_matrices(kind, rng):
    mesh = noisy(KINDS[kind](), rng)
    rings = RingAverages(connect(mesh), ALONE)
    points, pilot, directions = (rng.normal(size=(3, mesh.n_vertices)) for _ in range(3))
    directions /= lengths(directions.T)
    noise = rng.normal(size=mesh.n_vertices)
    average = average_matrix(rings, mesh.n_vertices)
    low, expected = np.eye(mesh.n_vertices), np.zeros((mesh.n_vertices, 3))
    for k in NUMBERS:
        high, low = low, low_pass_matrix(average, k)
        band = high - low
        smooth = np.linalg.matrix_power(average, max(LEAST_AVERAGES, k))
        signal = smooth @ np.einsum("nc,cn->n", band @ pilot.T, directions) ** 2
        spoiled = 1.3 * (smooth @ (band @ noise) ** 2)
        total = signal**2 + spoiled**2
        gain = np.divide(signal**2, total, out=np.ones_like(total), where=total > 0)
        expected += gain[:, None] * (band @ points.T)
    expected += low @ points.T
    given = [x.copy() for x in (points, pilot)]
    found = shrink_positions(points, noise, pilot, directions, rings, 1.3).T
    assert np.abs(found - expected).max() < 0.03 * np.abs(points).max()  # energies are smoothed nearly
    for x, y in zip(given, (points, pilot), strict=True):
        assert_same_bits(x, y)


def test_bands_sum_up_to_the_positions_without_noise(rng):
    mesh = noisy(triangle_torus(8, 10), rng)
    rings = RingAverages(connect(mesh), ALONE)
    up = np.tile([[0.0], [0.0], [1.0]], mesh.n_vertices)
    points, nothing = mesh.vertices.T.copy(), np.zeros(mesh.n_vertices)
    assert np.abs(shrink_positions(points, nothing, points, up, rings, 1.0) - points).max() < 1e-12
    # Where the pilot has nothing in a band, and there is noise, only the last low-pass is left.
    noise = rng.normal(size=mesh.n_vertices)
    found = shrink_positions(points, noise, np.zeros_like(points), up, rings, 1.0)
    assert np.abs(found - smooth_positions(points, rings, NUMBERS[-1])).max() < 1e-12


@pytest.mark.parametrize("recipe", REFINED, ids=lambda recipe: recipe.label)
def test_refined_recipes_take_their_pilot_from_the_rest(recipe, rng):
    """Whether it was run before or not."""
    mesh = noisy(triangle_torus(8, 10), rng)

    def problem():
        return NormalProblem(mesh.vertices.T.copy(), mesh, connect(mesh), 0.1, ALONE)

    one, other = problem(), problem()
    pilot = one.run(recipe.pilot, is_unfolded=False)
    found = one.run(recipe, is_unfolded=False)
    assert_same_bits(one._pilots[recipe.pilot], pilot)
    assert_same_bits(found, other.run(recipe, is_unfolded=False))
    vectors = np.zeros((mesh.n_vertices, 3))
    for corners in faces_of(mesh):
        a, b, c = pilot.T[corners]
        vectors[corners] += np.cross(b - a, c - a)
    directions = unit_columns(vectors.T, vectors.T)
    caution = recipe.position_caution
    expected = shrink_positions(one.noisy, 0.1 * one.sample, pilot, directions, one.rings, caution)
    assert np.abs(found - expected).max() < 1e-9


def test_averages_in_rounds(rng):
    """Weights come from the normals of the round before, smoothed positions or not."""
    mesh = noisy(triangle_torus(6, 8), rng)
    problem = NormalProblem(mesh.vertices.T.copy(), mesh, connect(mesh), 0.1, ALONE)
    found = problem.clean_normals(CRISP)
    width = CRISP.range_units * problem.units[0]
    averages = problem.averages
    normals = normals_of(problem.noisy, mesh).T
    areas = np.empty(mesh.n_faces)
    centroids = np.empty((mesh.n_faces, 3))
    areas[averages._items] = averages._areas
    centroids[averages._items] = averages._centroids.T
    for _ in range(CRISP.n_rounds):
        following = np.empty_like(normals)
        for f, near in enumerate(faces_touching(mesh)):
            far, turn = lengths(centroids[near] - centroids[f]), lengths(normals[near] - normals[f])
            weight = areas[near] * np.exp(
                -0.5 * (far / averages._spatial_sigma) ** 2 - 0.5 * (turn / width) ** 2
            )
            mean = weight @ normals[near]
            following[f] = mean / np.linalg.norm(mean)
        normals = following
    assert np.abs(found.T - normals).max() < 1e-9
