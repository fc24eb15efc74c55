# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Filter banks: masks on a lattice and the properties that the transforms rest on."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import FrameError
from ..precision import as_array
from ..value_checks import check_choice

EXACT = 1e-12
"""Rounding that a property may be off by in float64."""

CELL_CORNERS = ((0, 0), (0, 1), (1, 1), (1, 0))
"""The central taps of a cell-centered bank, in order around the cell."""


class FilterBank:
    """Masks of a tight wavelet frame on a triangle or quad lattice.

    Parameters
    ----------
    name : str
        Name of the bank.
    lattice : {"TRIANGLES", "QUADS", "ANY"}
        Lattice that the masks live on; ANY for cell-centered masks that serve pairs of triangles as well.
    offsets : array_like, shape (T, 2), int
        (row, column) of each tap, rows growing downwards. A bank is vertex-centered if tap 0 is (0, 0), the
        vertex itself, and the taps lie evenly around it; it is cell-centered if they lie evenly around the
        cell with the corners (0, 0), (0, 1), (1, 1), (1, 0), which are taps 0 to 3 in this order.
    masks : array_like, shape (B, T)
        The mask-matrix M, one mask a row: row 0 is the low-pass, which sums to 1, all others sum to 0.

    Attributes
    ----------
    is_cell_centered : bool
        True if coefficients live on cells instead of vertices.
    reconstruction : ndarray, shape (1 or 4, B), float64
        For each central tap c the row v of least norm with v M = delta_c, so that the vertex at this tap
        comes back from the coefficients. A vertex-centered bank has one central tap, tap 0. As M maps
        constants to (1, 0, ..., 0), the low-pass entry of every such row is 1.
    is_tight : bool
        True if the unitary extension principle (2.6), (2.7) holds.
    is_diagonal : bool
        True if M'M = diag(low-pass), the condition for tightness on irregular meshes.

    Raises
    ------
    FrameError
        If shapes, row sums, the sum of squares (2.6) or the existence of v fail; the message names which.
    """

    def __init__(self, name: str, lattice: str, offsets: ArrayLike, masks: ArrayLike) -> None:
        self.name = name
        self.lattice = lattice
        self.offsets = _numbers(f"{name}: the offsets", offsets, np.int64)
        self.masks = _numbers(f"{name}: the masks", masks, np.float64)
        self._check_shapes()
        self.is_cell_centered = self._find_centering()
        self._check_row_sums()
        own, shifted = unitary_extension_defects(self.offsets, self.masks)
        if own > EXACT:
            raise FrameError(
                f"{name}: the masks do not satisfy the UEP (2.6), sum |a|^2 = 1; they are off by {own:.2g}."
            )
        self.is_tight = shifted <= EXACT
        gram = self.masks.T @ self.masks
        self.is_diagonal = bool(np.abs(gram - np.diag(self.low_pass)).max() <= EXACT)
        self.reconstruction = reconstruction_rows(self.masks, 4 if self.is_cell_centered else 1, name)
        for array in (self.offsets, self.masks, self.reconstruction):
            array.flags.writeable = False

    def __repr__(self) -> str:
        kind = "cells" if self.is_cell_centered else "vertices"
        return f"FilterBank({self.name}, {self.lattice}, {kind}, {self.n_taps} taps, {self.n_bands} bands)"

    def _check_shapes(self) -> None:
        check_choice(f"{self.name}: the lattice", self.lattice, ("TRIANGLES", "QUADS", "ANY"), FrameError)
        if self.offsets.ndim != 2 or self.offsets.shape[1] != 2 or not len(self.offsets):
            raise FrameError(f"{self.name}: the offsets have shape {self.offsets.shape}; expected (T, 2).")
        if self.masks.ndim != 2 or self.masks.shape[1] != len(self.offsets) or not len(self.masks):
            raise FrameError(
                f"{self.name}: the masks have shape {self.masks.shape}; expected (B, {len(self.offsets)})."
            )
        if not np.isfinite(self.masks).all():
            raise FrameError(f"{self.name}: the masks hold numbers that are not finite.")
        if len({tuple(place) for place in self.offsets.tolist()}) < len(self.offsets):
            raise FrameError(f"{self.name}: two taps have the same place; give each place once.")

    def _find_centering(self) -> bool:
        """Return whether the bank is cell-centered; raise FrameError if its taps are in the wrong order."""
        reach = self.offsets.max(axis=0) + self.offsets.min(axis=0)
        is_cell = bool((reach == 1).all())
        centers = CELL_CORNERS if is_cell else ((0, 0),)
        first = [tuple(place) for place in self.offsets[: len(centers)].tolist()]
        if first != list(centers):
            raise FrameError(f"{self.name}: the first taps are at {first}; they must be at {list(centers)}.")
        return is_cell

    def _check_row_sums(self) -> None:
        expected = np.zeros(len(self.masks))
        expected[0] = 1.0
        off = np.abs(self.masks.sum(axis=1) - expected)
        if off.max() > EXACT:
            row = int(off.argmax())
            raise FrameError(
                f"{self.name}: mask {row} sums to {self.masks[row].sum():.6g}; "
                f"it must sum to {expected[row]:g}."
            )

    @property
    def n_taps(self) -> int:
        """Number of taps, T."""
        return self.masks.shape[1]

    @property
    def n_bands(self) -> int:
        """Number of bands, B, the low-pass included."""
        return self.masks.shape[0]

    @property
    def low_pass(self) -> NDArray[np.float64]:
        """The low-pass mask a0, shape (T,)."""
        return self.masks[0]

    @property
    def reach(self) -> int:
        """Largest row or column distance of a tap from the vertex, or from the nearest corner of the cell."""
        beyond = self.offsets - 1 if self.is_cell_centered else self.offsets
        return int(max(beyond.max(), -self.offsets.min()))

    @property
    def used_bands(self) -> NDArray[np.intp]:
        """Bands that reach the surface: the low-pass and those with an entry in v (Remark 4.1)."""
        return np.flatnonzero(np.abs(self.reconstruction).max(axis=0) > EXACT)


def _numbers(name: str, values: ArrayLike, dtype: type) -> NDArray[Any]:
    """Return a copy of numbers in a type; raise FrameError if they are none, or not whole if they must be."""
    found = as_array(name, values, FrameError)
    if found.dtype.kind not in ("iu" if dtype is np.int64 else "iuf"):
        raise FrameError(
            f"{name} are {found.dtype}; expected {'whole' if dtype is np.int64 else 'real'} numbers."
        )
    return found.astype(dtype)


def unitary_extension_defects(offsets: ArrayLike, masks: ArrayLike) -> tuple[float, float]:
    """Measure how far masks are from the unitary extension principle.

    For all shifts m and each parity class of taps k, sum_l sum_k a_l[k] a_l[k + m] must be delta_m / 4; this
    is (2.6) and (2.7) in the space domain, where it can be checked without sampling frequencies.

    Parameters
    ----------
    offsets : array_like, shape (T, 2), int
        Places of the taps.
    masks : array_like, shape (B, T)
        The masks.

    Returns
    -------
    own, shifted : float
        Largest errors of (2.6), the sum of squares, and of (2.7), its products with shifted spectra.
    """
    offsets = np.asarray(offsets, np.int64)
    gram = np.asarray(masks, np.float64).T @ np.asarray(masks, np.float64)
    shift = offsets[None, :, :] - offsets[:, None, :]
    parity = offsets % 2
    table: dict[tuple[int, int], NDArray[np.float64]] = {}
    for k in range(len(offsets)):
        for j in range(len(offsets)):
            sums = table.setdefault(tuple(shift[k, j].tolist()), np.zeros((2, 2)))
            sums[tuple(parity[k])] += gram[k, j]
    own = shifted = 0.0
    for m, sums in table.items():
        own = max(own, abs(sums.sum() - (m == (0, 0))))
        # (2.7) holds as well if and only if the four parity classes share the sum evenly.
        shifted = max(shifted, float(np.abs(sums - sums.mean()).max()))
    return float(own), shifted


def reconstruction_rows(
    masks: NDArray[np.float64], n_centers: int = 1, name: str = "masks"
) -> NDArray[np.float64]:
    """Return the rows v of least norm with v M = delta_c for the first taps c: (4.7), (5.8).

    Parameters
    ----------
    masks : ndarray, shape (B, T)
        The mask-matrix M.
    n_centers : int
        Number of central taps.
    name : str
        What the error message calls the masks.

    Returns
    -------
    ndarray, shape (n_centers, B), float64

    Raises
    ------
    FrameError
        If no such row exists, so that the masks cannot tell the vertex from its neighbors.
    """
    delta = np.eye(n_centers, masks.shape[1])
    rows = np.asarray(np.linalg.lstsq(masks.T, delta.T, rcond=None)[0].T, np.float64)
    rows[np.abs(rows) < EXACT] = 0.0
    off = np.abs(rows @ masks - delta).max()
    if off > EXACT:
        raise FrameError(f"{name}: no row v gives v M = delta_0 (nearest: off by {off:.2g}); add masks.")
    return rows
