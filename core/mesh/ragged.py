# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of different lengths: neighbors of vertices, corners of faces, vertices of patches."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray


class Ragged(NamedTuple):
    """Rows of different lengths: row i is `items[offset[i]:offset[i + 1]]`; items are whole numbers.

    Examples
    --------
    >>> rows = Ragged.of_lengths([2, 0, 1], np.array([7, 8, 9]))
    >>> rows.row_of_item
    array([0, 0, 2])
    >>> items, lengths = rows.taken(np.array([2, 0]))
    >>> items, lengths
    (array([9, 7, 8]), array([1, 2]))
    >>> rows.kept(rows.items > 7).offset
    array([0, 1, 1, 2])
    """

    offset: NDArray[np.int64]
    items: NDArray[Any]

    @classmethod
    def of_lengths(cls, lengths: NDArray[np.integer], items: NDArray[Any]) -> Ragged:
        """Return rows of given lengths, shape (n,), whose items stand one row behind the other."""
        return cls(np.concatenate(([0], np.cumsum(lengths))), items)

    @property
    def row_of_item(self) -> NDArray[np.intp]:
        """The row of each item."""
        return np.repeat(np.arange(len(self.offset) - 1), np.diff(self.offset))

    def kept(self, is_kept: NDArray[np.bool_]) -> Ragged:
        """Return the same rows with some of their items only, a mask as long as the items."""
        return Ragged(np.concatenate(([0], np.cumsum(is_kept)))[self.offset], self.items[is_kept])

    def taken(self, rows: NDArray[np.integer]) -> tuple[NDArray[Any], NDArray[np.int64]]:
        """Return the items of some rows, one row behind the other, and the lengths of these rows."""
        begin = self.offset[rows]
        lengths = self.offset[rows + 1] - begin
        return self.items[stretches(begin, lengths)], lengths


def stretches(begin: NDArray[np.integer], lengths: NDArray[np.integer]) -> NDArray[np.intp]:
    """Return stretches of whole numbers, one behind the other.

    Parameters
    ----------
    begin, lengths : ndarray, shape (n,), int
        The first number of each stretch, and how many there are; 0 is allowed.

    Returns
    -------
    ndarray, shape (sum of lengths,), intp

    Examples
    --------
    >>> stretches(np.array([10, 5]), np.array([2, 3]))
    array([10, 11,  5,  6,  7])
    """
    before = np.cumsum(lengths, dtype=np.intp) - lengths
    places: NDArray[np.intp] = np.repeat(begin - before, lengths)
    places += np.arange(len(places))
    return places
