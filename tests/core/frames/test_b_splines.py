# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""B-spline frames against the formulas of section 5.3, and banks from arrays of your own."""

from math import comb

import numpy as np
import pytest
from framelet.core import BANKS, FilterBank, make_stencil, make_transform
from framelet.core.frames.b_spline import HIGHEST_ORDER, b_spline
from framelet.core.frames.filter_bank import unitary_extension_defects
from framelet.core.mesh.connectivity import connect
from meshes import flipped, mixed_sheet, noisy, quad_torus, triangle_grid, triangle_torus, union

EXACT = 1e-13

ORDER = pytest.mark.parametrize("order", range(1, HIGHEST_ORDER + 1))


@ORDER
def test_spectra_are_those_of_the_paper(order, rng):
    """(5.14), (5.15): q_jk = q_j q_k, q_n = i^n sqrt(C(p, n)) cos^(p - n) sin^n of half the frequency.

    Up to sign, and for odd orders up to the half sample between a vertex and the middle of a cell.
    """
    bank = b_spline(order)
    frequencies = rng.uniform(-np.pi, np.pi, (60, 2))
    middle = 0.5 * (order % 2)
    spectra = bank.masks @ np.exp(-1j * ((bank.offsets - middle) @ frequencies.T))

    def q(n, w):
        return 1j**n * np.sqrt(comb(order, n)) * np.cos(w / 2) ** (order - n) * np.sin(w / 2) ** n

    assert len(spectra) == (order + 1) ** 2
    for row in range(order + 1):
        for column in range(order + 1):
            expected = q(row, frequencies[:, 0]) * q(column, frequencies[:, 1])
            found = spectra[row * (order + 1) + column]
            assert min(np.abs(found - expected).max(), np.abs(found + expected).max()) < EXACT
    assert sorted(set(bank.offsets.ravel().tolist())) == list(range(-(order // 2), order - order // 2 + 1))
    assert bank.is_cell_centered == bool(order % 2)


@pytest.mark.parametrize("order", [2, 4, 6])
def test_proposition_1_gives_the_reconstruction_row(order):
    """(5.17): 1 is the sum of (-1)^(k1 + k2) q_{2 k1, 2 k2} times binomial coefficients."""
    m = order // 2
    expected = np.zeros((order + 1, order + 1))
    for k1 in range(m + 1):
        for k2 in range(m + 1):
            size = comb(m, k1) * comb(m, k2) / np.sqrt(comb(order, 2 * k1) * comb(order, 2 * k2))
            expected[2 * k1, 2 * k2] = (-1) ** (k1 + k2) * size
    bank = b_spline(order)
    assert np.abs(np.abs(bank.reconstruction[0]) - np.abs(expected.ravel())).max() < 1e-12
    # The signs of the filters are free; with these rows or their own, the sum of the filters is one tap.
    assert np.abs(bank.reconstruction[0] @ bank.masks - np.eye(1, bank.n_taps)[0]).max() < 1e-12
    assert np.array_equal(bank.used_bands, np.flatnonzero(expected.ravel()))


def test_the_lowest_orders_are_haar_and_the_linear_spline():
    haar = b_spline(1)
    assert np.abs(np.abs(haar.masks) - 0.25).max() < EXACT
    assert np.abs(4 * haar.masks @ haar.masks.T - np.eye(4)).max() < EXACT
    two, linear = b_spline(2), BANKS["LINEAR_SPLINE"]
    left = list(range(9))
    for mask in linear.masks:
        match = [k for k in left if min(np.abs(two.masks[k] - s * mask).max() for s in (1, -1)) < EXACT]
        assert len(match) == 1
        left.remove(match[0])


TENSOR_9 = FilterBank("TENSOR_9", "TRIANGLES", BANKS["LINEAR_SPLINE"].offsets, BANKS["LINEAR_SPLINE"].masks)
TENSOR_25 = FilterBank("TENSOR_25", "TRIANGLES", b_spline(4).offsets, b_spline(4).masks)
EDGES = FilterBank(  # low-pass and differences along one direction only: six taps are not needed
    "EDGES",
    "TRIANGLES",
    [(0, 0), (0, 1), (0, -1)],
    np.array([[2, 1, 1], [0, 2**0.5, -(2**0.5)], [2, -1, -1]]) / 4,
)


@pytest.mark.parametrize("bank", [TENSOR_9, TENSOR_25, EDGES], ids=lambda bank: bank.name)
@pytest.mark.parametrize("rule", ["MEAN", "STRAIGHT"])
def test_a_bank_of_your_own_goes_through_the_transform(bank, rule, rng):
    """As an object instead of a name: perfect reconstruction, and alpha = M D."""
    mesh = noisy(union(flipped(triangle_torus(8, 9)), mixed_sheet(), triangle_grid()), rng)
    for n_levels in (1, 2):
        transform = make_transform(mesh, bank, rule, n_levels)
        found = transform.analyze(mesh.vertices)
        scale = np.abs(mesh.vertices).max()
        assert np.abs(transform.synthesize(found) - mesh.vertices).max() < 1e-12 * scale
        assert found.details(n_levels - 1).shape == (bank.n_bands - 1, mesh.n_vertices, 3)
    taps = make_stencil(mesh, connect(mesh), rule, bank=bank).data_matrix(mesh.vertices)
    first = make_transform(mesh, bank, rule).analyze(mesh.vertices)
    expected = np.einsum("bt,tnc->bnc", bank.masks, taps)
    assert np.abs(first.low - expected[0]).max() < 1e-12 * scale
    assert np.abs(first.details(0) - expected[1:]).max() < 1e-12 * scale
    assert np.abs(first.details(0)).max() > 0.01


def test_a_bank_for_quads_of_your_own_is_tight_on_a_regular_torus(rng):
    mine = FilterBank("MINE", "QUADS", BANKS["B_SPLINE_4"].offsets, BANKS["B_SPLINE_4"].masks)
    mesh = quad_torus(7, 9)
    vertices = rng.normal(size=mesh.vertices.shape)
    found = make_transform(mesh, mine).analyze(vertices)
    assert (found.low**2).sum() + (found.details(0) ** 2).sum() == pytest.approx(
        (vertices**2).sum(), rel=1e-13
    )


def test_the_message_says_which_property_fails():
    """Row sums, then (2.6), then the existence of v; (2.7) alone may fail, as for LINEAR_SPLINE_REDUCED."""
    linear = BANKS["LINEAR_SPLINE"]
    sums, squares = linear.masks.copy(), linear.masks.copy()
    sums[3, 1] += 1e-9
    squares[8] = -1.001 * squares[8]
    for masks, message in (
        (sums, r"^MINE: mask 3 sums to 1e-09; it must sum to 0\.$"),
        (squares, r"^MINE: the masks do not satisfy the UEP \(2\.6\), sum \|a\|\^2 = 1; they are off by \d"),
        (linear.masks / 2, r"^MINE: mask 0 sums to 0\.5; it must sum to 1\.$"),
    ):
        with pytest.raises(ValueError, match=message):
            FilterBank("MINE", "QUADS", linear.offsets, masks)
    with pytest.raises(
        ValueError, match=r"^MINE: no row v gives v M = delta_0 \(nearest: off by \d.*\); add masks\.$"
    ):
        FilterBank("MINE", "QUADS", [(0, 0), (0, 1), (0, -1)], [[0, 1, 0]])
    reduced = BANKS["LINEAR_SPLINE_REDUCED"]
    own, shifted = unitary_extension_defects(reduced.offsets, reduced.masks)
    assert own < EXACT < 0.01 < shifted
    assert not reduced.is_tight


def test_a_lattice_without_such_faces_is_refused():
    quads = FilterBank("MINE", "QUADS", BANKS["LINEAR_SPLINE"].offsets, BANKS["LINEAR_SPLINE"].masks)
    with pytest.raises(ValueError, match="MINE is a frame for quads, but the mesh has none"):
        make_transform(triangle_grid(), quads)
