# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The product of masks and data-matrix, alpha = M D (3.6), for blocks of vertices."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

SINGLE_THREAD_LIMIT = 2**18
"""Multiply-adds below which a matrix library stays on the calling thread, instead of competing with ours."""

_HADAMARD = np.array(
    [[2, 1, 1, 1, 1, 1, 1], [2, -1, -1, 1, -1, -1, 1], [2, 1, -1, -1, 1, -1, -1], [2, -1, 1, -1, -1, 1, -1]]
)


def apply_matrix(
    matrix: NDArray[np.floating], data: NDArray[np.floating], out: NDArray[np.floating] | None = None
) -> NDArray[np.floating]:
    """Return a matrix (B, T) times data of shape (3, T, n), on the calling thread alone."""
    if out is None:
        out = np.empty((3, len(matrix), data.shape[2]), data.dtype)
    step = max(1, SINGLE_THREAD_LIMIT // max(matrix.size, 1))
    for start in range(0, data.shape[2], step):
        part = slice(start, start + step)
        np.matmul(matrix, data[:, :, part], out=out[:, :, part])
    return out


def is_hadamard(masks: NDArray[np.floating]) -> bool:
    """Return whether masks, shape (B, T), are the four that `hadamard_bands` applies."""
    return masks.shape == _HADAMARD.shape and bool((8.0 * masks == _HADAMARD).all())


def hadamard_bands(
    centers: NDArray[np.floating], rings: NDArray[np.floating], low: NDArray[np.floating] | None = None
) -> NDArray[np.floating]:
    """Return the high bands, shape (3, 3, n), of the masks that Algorithm-Tri-2 needs of the box spline.

    Times eight they are a 4-point Hadamard transform of (2 V, P1 + P4, P2 + P5, P3 + P6): eight additions
    instead of 28 multiply-adds, and no data-matrix.

    Parameters
    ----------
    centers : ndarray, shape (3, n)
        The vertices themselves.
    rings : ndarray, shape (3, 6, n)
        The points under the other taps.
    low : ndarray, shape (3, n), optional
        Receives the low-pass.
    """
    high = np.empty((3, 3, rings.shape[2]), rings.dtype)
    eighth = high.dtype.type(0.125)
    pairs = rings[:, :3] + rings[:, 3:]
    center = centers + centers
    minus = center - pairs[:, 0]
    plus = np.add(center, pairs[:, 0], out=center)
    both = pairs[:, 1] + pairs[:, 2]
    apart = np.subtract(pairs[:, 2], pairs[:, 1], out=pairs[:, 0])
    if low is not None:
        np.add(plus, both, out=low)
        low *= eighth
    np.add(minus, apart, out=high[:, 0])
    np.subtract(plus, both, out=high[:, 1])
    np.subtract(minus, apart, out=high[:, 2])
    high *= eighth
    return high
