# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of different lengths: neighbors of vertices, corners of faces, vertices of patches."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray


class Chunk(NamedTuple):
    """Rows of one length K: their numbers, shape (n,), and their items, shape (K, n)."""

    rows: NDArray[np.integer]
    items: NDArray[Any]


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
    >>> [(chunk.rows.tolist(), chunk.items.tolist()) for chunk in rows.chunks(np.arange(3), lambda _: 10)]
    [([1], []), ([2], [[9]]), ([0], [[7], [8]])]
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

    def chunks(self, rows: NDArray[np.integer], at_once: Callable[[int], int]) -> Iterator[Chunk]:
        """Yield some rows by their length, as arrays without gaps, so that NumPy works on many at a time.

        Of rows of length K at most `at_once(K)` come together. Rows of one length keep their order.
        """
        lengths = self.offset[rows + 1] - self.offset[rows]
        for length in np.flatnonzero(np.bincount(lengths)).tolist():
            alike, size = rows[lengths == length], max(1, at_once(length))
            for part in np.split(alike, range(size, len(alike), size)):
                yield Chunk(part, self.items[self.offset[part] + np.arange(length)[:, None]])


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
    places: NDArray[np.intp] = np.repeat(begin - starts(lengths), lengths)
    places += np.arange(len(places))
    return places


def starts(lengths: NDArray[np.integer]) -> NDArray[np.intp]:
    """Return where rows of given lengths begin that stand one behind the other, shape (n,), intp.

    Examples
    --------
    >>> starts(np.array([2, 0, 3]))
    array([0, 2, 2])
    """
    return np.cumsum(lengths, dtype=np.intp) - lengths
