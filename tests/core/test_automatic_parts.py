# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The parts of automatic denoising against their definitions, written as loops and dense matrices."""

import numpy as np
import pytest
from checks import assert_same_bits, lengths
from framelet.core import SurfaceMesh
from framelet.core.automatic.patches import _nearest
from framelet.core.automatic.problem import unit_noise
from framelet.core.automatic.smooth_positions import RingAverages, smooth_positions
from framelet.core.normals.averages import Averages, Members
from framelet.core.normals.band_shrinkage import LEFT_OUT, _averaged_often, _power_series, shrink_bands
from framelet.core.normals.face_averages import FaceAverages
from framelet.core.normals.means import Means
from framelet.core.normals.neighbors import Ragged, faces_of_vertices, members_around
from framelet.core.normals.noise_sample import area_vectors, noise_in_normals, scrambled, vertex_means
from framelet.core.normals.pilot import unit_columns
from framelet.core.surface.connectivity import connect
from framelet.core.surface.geometry import face_area_vectors
from kinds import ALONE, BLOCKS, KIND, KINDS
from meshes import MESHES, faces_of, noisy, triangle_torus
from twins import faces_touching, newell

ROUNDING = 1e-12


def face_averages(mesh, rng, blocks=ALONE, sigma=0.8):
    """Return averages over faces with random centroids and areas, and these."""
    centroids, areas = rng.normal(size=(mesh.n_faces, 3)), rng.exponential(size=mesh.n_faces)
    averages = FaceAverages(mesh, faces_of_vertices(mesh), centroids, areas, sigma, blocks)
    return averages, centroids, areas


def matrix_of(averages, weights, n):
    """Return averages as a dense matrix, by averaging unit vectors."""
    return averages.outward(averages.average(weights, averages.inward(np.eye(n))))


@KIND
@BLOCKS
@pytest.mark.parametrize("at_once", [1, 50, 2**14])
def test_averages(kind, blocks, at_once, rng, monkeypatch):
    """Whatever lies in a tile, and however tiles are split into chunks."""
    mesh = KINDS[kind]()
    at_vertex, order = faces_of_vertices(mesh), rng.permutation(mesh.n_faces)
    monkeypatch.setattr("framelet.core.normals.averages.MEMBERS_AT_ONCE", at_once)
    monkeypatch.setattr("framelet.core.normals.averages.TILES_IN_BLOCK", 3)
    averages = Averages(lambda faces: members_around(mesh, at_vertex, faces), order, blocks)
    factor = rng.random(mesh.n_faces)
    inside, number = averages.inward(factor), averages.inward(np.arange(mesh.n_faces))

    def fill(chunk, weights):
        factors = inside[chunk.members][:, None] + number[chunk.rows][:, :, None]
        np.multiply(chunk.mask, factors, out=weights)

    weights = averages.for_chunks(fill)
    field = rng.normal(size=(mesh.n_faces, 4))
    expected = np.zeros_like(field)
    for f, near in enumerate(faces_touching(mesh)):
        for g in near:
            expected[f] += (factor[g] + f) * field[g]
    assert_same_bits(averages.outward(averages.inward(field)), field)
    found = averages.outward(averages.average(weights, averages.inward(field)))
    assert np.abs(found - expected).max() < 1e-9


@pytest.mark.parametrize("n_items", [0, 1, 5, 8, 19])
def test_averages_of_nothing(n_items):
    nothing = np.zeros(0, int)
    averages = Averages(lambda items: Members(nothing, nothing, nothing), np.arange(n_items), ALONE)
    weights = averages.for_chunks(lambda chunk, weights: weights.fill(1))
    found = averages.outward(averages.average(weights, averages.inward(np.ones((n_items, 2)))))
    assert found.shape == (n_items, 2) and not found.any()


@KIND
@BLOCKS
@pytest.mark.parametrize("at_once", [1, 50, 2**15])
@pytest.mark.parametrize("is_square", [True, False])
def test_means(kind, blocks, at_once, is_square, rng, monkeypatch):
    monkeypatch.setattr("framelet.core.normals.means.MEMBERS_AT_ONCE", at_once)
    monkeypatch.setattr("framelet.core.normals.means.ITEMS_IN_BLOCK", 10)
    mesh = KINDS[kind]()
    rows = [rng.integers(0, mesh.n_vertices, rng.integers(0, 9)) for _ in range(mesh.n_vertices)]
    offset = np.concatenate(([0], np.cumsum([len(row) for row in rows])))
    means = Means(Ragged(offset, np.concatenate(rows).astype(np.int32)), blocks, is_square=is_square)
    field = rng.normal(size=(mesh.n_vertices, 4))
    found = means.outward(means.mean(means.inward(field) if is_square else field))
    expected = [field[row].mean(axis=0) if len(row) else np.zeros(4) for row in rows]
    assert np.abs(found - expected).max() < ROUNDING
    assert_same_bits(means.outward(means.inward(field)), field)


@KIND
@BLOCKS
def test_weights_of_faces(kind, blocks, rng):
    mesh = KINDS[kind]()
    averages, centroids, areas = face_averages(mesh, rng, blocks)
    guide = rng.normal(size=(mesh.n_faces, 3))
    found = matrix_of(averages, averages.weights(guide.T, 0.7), mesh.n_faces)
    expected = np.zeros_like(found)
    for f, near in enumerate(faces_touching(mesh)):
        far, turn = lengths(centroids[near] - centroids[f]), lengths(guide[near] - guide[f])
        row = areas[near] * np.exp(-(far**2) / 2 / 0.8**2 - turn**2 / 2 / 0.7**2)
        expected[f, near] = row / row.sum() if near else 0
    assert np.abs(found - expected).max() < ROUNDING


def test_around_faces_without_area_the_face_itself_stands_in(rng):
    mesh = triangle_torus(5, 6)
    zeros = np.zeros(mesh.n_faces)
    averages = FaceAverages(mesh, faces_of_vertices(mesh), np.zeros((mesh.n_faces, 3)), zeros, 0.0, ALONE)
    weights = averages.weights(rng.normal(size=(3, mesh.n_faces)), 0.3)
    assert np.array_equal(matrix_of(averages, weights, mesh.n_faces), np.eye(mesh.n_faces))


@pytest.mark.parametrize("n_bands", [0, 1, 2, 4])
@pytest.mark.parametrize("caution", [0.0, 1.5])
def test_bands_against_powers_of_a_matrix(n_bands, caution, rng):
    mesh = KINDS["mixed sheet"]()
    averages, *_ = face_averages(mesh, rng)
    pilot, noise, field = (rng.normal(size=(mesh.n_faces, 3)) for _ in range(3))
    weights = averages.weights(pilot.T, 2.0)
    a = matrix_of(averages, weights, mesh.n_faces)
    ticks, expected, power = [], np.zeros_like(field), np.eye(len(a))
    for band in range(n_bands):
        lower = np.linalg.matrix_power(a, 2**band)  # 1, 2, 4, 8 averages in all
        high = power - lower
        smooth = np.linalg.matrix_power(a, min(4, max(2, 2**band)))
        signal, spoiled = (smooth @ (lengths(high @ x) ** 2) for x in (pilot, noise))
        gain = signal**2 / (signal**2 + (caution * spoiled) ** 2)
        expected += gain[:, None] * (high @ field)
        power = lower
    expected += power @ field
    given = [x.copy() for x in (field, noise, pilot)]
    found = shrink_bands(
        *(x.T for x in given), averages, weights, n_bands, caution, lambda: ticks.append(0)
    ).T
    assert np.abs(found - expected).max() < 1e-10
    assert len(ticks) == n_bands
    if not caution:
        assert np.abs(found - field).max() < ROUNDING
    for x, y in zip(given, (field, noise, pilot), strict=True):
        assert_same_bits(x, y)


@pytest.mark.parametrize("exponent", [4, 12, 28, 60])
def test_many_averages_in_few_steps(exponent, rng):
    """Against powers of the matrix; on what was averaged before the error is far below what is left out."""
    mesh = KINDS["mixed sheet"]()
    averages, *_ = face_averages(mesh, rng)
    weights = averages.weights(rng.normal(size=(3, mesh.n_faces)), 2.0)
    a = matrix_of(averages, weights, mesh.n_faces)
    values = np.linalg.eigvals(a)
    assert np.abs(values.imag).max() < 1e-9 and np.abs(values).max() < 1 + 1e-9
    series = _power_series(exponent, LEFT_OUT)
    assert exponent == 4 or len(series) < 0.8 * exponent
    assert sum(series) == pytest.approx(1, abs=1e-12) and min(series) >= 0
    x = np.linspace(-1, 1, 201)
    assert np.abs(np.polynomial.chebyshev.chebval(x, series) - x**exponent).max() < 2 * LEFT_OUT
    field = rng.normal(size=(mesh.n_faces, 9))
    found = averages.outward(_averaged_often(averages.inward(field), exponent, averages, weights))
    first, second = np.eye(len(a)), a
    expected = series[0] * field + series[1] * (a @ field)
    for coefficient in series[2:]:
        first, second = second, 2 * a @ second - first
        expected += coefficient * (second @ field)
    assert np.abs(found - expected).max() < 1e-10
    even = np.ones((mesh.n_faces, 9))
    kept = averages.outward(_averaged_often(averages.inward(even), exponent, averages, weights))
    assert np.abs(kept - 1).max() < 1e-10


def test_bands_without_noise_or_without_signal(rng):
    """All gains are 1 without noise; they are 0 where the pilot is even, and only the low-pass is left."""
    mesh = triangle_torus(6, 8)
    averages, *_ = face_averages(mesh, rng)
    noise, field = (rng.normal(size=(mesh.n_faces, 3)) for _ in range(2))
    weights = averages.weights(noise.T, 2.0)
    for pilot in (noise, np.zeros_like(noise)):
        found = shrink_bands(field.T, 0 * noise.T, pilot.T, averages, weights, 4, 2.0).T
        assert np.abs(found - field).max() < ROUNDING
    found = shrink_bands(field.T, noise.T, 0 * noise.T, averages, weights, 3, 1.0).T
    low = np.linalg.matrix_power(matrix_of(averages, weights, mesh.n_faces), 4) @ field
    assert np.abs(found - low).max() < ROUNDING


def test_unit_columns():
    vectors, fallback = np.array([[3.0, 0, 4], [0, 0, 0], [0, 1e-200, 0]]).T, np.array([[1.0, 0, 0]] * 3).T
    assert unit_columns(vectors, fallback).T.tolist() == [[0.6, 0, 0.8], [1, 0, 0], [1, 0, 0]]


@pytest.mark.parametrize("kind", [*KINDS, "single quad", "tetrahedron"])
def test_area_vectors(kind, rng):
    mesh = noisy((KINDS | MESHES)[kind](), rng)
    for shift, slack in ((0.0, ROUNDING), (1e6, 1e-8)):
        points = mesh.vertices + shift
        found = area_vectors(points.T, mesh).T
        assert np.abs(found - [newell(points[f]) if f else (0, 0, 0) for f in faces_of(mesh)]).max() < slack
        assert np.abs(found - face_area_vectors(mesh.with_vertices(points))).max() < slack


@KIND
def test_vertex_means(kind, rng):
    mesh = KINDS[kind]()
    values = rng.normal(size=(mesh.n_faces, 3))
    own = [
        [x for x, f in zip(values, faces_of(mesh), strict=True) for w in f if w == v]
        for v in range(mesh.n_vertices)
    ]
    found = vertex_means(values.T, faces_of_vertices(mesh)).T
    assert np.abs(found - [np.mean(x, axis=0) if x else np.zeros(3) for x in own]).max() < ROUNDING
    assert not vertex_means(np.zeros((3, 0)), Ragged(np.zeros(4, int), np.zeros(0, int))).any()


def test_scrambled_numbers_are_spread_evenly_and_follow_no_rounding(rng):
    mesh = noisy(triangle_torus(30, 40), rng, 0.2)
    at_vertex, edge = faces_of_vertices(mesh), 0.3
    number = scrambled(mesh.vertices.T, mesh, at_vertex, 0.2 * edge, 64.0)
    assert number.min() >= 0 and number.max() <= 1
    assert np.abs(np.histogram(number, 10, (0, 1))[0] / len(number) - 0.1).max() < 0.03
    assert abs(unit_noise(number).mean()) < 0.1 and abs(unit_noise(number).std() - 1) < 0.05
    first, second = number[mesh.edges].T
    assert abs(np.corrcoef(first, second)[0, 1]) < 0.06
    over = SurfaceMesh.from_faces(mesh.vertices, [face[::-1] for face in faces_of(mesh)])
    assert np.abs(scrambled(mesh.vertices.T, over, at_vertex, 0.2 * edge, 64.0) - (1 - number)).max() < 1e-9
    # At a vertex of one triangle, or on a plane, the height is 0 but for rounding.
    flat = noisy(MESHES["single triangle"](), rng)
    for shift in (0, 3.3, -7.1):
        sample = scrambled(flat.vertices.T + shift, flat, faces_of_vertices(flat), 0.1, 64.0)
        assert np.abs(sample - 0.5).max() < 1e-9


def test_noise_in_normals_is_linear_for_small_noise(rng):
    mesh = noisy(MESHES["mixed sheet"](), rng)
    at_vertex = faces_of_vertices(mesh)
    amount = 1e-6 * rng.normal(size=mesh.n_vertices)
    one, two = (noise_in_normals(mesh.vertices.T, k * amount, mesh, at_vertex, ALONE) for k in (1, 2))
    assert np.abs(two - 2 * one).max() < 1e-9 < np.abs(one).max()
    assert not noise_in_normals(mesh.vertices.T, 0 * amount, mesh, at_vertex, ALONE).any()


@pytest.mark.parametrize("name", MESHES)
def test_faces_of_vertices_are_the_same_from_rings(name):
    mesh = MESHES[name]()
    expected, found = faces_of_vertices(mesh), faces_of_vertices(mesh, connect(mesh))
    assert found.offset.tolist() == expected.offset.tolist()
    for begin, end in zip(found.offset[:-1], found.offset[1:], strict=True):
        assert sorted(found.items[begin:end].tolist()) == expected.items[begin:end].tolist()
    assert found.items.dtype == expected.items.dtype


@pytest.mark.parametrize("n_faces", [1, 40, 700, 3000])
def test_the_nearest_faces_match_a_sort(n_faces, rng):
    """Also where most are far off, or equally far."""
    crowded = rng.normal(size=(3, 3000)) ** 3
    for centroids in (crowded, np.round(crowded), np.zeros((3, 3000))):
        for seed in (0, 7, 2999):
            distance = ((centroids - centroids[:, seed, None]) ** 2).sum(axis=0)
            farthest = np.sort(distance)[n_faces - 1]
            near, found = _nearest(centroids, seed, n_faces)
            assert near.tolist() == np.flatnonzero(distance <= farthest).tolist()
            assert found.tolist() == distance[near].tolist()


def test_a_fourth_number_is_smoothed_like_a_coordinate(rng):
    mesh = triangle_torus(8, 14)
    rings = RingAverages(connect(mesh), ALONE)
    heights = rng.normal(size=(1, mesh.n_vertices))
    points = mesh.vertices.T.copy()
    both = smooth_positions(np.concatenate((points, heights)), rings, 4)
    assert_same_bits(both[:3], smooth_positions(points, rings, 4))
    assert_same_bits(both[3], smooth_positions(np.concatenate((heights, points[:2])), rings, 4)[0])
    assert np.abs(both[3] - heights).max() > 0.1
