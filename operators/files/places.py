# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertices of formats that store each of them many times."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

_FACTORS = np.array([0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9], np.uint64)


def merge_equal(points: NDArray[np.floating]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return which points are the same.

    Parameters
    ----------
    points : ndarray, shape (n, 3), float32 or float64
        Places; -0.0 is the same as 0.0.

    Returns
    -------
    vertex : ndarray, shape (n,), int64
        The same number for points at the same place, counted in the order of their first points.
    first : ndarray, shape (m,), int64
        The first point of each number.

    Examples
    --------
    >>> vertex, first = merge_equal(np.array([[0, 0, 1.0], [2, 0, 0], [-0.0, 0, 1]]))
    >>> vertex.tolist(), first.tolist()
    ([0, 1, 0], [0, 1])
    """
    n = len(points)
    if not n:
        return np.zeros(0, np.int64), np.zeros(0, np.int64)
    with np.errstate(invalid="ignore"):  # of what is no number
        bits = np.ascontiguousarray(points + points.dtype.type(0.0)).view(f"u{points.dtype.itemsize}")
    mixed = bits.astype(np.uint64) * _FACTORS
    key = mixed[:, 0] ^ (mixed[:, 1] >> np.uint64(17)) ^ (mixed[:, 2] << np.uint64(13)) ^ mixed[:, 1]
    order = np.argsort(key)
    is_new = _differs(bits[order], np.diff(key[order]) != 0)
    if is_new is None:  # two places with one key: sort by the places themselves
        order = np.lexsort((bits[:, 2], bits[:, 1], bits[:, 0]))
        is_new = np.append(True, (np.diff(bits[order].astype(np.int64), axis=0) != 0).any(axis=1))
    group = np.empty(n, np.int64)
    group[order] = np.cumsum(is_new) - 1
    first = np.minimum.reduceat(order, np.flatnonzero(is_new))
    by_first = np.argsort(first)
    rank = np.empty(len(first), np.int64)
    rank[by_first] = np.arange(len(first))
    return rank[group], first[by_first]


def _differs(rows: NDArray[Any], has_other_key: NDArray[np.bool_]) -> NDArray[np.bool_] | None:
    """Return which sorted rows differ from the one before, shape (n,); None if rows with one key differ."""
    differs = (rows[1:] != rows[:-1]).any(axis=1)
    if (differs & ~has_other_key).any():
        return None
    return np.append(True, differs)
