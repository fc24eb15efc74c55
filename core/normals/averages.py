# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Weighted averages over neighborhoods, as products of small dense matrices.

Items that lie close together share most of their neighbors. A *tile* is eight of them; the union of their
neighborhoods has few more members than one of them three times. So each member is looked up once for a tile,
and the weights of a tile, with zeros where a member is no neighbor, make a matrix that BLAS multiplies with
the members' values several times faster than eight rows one by one.

Inside, items are numbered tile by tile. Fields have shape (n, C).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import DTypeLike, NDArray

from ..blocks import Blocks
from .parts import empty_parts, in_one_array

TILE = 8
"""Items in a tile: one for each bit of a byte."""

TILES_IN_BLOCK = 8192
"""Tiles that are made together and sorted by the number of their members."""

MEMBERS_AT_ONCE = 2**15
"""Members that a chunk may look up, so that their values stay in the cache."""

CHUNKS_AT_ONCE = 4
"""Chunks in a piece of work for a thread."""

ITEMS_AT_ONCE = 2**14
"""Items in a piece of work for a thread."""

_PADDING = 4  # numbers of members are rounded up to multiples, so that there are few kinds of tiles


class Members(NamedTuple):
    """That `member[i]` is a neighbor of items of tile `tile[i]`; it may be said repeatedly.

    Bit k of `bits[i]` stands for item k of the tile.
    """

    tile: NDArray[np.integer]
    member: NDArray[np.integer]
    bits: NDArray[np.uint8]


BITS = np.left_shift(1, np.arange(TILE)).astype(np.uint8)
"""The bit of each item of a tile."""


class Chunk(NamedTuple):
    """Tiles with as many members, numbered inside.

    Attributes
    ----------
    begin : int
        Number of the first tile, the others follow.
    members : ndarray, shape (n, U), int32
        Members of the tiles.
    bits : ndarray, shape (n, U), uint8
        Bit i tells whether a member is in the neighborhood of item i of the tile.
    """

    begin: int
    members: NDArray[np.int32]
    bits: NDArray[np.uint8]

    @property
    def rows(self) -> NDArray[np.intp]:
        """The items, shape (n, TILE)."""
        return TILE * self.begin + np.arange(TILE * len(self.members)).reshape(-1, TILE)

    @property
    def mask(self) -> NDArray[np.bool_]:
        """Which members are in the neighborhood of which item, shape (n, TILE, U)."""
        return (self.bits[:, None] & BITS[:, None]) != 0


Weights = list[NDArray[np.floating]]
"""For each chunk the weights of its members, shape (n, TILE, U), zero where `Chunk.mask` is not set."""


class Averages:
    """Neighborhoods in tiles.

    Parameters
    ----------
    around : callable
        `around(items)` returns the neighborhoods of the items of tiles, shape (n, TILE), as `Members`.
    order : ndarray, shape (n,), int
        The items, each once, so that those that follow each other lie close together.
    blocks : Blocks
        Threads to work on.
    """

    def __init__(
        self, around: Callable[[NDArray[np.int32]], Members], order: NDArray[np.integer], blocks: Blocks
    ) -> None:
        self._blocks, self._item_blocks = blocks.sized(CHUNKS_AT_ONCE), blocks.sized(ITEMS_AT_ONCE)
        n_items = len(order)
        n_tiles = -(-n_items // TILE)
        # The last tile is filled up with the last item once more.
        items = np.full((n_tiles, TILE), order[-1] if n_items else 0, np.int32)
        items.ravel()[:n_items] = order

        def make(start: int, stop: int) -> list[Chunk]:
            found = united(around(items[start:stop]), stop - start, n_items)
            sizes = -(-np.diff(found.offset) // _PADDING) * _PADDING
            by_size = np.argsort(sizes, kind="stable")
            items[start:stop] = items[start:stop][by_size]
            return list(_chunks(found, sizes, by_size, start))

        made = blocks.sized(TILES_IN_BLOCK).run(make, n_tiles)
        self._items = items.ravel()
        self._place = np.empty(n_items, np.int32)
        self._place[self._items] = np.arange(len(self._items), dtype=np.int32)
        chunks = [chunk for part in made for chunk in part]
        members = in_one_array([chunk.members for chunk in chunks], np.int32)
        bits = in_one_array([chunk.bits for chunk in chunks], np.uint8)
        self._chunks = list(map(Chunk, (chunk.begin for chunk in chunks), members, bits))
        for part in members:
            part[...] = self._place.take(part)

    def inward(self, field: NDArray) -> NDArray:
        """Return a field, shape (n, ...), as it is numbered inside; an item or two are there repeatedly."""
        return field.take(self._items, axis=0)

    def inward_rows(self, columns: Sequence[NDArray]) -> NDArray:
        """Return a field, shape (n, C), given as C columns (n,), as it is numbered inside."""
        result = np.empty((len(self._items), len(columns)), columns[0].dtype)

        def kernel(start: int, stop: int) -> None:
            for index, column in enumerate(columns):
                result[start:stop, index] = column.take(self._items[start:stop])

        self.for_items(kernel)
        return result

    def inward_columns(self, field: NDArray) -> NDArray:
        """Return a field of vectors in columns, shape (C, n), as it is numbered inside."""
        return field.take(self._items, axis=1)

    def outward(self, field: NDArray) -> NDArray:
        """Return a field that is numbered as inside, shape (n, ...), as the caller numbers it."""
        field = np.ascontiguousarray(field)
        result = np.empty((len(self._place), *field.shape[1:]), field.dtype)

        def kernel(start: int, stop: int) -> None:
            field.take(self._place[start:stop], axis=0, out=result[start:stop], mode="clip")

        self._item_blocks.run(kernel, len(self._place))
        return result

    def for_chunks(
        self, fill: Callable[[Chunk, NDArray[np.floating]], None], dtype: DTypeLike = np.float64
    ) -> Weights:
        """Return weights: `fill(chunk, weights)` sets those of a chunk, on threads."""
        shapes = [(len(chunk.members), TILE, chunk.members.shape[1]) for chunk in self._chunks]
        weights = empty_parts(shapes, dtype)

        def kernel(start: int, stop: int) -> None:
            for chunk, part in zip(self._chunks[start:stop], weights[start:stop], strict=True):
                fill(chunk, part)

        self._blocks.run(kernel, len(self._chunks))
        return weights

    def for_items(self, kernel: Callable[[int, int], None]) -> None:
        """Call `kernel(start, stop)` for ranges of the items, numbered as inside, on threads."""
        self._item_blocks.run(kernel, len(self._items))

    def go_on(
        self,
        weights: Weights,
        field: NDArray[np.floating],
        before: NDArray[np.floating],
        out: NDArray[np.floating],
        use: Callable[[int, int], None] = lambda start, stop: None,
    ) -> None:
        """Set `out` to 2 A field - before, as Chebyshev polynomials go on; it may be the field before.

        All are numbered as inside, shape (n, C). `use(start, stop)` is called on threads for ranges of items,
        while what was set for them is in the cache.
        """
        old, new = (values.reshape(-1, TILE, before.shape[1]) for values in (before, out))

        def kernel(start: int, stop: int) -> None:
            for (begin, members, _), weight in zip(
                self._chunks[start:stop], weights[start:stop], strict=True
            ):
                end = begin + len(members)
                means = np.matmul(weight, field.take(members, axis=0))
                means *= 2
                np.subtract(means, old[begin:end], out=new[begin:end])
                use(TILE * begin, TILE * end)

        self._blocks.run(kernel, len(self._chunks))

    def average(self, weights: Weights, field: NDArray[np.floating]) -> NDArray[np.floating]:
        """Return the averages of a field; both are numbered as inside, shape (n, C)."""
        result = np.empty_like(field)
        tiles = result.reshape(-1, TILE, field.shape[1])

        def kernel(start: int, stop: int) -> None:
            for (begin, members, _), weight in zip(
                self._chunks[start:stop], weights[start:stop], strict=True
            ):
                np.matmul(weight, field.take(members, axis=0), out=tiles[begin : begin + len(members)])

        self._blocks.run(kernel, len(self._chunks))
        return result


class Tiles(NamedTuple):
    """Members of tiles, those of tile i from `offset[i]` to `offset[i + 1]`, ascending, and their bits."""

    offset: NDArray[np.intp]
    member: NDArray[np.int32]
    bits: NDArray[np.uint8]


def united(members: Members, n_tiles: int, n_items: int) -> Tiles:
    """Return each member of a tile once, with all its bits."""
    keys = members.tile.astype(np.int64)
    keys *= n_items
    keys += members.member
    keys <<= TILE
    keys |= members.bits
    keys.sort()
    bits = keys.astype(np.uint8)
    keys >>= TILE
    is_first = np.ones(len(keys), bool)
    np.not_equal(keys[1:], keys[:-1], out=is_first[1:])
    first = np.flatnonzero(is_first)
    if len(first):
        bits = np.bitwise_or.reduceat(bits, first)
    tile, member = np.divmod(keys[first], max(n_items, 1))
    offset = np.concatenate(([0], np.cumsum(np.bincount(tile, minlength=n_tiles))))
    return Tiles(offset, member.astype(np.int32), bits)


def _chunks(tiles: Tiles, sizes: NDArray[np.intp], by_size: NDArray[np.intp], first_tile: int) -> list[Chunk]:
    """Return tiles, sorted by size, as chunks of one size each; short ones repeat a member without bits."""
    chunks = []
    begin = 0
    for size in np.unique(sizes):
        alike = by_size[begin : begin + int((sizes == size).sum())]
        at_once = max(1, MEMBERS_AT_ONCE // max(int(size), 1))
        for part in np.split(alike, range(at_once, len(alike), at_once)):
            place = tiles.offset[part][:, None] + np.arange(size)
            is_there = place < tiles.offset[part + 1][:, None]
            place[~is_there] = 0
            bits = tiles.bits.take(place) if size else np.zeros(place.shape, np.uint8)
            bits[~is_there] = 0
            members = tiles.member.take(place) if size else np.zeros(place.shape, np.int32)
            chunks.append(Chunk(first_tile + begin, members, bits))
            begin += len(part)
    return chunks
