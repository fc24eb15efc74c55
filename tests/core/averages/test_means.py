# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Means over neighborhoods and polynomials in them, against loops and dense matrices."""

import numpy as np
import pytest
from checks import assert_same_bits
from framelet.core import connect
from framelet.core.averages import ring_means
from framelet.core.averages.means import Means, padded
from framelet.core.averages.ring_means import RingMeans
from framelet.core.mesh.corner_lists import faces_of_vertices
from framelet.core.mesh.ragged import Ragged
from kinds import ALONE, BLOCKS, KIND, KINDS
from learned_twins import averaging, low_pass, ring_matrix
from meshes import MESHES, faces_of, triangle_grid

ROUNDING = 1e-12


@KIND
@BLOCKS
@pytest.mark.parametrize("at_once", [1, 5, 50, 2**15])
@pytest.mark.parametrize("is_square", [True, False])
def test_means(kind, blocks, at_once, is_square, rng):
    mesh = KINDS[kind]()
    rows = [rng.integers(0, mesh.n_vertices, rng.integers(0, 9)) for _ in range(mesh.n_vertices)]
    offset = np.concatenate(([0], np.cumsum([len(row) for row in rows])))
    rows_of_items = Ragged(offset, np.concatenate(rows).astype(np.int32))
    means = Means(rows_of_items, blocks.with_block_size(at_once), is_square=is_square)
    field = rng.normal(size=(mesh.n_vertices, 4))
    found = means.outward(means.mean(means.inward(field) if is_square else field))
    expected = [field[row].mean(axis=0) if len(row) else np.zeros(4) for row in rows]
    assert np.abs(found - expected).max() < ROUNDING
    assert_same_bits(means.outward(means.inward(field)), field)


def test_parts_of_the_items_with_their_members(rng):
    rows = [rng.integers(0, 40, size) for size in rng.integers(0, 6, 40)]
    offset = np.concatenate(([0], np.cumsum([len(row) for row in rows])))
    means = Means(Ragged(offset, np.concatenate(rows).astype(np.int32)), ALONE, is_square=False)
    found = [None] * 40

    def use(part, members):
        for place, own in zip(range(part.start, part.stop), members.T, strict=True):
            found[place] = own.tolist()

    means.for_parts(use)
    assert [found[place] for place in means.place] == [row.tolist() for row in rows]


def test_columns_are_padded_to_rows(rng):
    columns = rng.normal(size=(3, 7))
    assert np.array_equal(padded(columns), np.column_stack((columns.T, np.zeros(7))))


@pytest.mark.parametrize("name", MESHES)
def test_faces_of_vertices(name):
    """By a sort and from rings: the same faces, in another order."""
    mesh = MESHES[name]()
    expected, found = faces_of_vertices(mesh), faces_of_vertices(mesh, connect(mesh))
    assert found.offset.tolist() == expected.offset.tolist()
    assert found.items.dtype == expected.items.dtype
    for v, (begin, end) in enumerate(zip(found.offset[:-1], found.offset[1:], strict=True)):
        own = [f for f, face in enumerate(faces_of(mesh)) for w in face if w == v]
        assert expected.items[begin:end].tolist() == own == sorted(found.items[begin:end].tolist())


@KIND
@BLOCKS
def test_means_over_rings(kind, blocks, rng):
    """On a border along the border alone; without neighbors the vertex itself."""
    mesh = KINDS[kind]()
    rings = RingMeans(mesh, connect(mesh), blocks)
    found = rings.outward(rings.mean(rings.inward(np.eye(mesh.n_vertices))))
    assert np.abs(found - ring_matrix(mesh)).max() < ROUNDING
    vertices = rng.permutation(mesh.n_vertices)[:9]
    points = rng.normal(size=(3, mesh.n_vertices))
    expected = (points @ ring_matrix(mesh).T)[:, vertices]
    assert np.abs(rings.mean_at(points, vertices) - expected).max() < ROUNDING


@KIND
@pytest.mark.parametrize("share", [0.1, 0.5, 1.0])
def test_means_without_some_edges(kind, share, rng):
    """A vertex that loses all of them still has the mean of its neighbors, but counts for none."""
    mesh = KINDS[kind]()
    is_left_out = rng.random(mesh.n_edges) < share
    rings = RingMeans(mesh, connect(mesh), ALONE, is_left_out)
    found = rings.outward(rings.mean(rings.inward(np.eye(mesh.n_vertices))))
    assert np.abs(found - ring_matrix(mesh, mesh.edges[is_left_out].tolist())).max() < ROUNDING


@KIND
def test_the_spectrum_of_ring_means_is_real_and_at_most_one(kind):
    values = np.linalg.eigvals(ring_matrix(KINDS[kind]()))
    assert np.abs(values.imag).max() < 1e-7 and np.abs(values).max() < 1 + 1e-9


@KIND
@pytest.mark.parametrize("share", [0.1, 0.5])
def test_the_spectrum_without_some_edges_is_real(kind, share, rng):
    """What is outside of -1 to 1 grows in a Chebyshev series."""
    mesh = KINDS[kind]()
    for _ in range(5):
        rings = RingMeans(mesh, connect(mesh), ALONE, rng.random(mesh.n_edges) < share)
        means = rings.outward(rings.mean(rings.inward(np.eye(mesh.n_vertices))))
        values = np.linalg.eigvals(means)
        # Values that are several times 0 are exact to a root of the rounding only.
        assert np.abs(values.imag).max() < 1e-4 and np.abs(values).max() < 1 + 1e-9


@KIND
@BLOCKS
@pytest.mark.parametrize("numbers", [(1,), (2, 10, 48), (3, 3, 1, 16)])
@pytest.mark.usefixtures("exact")
def test_low_passes_are_powers_of_a_matrix(kind, blocks, numbers, rng):
    """Several at once, in any order, in double precision."""
    mesh = KINDS[kind]()
    rings = RingMeans(mesh, connect(mesh), blocks)
    field = rng.normal(size=(mesh.n_vertices, 4))
    given = rings.inward(field)
    for change, k in zip(rings.low_passes(given, numbers), numbers, strict=True):
        assert np.abs(rings.outward(change) - (low_pass(ring_matrix(mesh), k) @ field - field)).max() < 1e-10
    assert_same_bits(given, rings.inward(field))


@KIND
@pytest.mark.parametrize("n_averages", [1, 2, 12, 64])
@pytest.mark.usefixtures("exact")
def test_many_averages_are_powers_of_a_matrix(kind, n_averages, rng):
    mesh = KINDS[kind]()
    rings = RingMeans(mesh, connect(mesh), ALONE)
    field = rng.normal(size=(mesh.n_vertices, 2))
    found = rings.outward(rings.averaged(rings.inward(field), n_averages))
    assert np.abs(found - averaging(ring_matrix(mesh), n_averages) @ field).max() < 1e-10


@pytest.mark.parametrize("n_averages", [12, 48, 64, 1024])
def test_series_that_are_cut_off_are_nearly_whole(n_averages):
    """On the whole spectrum, and in a fraction of the steps."""
    p = np.linspace(-1, 1, 401)
    a = (1 + p) / 2
    power, low = ring_means._power_series(n_averages), ring_means._low_pass_series(n_averages)
    value = np.polynomial.chebyshev.chebval
    assert np.abs(value(p, power) - a**n_averages).max() < 2 * ring_means.LEFT_OUT
    apart = 1 + value(p, low) * (p - 1) - (2 * a**n_averages - a ** (2 * n_averages))
    assert np.abs(apart).max() < 2.5 * ring_means.LEFT_OUT
    assert sum(power) == pytest.approx(1, abs=1e-12)
    assert len(power) < 4 * np.sqrt(n_averages) and len(low) < 6 * np.sqrt(n_averages)


def test_single_precision_is_near_double(rng):
    mesh = KINDS["mixed sheet"]()
    rings = RingMeans(mesh, connect(mesh), ALONE)
    field = rng.normal(size=(mesh.n_vertices, 4)) + 1000.0
    for change, exact_change in zip(
        rings.low_passes(rings.inward(field.astype(np.float32)), (2, 48)),
        rings.low_passes(rings.inward(field.astype(np.float32).astype(float)), (2, 48)),
        strict=True,
    ):
        assert change.dtype == np.float32
        assert np.abs(change - exact_change).max() < 1e-3


def test_planes_stay_planes_under_low_passes():
    """Inside a regular grid positions do not move at all, as far as no border is within reach."""
    mesh = triangle_grid(40, 41)
    rings = RingMeans(mesh, connect(mesh), ALONE)
    (change,) = rings.low_passes(rings.inward(mesh.vertices), (2,))
    change = rings.outward(change)
    x, y = np.abs(mesh.vertices[:, :2].T)
    inside = (np.minimum(x, 40 - x) > 5) & (np.minimum(y, 39 - y) > 5)
    assert inside.sum() > 500 and np.abs(change[inside]).max() < 1e-11
    assert not change[:, 2].any()
