# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of a block times small matrices, and biases for them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .face_graph import FACES_AT_ONCE

SMALL_PRODUCT = 2**17
"""Multiplications up to which OpenBLAS works on the calling thread: half of its limit."""

Matrix = NDArray[np.float32]


class Bias:
    """Rows that are added for the faces or pairs of a block: those of their islands.

    Parameters
    ----------
    rows : ndarray, shape (I, n), float32
        A row for each island.
    island : ndarray, shape (F,), intp, or None
        The island of each face; None if there is one.
    """

    def __init__(self, rows: Matrix, island: NDArray[np.intp] | None) -> None:
        self._island = island
        # NumPy adds whole blocks several times faster than short rows.
        self._rows = np.tile(rows, (FACES_AT_ONCE, 1)) if island is None else rows

    def of(self, faces: slice | NDArray[np.int32], n: int) -> Matrix:
        """Return the rows for n faces, shape (n, ...)."""
        return self._rows[:n] if self._island is None else self._rows.take(self._island[faces], axis=0)


def tiled(bias: Matrix) -> Matrix:
    """Return a bias repeated over a block: NumPy adds whole blocks several times faster than short rows."""
    return np.tile(bias, (FACES_AT_ONCE, 1))


def times(rows: Matrix, matrix: Matrix, out: Matrix | None = None) -> Matrix:
    """Return rows times a matrix, in pieces that are too small for a matrix library to start threads for."""
    n_inner, n_columns = matrix.shape
    if out is None:
        out = np.empty((len(rows), n_columns), np.float32)
    size = SMALL_PRODUCT // (n_inner * n_columns)
    n_whole = len(rows) // size
    whole = n_whole * size
    if n_whole:
        np.matmul(
            rows[:whole].reshape(n_whole, size, n_inner),
            matrix,
            out=out[:whole].reshape(n_whole, size, n_columns),
        )
    if whole < len(rows):
        np.matmul(rows[whole:], matrix, out=out[whole:])
    return out


def product(rows: Matrix, matrix: Matrix, bias: Matrix, out: Matrix | None = None) -> Matrix:
    """Return rows times a matrix plus a bias."""
    result = times(rows, matrix, out)
    result += bias[: len(rows)]
    return result
