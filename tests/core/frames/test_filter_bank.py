# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The filter banks: their properties are computed, and their numbers are those of the paper."""

import numpy as np
import pytest
from framelet.core.frames import BANKS, FilterBank
from framelet.core.frames.b_spline import HIGHEST_ORDER, b_spline
from framelet.core.frames.box_spline import BOX_SPLINE_111, BOX_SPLINE_111_CANONICAL
from framelet.core.frames.filter_bank import unitary_extension_defects
from framelet.core.frames.four_direction import BOX_SPLINE_FOUR_DIRECTION
from framelet.core.frames.linear_spline import LINEAR_SPLINE, LINEAR_SPLINE_REDUCED
from framelet.core.frames.mask_product import SINGLE_THREAD_LIMIT, apply_matrix, hadamard_bands, is_hadamard

EXACT = 1e-13

TIGHT = [
    BOX_SPLINE_111,
    BOX_SPLINE_111_CANONICAL,
    BOX_SPLINE_FOUR_DIRECTION,
    LINEAR_SPLINE,
    *(b_spline(order) for order in range(1, HIGHEST_ORDER + 1)),
]
ALL = [*TIGHT, LINEAR_SPLINE_REDUCED]


def by_name(banks):
    return pytest.mark.parametrize("bank", banks, ids=lambda bank: bank.name)


def spectra(bank, frequencies):
    """Return the transforms of all masks at frequencies (n, 2), shape (B, n)."""
    return bank.masks @ np.exp(-1j * (bank.offsets @ frequencies.T))


@by_name(ALL)
def test_unitary_extension_principle_by_sampling(bank, rng):
    """(2.6) and (2.7), on frequencies instead of in the space domain."""
    frequencies = rng.uniform(-np.pi, np.pi, (200, 2))
    here = spectra(bank, frequencies)
    assert np.abs((np.abs(here) ** 2).sum(axis=0) - 1.0).max() < EXACT
    worst = 0.0
    for shift in ((0, 1), (1, 0), (1, 1)):
        there = spectra(bank, frequencies + np.pi * np.array(shift))
        worst = max(worst, np.abs((here * there.conj()).sum(axis=0)).max())
    assert (worst < EXACT) == bank.is_tight
    assert bank.is_tight == (bank in TIGHT)
    assert bank.is_tight or worst > 0.01


@by_name(ALL)
def test_row_sums_and_sizes(bank):
    assert np.abs(bank.masks.sum(axis=1) - np.eye(bank.n_bands)[0]).max() < EXACT
    assert (bank.low_pass > 0).all()
    assert bank.masks.shape == (bank.n_bands, bank.n_taps) == (len(bank.masks), len(bank.offsets))


@by_name(ALL)
def test_diagonality_as_computed_here(bank):
    off = np.abs(bank.masks.T @ bank.masks - np.diag(bank.masks[0])).max()
    assert bank.is_diagonal == (off < EXACT) == (bank in TIGHT)
    assert bank.is_diagonal or off > 0.01


@by_name(ALL)
def test_rows_v_bring_central_points_back(bank, rng):
    n_central = 4 if bank.is_cell_centered else 1
    assert bank.reconstruction.shape == (n_central, bank.n_bands)
    points = rng.normal(size=(bank.n_taps, 3))
    assert np.abs(bank.reconstruction @ bank.masks @ points - points[:n_central]).max() < 1e-12
    if bank.is_diagonal:
        expected = bank.masks[:, :n_central].T / bank.masks[0, :n_central, None]
        assert np.abs(bank.reconstruction - expected).max() < 1e-12


@pytest.mark.parametrize(
    ("bank", "v"),
    [
        (BOX_SPLINE_111, [1, 1, 1, 1, 0, 0, 0]),
        (BOX_SPLINE_111_CANONICAL, [1, 1, 1, 1, 0, 0, 0, 0]),
        (LINEAR_SPLINE, [1, 0, 0, 1, 0, 1, 0, 0, 1]),
        (LINEAR_SPLINE_REDUCED, [1, 0, 0, 1, 0, 1]),
    ],
    ids=lambda given: getattr(given, "name", ""),
)
def test_rows_v_of_the_paper(bank, v):
    assert np.abs(bank.reconstruction[0] - v).max() < EXACT
    assert bank.used_bands.tolist() == np.flatnonzero(v).tolist()


def test_numbers_of_the_box_spline():
    """(3.5) and (3.8): a typing error could still be tight, so the numbers are written out once more."""
    r2, r3, r6 = np.sqrt([2.0, 3.0, 6.0])
    shared = [
        [2, 1, 1, 1, 1, 1, 1],
        [2, -1, -1, 1, -1, -1, 1],
        [2, 1, -1, -1, 1, -1, -1],
        [2, -1, 1, -1, -1, 1, -1],
    ]
    own = [
        [0, *np.array([-1, -1, -1, 1, 1, 1]) * (2 * r3 / 3)],
        [0, *np.array([1, 1, -2, -1, -1, 2]) * (r6 / 3)],
        [0, *np.array([1, -1, 0, -1, 1, 0]) * r2],
    ]
    canonical = [[1, -1, 1, -1, 1, -1], [-1, -1, -1, 1, 1, 1], [-1, 1, 1, 1, -1, -1], [1, 1, -1, -1, -1, 1]]
    assert np.abs(8 * BOX_SPLINE_111.masks - [*shared, *own]).max() < EXACT * 8
    assert np.array_equal(8 * BOX_SPLINE_111_CANONICAL.masks, [*shared, *([0, *row] for row in canonical)])
    clockwise = [[0, 0], [-1, -1], [-1, 0], [0, 1], [1, 1], [1, 0], [0, -1]]
    assert BOX_SPLINE_111.offsets.tolist() == BOX_SPLINE_111_CANONICAL.offsets.tolist() == clockwise
    assert {bank.name for bank in BANKS.values()} == set(BANKS)


def test_linear_spline_is_the_tensor_product():
    """(5.1), up to signs; the order of the masks is the paper's."""
    h = np.array([[1, 2, 1], [np.sqrt(2), 0, -np.sqrt(2)], [-1, 2, -1]]) / 4
    order = [(0, 0), (0, 1), (1, 0), (0, 2), (1, 1), (2, 0), (1, 2), (2, 1), (2, 2)]
    spline = b_spline(2).masks
    for mask, (a, b) in zip(LINEAR_SPLINE.masks, order, strict=True):
        expected = np.outer(h[a], h[b])[tuple((LINEAR_SPLINE.offsets + 1).T)]
        for other in (expected, spline[3 * a + b]):
            assert min(np.abs(mask - other).max(), np.abs(mask + other).max()) < EXACT


@pytest.mark.parametrize("order", [0, HIGHEST_ORDER + 1, -1])
def test_b_spline_orders(order):
    with pytest.raises(ValueError, match=rf"The B-spline order is {order}; it must be 1 to {HIGHEST_ORDER}"):
        b_spline(order)


@by_name(ALL)
def test_banks_cannot_be_changed(bank):
    with pytest.raises(ValueError, match="read-only"):
        bank.masks[0, 0] = 1.0
    with pytest.raises(ValueError, match="read-only"):
        bank.offsets[0, 0] = 1


def test_a_bank_does_not_share_its_callers_arrays():
    masks = BOX_SPLINE_111.masks.copy()
    bank = FilterBank("MINE", "TRIANGLES", BOX_SPLINE_111.offsets, masks)
    masks[:] = 0
    assert np.array_equal(bank.masks, BOX_SPLINE_111.masks)


TAPS, MASKS = BOX_SPLINE_111.offsets, BOX_SPLINE_111.masks
NOT_SQUARES = MASKS.copy()
NOT_SQUARES[4] *= 1.5
NOT_ONE = MASKS * 1.25
NOT_ZERO = MASKS.copy()
NOT_ZERO[2, 0] += 0.125
INFINITE = MASKS.copy()
INFINITE[1, 1] = np.inf


@pytest.mark.parametrize(
    ("lattice", "offsets", "masks", "message"),
    [
        ("HEXAGONS", TAPS, MASKS, "BAD: the lattice is 'HEXAGONS'; choose one of TRIANGLES"),
        ("TRIANGLES", TAPS.ravel(), MASKS, r"BAD: the offsets have shape \(14,\); expected \(T, 2\)"),
        ("TRIANGLES", TAPS[:, :1], MASKS, r"BAD: the offsets have shape \(7, 1\); expected \(T, 2\)"),
        ("TRIANGLES", TAPS[:6], MASKS, r"BAD: the masks have shape \(7, 7\); expected \(B, 6\)"),
        ("TRIANGLES", TAPS, MASKS[0], r"BAD: the masks have shape \(7,\); expected \(B, 7\)"),
        ("TRIANGLES", TAPS, INFINITE, "BAD: the masks hold numbers that are not finite"),
        ("TRIANGLES", TAPS[[0, 1, 2, 3, 4, 5, 5]], MASKS, "BAD: two taps have the same place"),
        (
            "TRIANGLES",
            np.roll(TAPS, 1, axis=0),
            MASKS,
            r"BAD: the first taps are at \[\(0, -1\)\]; they must be at",
        ),
        ("TRIANGLES", TAPS, NOT_ONE, "BAD: mask 0 sums to 1.25; it must sum to 1"),
        ("TRIANGLES", TAPS, NOT_ZERO, "BAD: mask 2 sums to 0.125; it must sum to 0"),
        (
            "TRIANGLES",
            TAPS,
            NOT_SQUARES,
            r"BAD: the masks do not satisfy .*\(2.6\), sum \|a\|\^2 = 1; they are off by",
        ),
        ("TRIANGLES", [(0, 0), (0, 1), (0, -1)], [[0, 1, 0]], r"BAD: no row v gives v M = delta_0"),
        ("TRIANGLES", TAPS, np.zeros((0, 7)), "BAD: "),
        ("TRIANGLES", np.zeros((0, 2)), np.zeros((1, 0)), "BAD: "),
    ],
)
def test_wrong_banks_are_refused(lattice, offsets, masks, message):
    with pytest.raises(ValueError, match=message):
        FilterBank("BAD", lattice, offsets, masks)


def test_defects_are_measured():
    own, shifted = unitary_extension_defects(TAPS, NOT_SQUARES)
    gram = NOT_SQUARES[4] @ NOT_SQUARES[4] * (1 - 1 / 1.5**2)
    assert own == pytest.approx(gram)
    assert shifted > 0.01


@by_name(ALL)
@pytest.mark.parametrize(("dtype", "tolerance"), [(np.float64, 1e-14), (np.float32, 2e-6)])
def test_mask_product(bank, dtype, tolerance, rng):
    """Also for many vertices, where the product is cut into steps, and for the Hadamard shortcut."""
    for rows in (np.arange(bank.n_bands), bank.used_bands, [0]):
        for n in (0, 1, 50 + SINGLE_THREAD_LIMIT // (len(rows) * bank.n_taps)):
            matrix = rng.normal(size=(3, bank.n_taps, n)).astype(dtype)
            matrix.flags.writeable = False
            masks = bank.masks[rows]
            result = apply_matrix(masks.astype(dtype), matrix)
            if is_hadamard(masks):
                low = np.empty((3, n), dtype)
                high = hadamard_bands(matrix[:, 0], matrix[:, 1:], low)
                assert high.dtype == dtype
                apart = np.concatenate((low[:, None], high), axis=1) - result
                assert np.abs(apart).max(initial=0) < tolerance
            assert result.dtype == dtype
            assert result.shape == (3, len(rows), n)
            for place in (0, n // 2, n - 1) if n else ():
                for axis in range(3):
                    for row, mask in enumerate(bank.masks[rows]):
                        expected = sum(
                            a * x for a, x in zip(mask, matrix[axis, :, place].tolist(), strict=True)
                        )
                        assert abs(result[axis, row, place] - expected) < tolerance
