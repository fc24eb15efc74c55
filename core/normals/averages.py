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

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks

TILE = 8
"""Items in a tile: one for each bit of a byte."""

TILES_IN_BLOCK = 2048
"""Tiles that are made together and sorted by the number of their members."""

MEMBERS_AT_ONCE = 2**14
"""Members that a chunk may look up, so that their values stay in the cache."""

CHUNKS_AT_ONCE = 4
"""Chunks in a piece of work for a thread."""

_PADDING = 4  # numbers of members are rounded up to multiples, so that there are few kinds of tiles


class Pairs(NamedTuple):
    """That `member[i]` is in the neighborhood of the item in place `row[i]`; it may be said repeatedly."""

    row: NDArray[np.integer]
    member: NDArray[np.integer]


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
        one = np.left_shift(1, np.arange(TILE)).astype(np.uint8)[:, None]
        return (self.bits[:, None] & one) != 0


Weights = list[NDArray[np.floating]]
"""For each chunk the weights of its members, shape (n, TILE, U), zero where `Chunk.mask` is not set."""


class Averages:
    """Neighborhoods in tiles.

    Parameters
    ----------
    around : callable
        `around(items)` returns the neighborhoods of an array of items as `Pairs`.
    order : ndarray, shape (n,), int
        The items, each once, so that those that follow each other lie close together.
    blocks : Blocks
        Threads to work on.
    """

    def __init__(
        self, around: Callable[[NDArray[np.int32]], Pairs], order: NDArray[np.integer], blocks: Blocks
    ) -> None:
        self._blocks = blocks.sized(CHUNKS_AT_ONCE)
        n_items = len(order)
        n_tiles = -(-n_items // TILE)
        # The last tile is filled up with the last item once more.
        items = np.full((n_tiles, TILE), order[-1] if n_items else 0, np.int32)
        items.ravel()[:n_items] = order

        def make(start: int, stop: int) -> list[Chunk]:
            found = _tiles(around(items[start:stop].ravel()), stop - start, n_items)
            sizes = -(-np.diff(found.offset) // _PADDING) * _PADDING
            by_size = np.argsort(sizes, kind="stable")
            items[start:stop] = items[start:stop][by_size]
            return list(_chunks(found, sizes, by_size, start))

        made = blocks.sized(TILES_IN_BLOCK).run(make, n_tiles)
        self._chunks = [chunk for part in made for chunk in part]
        self._items = items.ravel()
        self._place = np.empty(n_items, np.int32)
        self._place[self._items] = np.arange(len(self._items), dtype=np.int32)
        for chunk in self._chunks:
            chunk.members[...] = self._place.take(chunk.members)

    def inward(self, field: NDArray) -> NDArray:
        """Return a field, shape (n, ...), as it is numbered inside; an item or two are there repeatedly."""
        return field.take(self._items, axis=0)

    def outward(self, field: NDArray) -> NDArray:
        """Return a field that is numbered as inside, shape (n, ...), as the caller numbers it."""
        return field.take(self._place, axis=0)

    def for_chunks(self, function: Callable[[Chunk], NDArray[np.floating]]) -> Weights:
        """Return what a function makes of each chunk."""

        def kernel(start: int, stop: int) -> list[NDArray[np.floating]]:
            return [function(chunk) for chunk in self._chunks[start:stop]]

        return [part for piece in self._blocks.run(kernel, len(self._chunks)) for part in piece]

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


class _Tiles(NamedTuple):
    """Members of tiles, those of tile i from `offset[i]` to `offset[i + 1]`, ascending, and their bits."""

    offset: NDArray[np.intp]
    member: NDArray[np.int32]
    bits: NDArray[np.uint8]


def _tiles(pairs: Pairs, n_tiles: int, n_items: int) -> _Tiles:
    """Unite the neighborhoods of the items of each tile."""
    tile, item = np.divmod(pairs.row.astype(np.int64), TILE)
    tile *= n_items
    tile += pairs.member
    tile <<= TILE
    tile |= np.left_shift(1, item)
    tile.sort()
    bits = tile.astype(np.uint8)
    tile >>= TILE
    is_first = np.ones(len(tile), bool)
    np.not_equal(tile[1:], tile[:-1], out=is_first[1:])
    first = np.flatnonzero(is_first)
    if len(first):
        bits = np.bitwise_or.reduceat(bits, first)
    tile, member = np.divmod(tile[first], max(n_items, 1))
    offset = np.concatenate(([0], np.cumsum(np.bincount(tile, minlength=n_tiles))))
    return _Tiles(offset, member.astype(np.int32), bits)


def _chunks(
    tiles: _Tiles, sizes: NDArray[np.intp], by_size: NDArray[np.intp], first_tile: int
) -> list[Chunk]:
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
