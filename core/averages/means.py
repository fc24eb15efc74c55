# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Plain means over neighborhoods of different sizes.

Fields have shape (n, C); with C = 4, one column unused, three coordinates are looked up as one item of 16
bytes, which NumPy does about three times faster than three items of four.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..mesh.ragged import Ragged
from .parts import in_one_array

ITEMS_IN_BLOCK = 2**16
"""Items that are sorted by the sizes of their neighborhoods together."""

MEMBERS_AT_ONCE = 2**15
"""Members that a chunk may look up, so that their values stay in the cache."""

CHUNKS_AT_ONCE = 4
"""Chunks in a piece of work for a thread."""


class _Chunk(NamedTuple):
    """Items with as many members: the number of the first one, and the members, shape (K, n)."""

    begin: int
    members: NDArray[np.int32]


class Means:
    """Neighborhoods, sorted by size within blocks. Inside, items are numbered in this order.

    Parameters
    ----------
    neighborhoods : Ragged
        The members of each item.
    blocks : Blocks
        Threads to work on.
    is_square : bool
        Whether members are items themselves, so that fields of members are numbered as inside, too.
    items_in_block, members_at_once : int, optional
        Items that are sorted by the sizes of their neighborhoods together; members that a chunk may look up.
    """

    def __init__(
        self,
        neighborhoods: Ragged,
        blocks: Blocks,
        *,
        is_square: bool,
        items_in_block: int = ITEMS_IN_BLOCK,
        members_at_once: int = MEMBERS_AT_ONCE,
    ) -> None:
        offset, items = neighborhoods
        n_items = len(offset) - 1
        self._blocks, self._item_blocks = blocks.with_block_size(CHUNKS_AT_ONCE), blocks
        self._items = np.empty(n_items, np.int32)

        def make(start: int, stop: int) -> list[_Chunk]:
            sizes = np.diff(offset[start : stop + 1])
            by_size = np.argsort(sizes, kind="stable")
            self._items[start:stop] = start + by_size
            chunks, begin = [], start
            for size in np.unique(sizes):
                alike = start + by_size[begin - start :][: int((sizes == size).sum())]
                at_once = max(1, members_at_once // max(int(size), 1))
                for part in np.split(alike, range(at_once, len(alike), at_once)):
                    members = items[offset[part] + np.arange(size)[:, None]]
                    chunks.append(_Chunk(begin, members))
                    begin += len(part)
            return chunks

        made = blocks.with_block_size(items_in_block).run(make, n_items)
        chunks = [chunk for part in made for chunk in part]
        members = in_one_array([chunk.members for chunk in chunks], np.int32)
        self._chunks = list(map(_Chunk, (chunk.begin for chunk in chunks), members))
        self._place = np.empty(n_items, np.int32)
        self._place[self._items] = np.arange(n_items, dtype=np.int32)
        if is_square:
            for part in members:
                part[...] = self._place.take(part)

    @property
    def place(self) -> NDArray[np.int32]:
        """The number of each item inside, shape (n,)."""
        return self._place

    def inward(self, field: NDArray) -> NDArray:
        """Return a field of the items, shape (n, ...), as it is numbered inside."""
        return self._taken(field, self._items)

    def outward(self, field: NDArray) -> NDArray:
        """Return a field that is numbered as inside, shape (n, ...), as the caller numbers it."""
        return self._taken(field, self._place)

    def _taken(self, field: NDArray, numbers: NDArray[np.int32]) -> NDArray:
        """Return the entries of a field with some numbers, looked up on threads."""
        field = np.ascontiguousarray(field)
        result = np.empty((len(numbers), *field.shape[1:]), field.dtype)

        def kernel(start: int, stop: int) -> None:
            field.take(numbers[start:stop], axis=0, out=result[start:stop], mode="clip")

        self._item_blocks.run(kernel, len(numbers))
        return result

    def for_parts(self, use: Callable[[slice, NDArray[np.int32]], None]) -> None:
        """Call `use(part, members)` for parts of the items, with their members, shape (K, n), on threads."""

        def kernel(start: int, stop: int) -> None:
            for begin, members in self._chunks[start:stop]:
                use(slice(begin, begin + members.shape[1]), members)

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


def padded(rows: NDArray[np.floating]) -> NDArray[np.floating]:
    """Return vectors in columns, shape (3, n) or (4, n), as rows, shape (n, 4); a fourth number is 0."""
    result = np.zeros((rows.shape[1], 4), rows.dtype)
    result[:, : len(rows)] = rows.T
    return result
