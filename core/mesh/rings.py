# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Ordered walks around vertices: from the corners of a vertex to its one-ring.

A walk steps from item to item by a table `following`, where -1 ends it. Items are corners where the faces
around a vertex agree in orientation, and *darts* where they do not: dart 2 c stands for the outgoing and dart
2 c + 1 for the incoming edge of corner c.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from .ragged import starts

LONGEST_WALK = 32
"""Longer walks are ranked by pointer doubling: a fan of a million faces takes 20 steps, not a million."""


class Walks(NamedTuple):
    """Walks from one start each, one behind the other.

    `items` (W,) int32 holds the visited items, those of walk i from `offset[i]` to `offset[i + 1]`;
    `is_open` (n,) is True where the walk came to an end instead of back to its start.
    """

    items: NDArray[np.int32]
    offset: NDArray[np.int64]
    is_open: NDArray[np.bool_]


def walk(
    following: NDArray[np.int32],
    starts: NDArray[np.int32],
    owner: NDArray[np.int32],
    neighbor: NDArray[np.int32],
    blocks: Blocks,
) -> Walks:
    """Follow a table from each start until the walk ends or comes back to its start.

    Parameters
    ----------
    following : ndarray, shape (I,), int32
        The next item of each item, or -1. No two items share a next item.
    starts : ndarray, shape (n,), int32
        First items, no two of one owner.
    owner, neighbor : ndarray, shape (I,), int32
        The vertex that an item walks around, and the vertex that it points to.

    Returns
    -------
    Walks
        Closed walks are turned so that they begin at the lowest-numbered neighbor.
    """
    parts = blocks.run(lambda a, b: _walk_block(following, starts[a:b], neighbor), len(starts))
    if not parts:
        return Walks(np.zeros(0, np.int32), np.zeros(1, np.int64), np.zeros(0, bool))
    items, lengths, is_open = (np.concatenate(part) for part in zip(*parts, strict=True))
    is_long = lengths < 0
    if is_long.any():
        long_items, long_lengths, is_open[is_long] = _rank_long_walks(
            following, starts[is_long], owner, neighbor
        )
        lengths[is_long] = long_lengths
        row_is_long = np.repeat(is_long, lengths)
        short_items, items = items, np.empty(lengths.sum(), np.int32)
        items[~row_is_long], items[row_is_long] = short_items, long_items
    return Walks(items, np.concatenate(([0], np.cumsum(lengths))), is_open)


def _walk_block(
    following: NDArray[np.int32], starts: NDArray[np.int32], neighbor: NDArray[np.int32]
) -> tuple[NDArray[np.int32], NDArray[np.int64], NDArray[np.bool_]]:
    """Return items, lengths and openness of a block; length -1 and no items where a walk is too long."""
    n = len(starts)
    lengths = np.zeros(n, np.int64)
    is_open = np.zeros(n, bool)
    active = np.arange(n)
    current = starts
    steps: list[tuple[NDArray[np.intp], NDArray[np.int32]]] = []
    while len(active) and len(steps) < LONGEST_WALK:
        steps.append((active, current))
        lengths[active] += 1
        current = following[current]
        ended = current < 0
        is_open[active[ended]] = True
        goes_on = ~ended & (current != starts[active])
        active, current = active[goes_on], current[goes_on]
    kept = lengths.copy()
    kept[active] = 0
    offset = np.concatenate(([0], np.cumsum(kept)))
    items = np.empty(offset[-1], np.int32)
    for step, (rows, values) in enumerate(steps):
        fits = kept[rows] > 0
        items[offset[rows[fits]] + step] = values[fits]
    lengths[active] = -1
    return _turn_to_lowest(items, kept, ~is_open, neighbor), lengths, is_open


def _turn_to_lowest(
    items: NDArray[np.int32],
    lengths: NDArray[np.int64],
    is_closed: NDArray[np.bool_],
    neighbor: NDArray[np.int32],
) -> NDArray[np.int32]:
    """Rotate each closed walk so that its lowest-numbered neighbor comes first."""
    filled = lengths > 0
    lengths, is_closed = lengths[filled], is_closed[filled]
    if not is_closed.any():
        return items
    begin = starts(lengths)
    target = neighbor[items]
    lowest = np.repeat(np.minimum.reduceat(target, begin), lengths)
    place = np.arange(len(items))
    hit = np.flatnonzero(target == lowest)[::-1]  # reversed: the first hit of a walk is written last
    turn = np.zeros(len(begin), np.int64)
    row = np.repeat(np.arange(len(begin)), lengths)
    turn[row[hit]] = hit - begin[row[hit]]
    turn[~is_closed] = 0
    place += turn[row]
    place -= np.where(place >= (begin + lengths)[row], lengths[row], 0)
    return items[place]


def _rank_long_walks(
    following: NDArray[np.int32],
    starts: NDArray[np.int32],
    owner: NDArray[np.int32],
    neighbor: NDArray[np.int32],
) -> tuple[NDArray[np.int32], NDArray[np.int64], NDArray[np.bool_]]:
    """Order the items of a few long walks by pointer doubling (list ranking)."""
    vertices = owner[starts]
    slot = np.full(owner.max() + 1, -1)
    slot[vertices] = np.arange(len(vertices))
    items = np.flatnonzero(slot[owner] >= 0).astype(np.int32)
    walk_of = slot[owner[items]]
    local = np.full(len(following), -1)
    local[items] = np.arange(len(items))
    step = np.where(following[items] >= 0, local[following[items]], -1)
    is_closed = np.zeros(len(starts), bool)
    first = local[starts]
    back = (step >= 0) & (step == first[walk_of])
    is_closed[walk_of[back]] = True
    step[back] = -1  # cut closed walks before their start
    end = np.where(step < 0, np.arange(len(items)), step)
    distance = (step >= 0).astype(np.int64)
    for _ in range(max(len(items) - 1, 1).bit_length()):
        distance += distance[end]
        end = end[end]
    belongs = end == end[first][walk_of]  # other fans at the same vertex end elsewhere
    items, walk_of, distance = items[belongs], walk_of[belongs], distance[belongs]
    order = np.lexsort((-distance, walk_of))
    lengths = np.bincount(walk_of, minlength=len(starts))
    return _turn_to_lowest(items[order], lengths, is_closed, neighbor), lengths, ~is_closed
