# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The product of masks and data-matrix, alpha = M D (3.6), for blocks of vertices."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

SINGLE_THREAD_LIMIT = 2**18
"""Multiply-adds below which a matrix library stays on the calling thread, instead of competing with ours."""

_HADAMARD = np.array(
    [[2, 1, 1, 1, 1, 1, 1], [2, -1, -1, 1, -1, -1, 1], [2, 1, -1, -1, 1, -1, -1], [2, -1, 1, -1, -1, 1, -1]]
)


class MaskProduct:
    """Applies some rows of a mask-matrix.

    The four rows that Algorithm-Tri-2 needs of the box spline banks are, times eight, a 4-point Hadamard
    transform of (2 V, P1 + P4, P2 + P5, P3 + P6): eight additions instead of 28 multiply-adds.

    Parameters
    ----------
    masks : array_like, shape (B, T)
        Rows to apply.
    dtype : dtype
        Precision to work in.
    """

    def __init__(self, masks: ArrayLike, dtype: DTypeLike) -> None:
        masks = np.asarray(masks, np.float64)
        self._is_hadamard = masks.shape == _HADAMARD.shape and bool((8.0 * masks == _HADAMARD).all())
        self._masks = masks.astype(dtype)

    def __call__(self, matrix: NDArray[np.floating]) -> NDArray[np.floating]:
        """Return the coefficients, shape (3, B, n), of a data-matrix of shape (3, T, n)."""
        coefficients = np.empty((3, len(self._masks), matrix.shape[2]), matrix.dtype)
        if self._is_hadamard:
            _hadamard(matrix, coefficients)
            return coefficients
        step = max(1, SINGLE_THREAD_LIMIT // self._masks.size)
        for start in range(0, matrix.shape[2], step):
            part = slice(start, start + step)
            np.matmul(self._masks, matrix[:, :, part], out=coefficients[:, :, part])
        return coefficients


def _hadamard(matrix: NDArray[np.floating], out: NDArray[np.floating]) -> None:
    """Butterflies for the masks `_HADAMARD` / 8; one coordinate at a time, which stays in the cache."""
    for points, bands in zip(matrix, out, strict=True):
        center = points[0] + points[0]
        first = points[1] + points[4]
        second = points[2] + points[5]
        third = points[3] + points[6]
        plus, minus = center + first, center - first
        both, apart = second + third, third - second
        np.add(plus, both, out=bands[0])
        np.add(minus, apart, out=bands[1])
        np.subtract(plus, both, out=bands[2])
        np.subtract(minus, apart, out=bands[3])
        bands *= bands.dtype.type(0.125)
