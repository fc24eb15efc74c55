# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Plain means over neighborhoods of different sizes.

Fields have shape (n, C); with C = 4, one column unused, three coordinates are looked up as one item of 16
bytes, which NumPy does about three times faster than three items of four.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise, starmap
from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

from ..blocks import Blocks
from ..mesh.ragged import Chunk, Ragged

CHUNKS_AT_ONCE = 4
"""Chunks in a piece of work for a thread."""


class Means:
    """Neighborhoods, sorted by size within blocks. Inside, items are numbered in this order.

    Parameters
    ----------
    neighborhoods : Ragged
        The members of each item.
    blocks : Blocks
        Threads to work on. Items of two blocks are sorted by the sizes of their neighborhoods together, and
        a chunk looks up as many members as a block has items, so that their values stay in the cache.
    is_square : bool
        Whether members are items themselves, so that fields of members are numbered as inside, too.
    """

    def __init__(self, neighborhoods: Ragged, blocks: Blocks, *, is_square: bool) -> None:
        n_items = len(neighborhoods.offset) - 1
        self._blocks, self._item_blocks = blocks.with_block_size(CHUNKS_AT_ONCE), blocks
        self._items = np.empty(n_items, np.int32)

        def make(start: int, stop: int) -> list[Chunk]:
            rows = np.arange(start, stop)
            chunks = list(neighborhoods.chunks(rows, lambda size: blocks.block_size // max(size, 1)))
            self._items[start:stop] = np.concatenate([chunk.rows for chunk in chunks])
            return chunks

        made = blocks.with_block_size(2 * blocks.block_size).run(make, n_items)
        members = in_one_array([chunk.items for part in made for chunk in part], np.int32)
        ends = np.cumsum([0, *(own.shape[1] for own in members)]).tolist()
        self._chunks = list(zip(starmap(slice, pairwise(ends)), members, strict=True))
        self._place = np.empty(n_items, np.int32)
        self._place[self._items] = np.arange(n_items, dtype=np.int32)
        if is_square:
            for part in members:
                part[...] = self._place.take(part)

    @property
    def place(self) -> NDArray[np.int32]:
        """The number of each item inside, shape (n,)."""
        return self._place

    def inward(self, field: NDArray[Any]) -> NDArray[Any]:
        """Return a field of the items, shape (n, ...), as it is numbered inside."""
        return self._item_blocks.take(field, self._items)

    def outward(self, field: NDArray[Any]) -> NDArray[Any]:
        """Return a field that is numbered as inside, shape (n, ...), as the caller numbers it."""
        return self._item_blocks.take(field, self._place)

    def for_parts(self, use: Callable[[slice, NDArray[np.int32]], None]) -> None:
        """Call `use(part, members)` for parts of the items, with their members, shape (K, n), on threads."""

        def kernel(start: int, stop: int) -> None:
            for part, members in self._chunks[start:stop]:
                use(part, members)

        self._blocks.run(kernel, len(self._chunks))

    def visit(self, field: NDArray[np.floating], use: Callable[[slice, NDArray[np.floating]], None]) -> None:
        """Call `use(part, means)` for parts of the items, with their means, shape (n, C), on threads.

        Without members the mean is zero. The means are the callee's to keep.
        """

        def average(part: slice, members: NDArray[np.int32]) -> None:
            count, n_items = members.shape
            if count:
                means = field.take(members, axis=0).reshape(count, -1).sum(axis=0)
                means *= field.dtype.type(1.0 / count)
            else:
                means = np.zeros(n_items * field.shape[1], field.dtype)
            use(part, means.reshape(n_items, -1))

        self.for_parts(average)

    def mean(self, field: NDArray[np.floating]) -> NDArray[np.floating]:
        """Return the means, shape (n, C), numbered as inside."""
        result = np.empty((len(self._items), field.shape[1]), field.dtype)

        def use(part: slice, means: NDArray[np.floating]) -> None:
            result[part] = means

        self.visit(field, use)
        return result


def in_one_array(parts: Sequence[NDArray[Any]], dtype: DTypeLike) -> list[NDArray[Any]]:
    """Return copies of arrays that lie in one array.

    Small arrays that live long would lie between those that come and go, and keep their memory from going
    back to the system.
    """
    flat = np.concatenate([np.zeros(0, dtype), *(part.ravel() for part in parts)], dtype=dtype)
    ends = np.cumsum([0, *(part.size for part in parts)])
    return [flat[slice(*ends[k : k + 2])].reshape(part.shape) for k, part in enumerate(parts)]


def padded(rows: NDArray[np.floating]) -> NDArray[np.floating]:
    """Return vectors in columns, shape (3, n) or (4, n), as rows, shape (n, 4); a fourth number is 0."""
    result = np.zeros((rows.shape[1], 4), rows.dtype)
    result[:, : len(rows)] = rows.T
    return result
