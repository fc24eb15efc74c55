# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rings of vertices at a given number of steps, found for a block of center vertices at once."""

from __future__ import annotations

from collections.abc import Collection
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .connectivity import Connectivity
from .ragged import Ragged, starts, stretches
from .surface_mesh import SurfaceMesh

LARGEST_CLIQUE = 8
"""In larger faces only edge neighbors are adjacent; all pairs of a huge n-gon would fill the memory."""


CENTERS_AT_ONCE = 512
LARGEST_TABLE = 2**22
"""Centers that are searched from at once, and truth values for them; with more, fewer centers at once."""


def edge_adjacency(connectivity: Connectivity) -> Ragged:
    """Return the neighbors of each vertex along edges, the distance of triangle lattices."""
    return Ragged(connectivity.ring_offset, connectivity.ring)


def face_adjacency(
    surface: SurfaceMesh, connectivity: Connectivity, is_counted: NDArray[np.bool_] | None = None
) -> Ragged:
    """Return the neighbors of each vertex by a common face, the distance of quad lattices.

    With `is_counted`, a mask of faces, vertices at no such face have no neighbors, and at others only those
    faces count: that saves most of the time where few vertices matter.
    """
    n = surface.n_vertices
    sizes = surface.face_sizes()
    source, target = edge_adjacency(connectivity).row_of_item, connectivity.ring
    if is_counted is not None:
        is_near = np.zeros(n, bool)
        is_near[surface.corner_vertex[np.repeat(is_counted, sizes)]] = True
        is_kept = is_near[source]
        source, target = source[is_kept], target[is_kept]
    keys = [source * n + target]
    for size in range(4, LARGEST_CLIQUE + 1):
        is_wanted = sizes == size if is_counted is None else (sizes == size) & is_counted
        corners = surface.corner_vertex[surface.face_offset[:-1][is_wanted, None] + np.arange(size)]
        for step in range(2, size - 1):
            keys.append((corners.astype(np.int64) * n + np.roll(corners, -step, axis=1)).ravel())
    unique = sorted_unique(np.concatenate(keys))
    owner, neighbor = np.divmod(unique, max(n, 1))
    apart = owner != neighbor
    return Ragged.of_lengths(np.bincount(owner[apart], minlength=n), neighbor[apart].astype(np.int32))


class Ring(NamedTuple):
    """Pairs of center (`row`, its place among the centers) and ring vertex, in ascending order."""

    row: NDArray[np.intp]
    vertex: NDArray[np.intp]


def distance_rings(
    adjacency: Ragged,
    centers: NDArray[np.integer],
    distances: Collection[int],
    *,
    centers_at_once: int = CENTERS_AT_ONCE,
    largest_table: int = LARGEST_TABLE,
) -> dict[int, Ring]:
    """Find the vertices at exact distances from each of several vertices, by breadth-first search.

    Parameters
    ----------
    adjacency : Ragged
        Who is one step away.
    centers : ndarray, shape (n,), int
        Different vertices; it is fastest if those that follow each other are close together.
    distances : collection of int
        Wanted distances, at least 1.
    centers_at_once, largest_table : int, optional
        Centers that are searched from at once, and truth values for them.

    Returns
    -------
    dict
        The `Ring` at each distance.

    Notes
    -----
    A few centers at a time share one table of truth values, whose columns are the vertices around them: who
    was reached is a mark in it, so that nothing has to be sorted.
    """
    numbers = np.full(len(adjacency.offset) - 1, -1, np.int32)
    parts: list[dict[int, Ring]] = []
    starts = range(0, len(centers), centers_at_once)
    waiting = [(begin, min(begin + centers_at_once, len(centers))) for begin in starts]
    waiting.reverse()
    while waiting:
        begin, end = waiting.pop()
        around = _reachable(adjacency, centers[begin:end], max(distances), numbers)
        if (end - begin) * len(around) > largest_table and end - begin > 1:
            middle = (begin + end) // 2
            waiting += [(middle, end), (begin, middle)]
        else:
            parts.append(_search(adjacency, begin, centers[begin:end], distances, around, numbers))
        numbers[around] = -1
    none = {distance: Ring(np.zeros(0, np.intp), np.zeros(0, np.intp)) for distance in distances}
    return {
        distance: Ring(
            *(np.concatenate(rows) for rows in zip(*(part[distance] for part in parts), strict=True))
        )
        for distance in (distances if parts else ())
    } or none


def _reachable(
    adjacency: Ragged, centers: NDArray[np.integer], n_steps: int, numbers: NDArray[np.int32]
) -> NDArray[np.int32]:
    """Return the vertices at most `n_steps` from any of the centers, ascending; numbers them in `numbers`."""
    found = [centers]
    numbers[centers] = 0
    for _ in range(n_steps):
        reached = adjacency.taken(found[-1])[0]
        reached = reached[numbers[reached] < 0]
        own = np.arange(len(reached), dtype=np.int32)
        numbers[reached] = own  # of the same vertex the last one stays
        found.append(reached[numbers[reached] == own])
    around = np.sort(np.concatenate(found))
    numbers[around] = np.arange(len(around), dtype=np.int32)
    return around


def _search(
    adjacency: Ragged,
    first_row: int,
    centers: NDArray[np.integer],
    distances: Collection[int],
    around: NDArray[np.int32],
    numbers: NDArray[np.int32],
) -> dict[int, Ring]:
    """Return the rings of centers whose surroundings are `around`; rows are counted from `first_row`."""
    width = len(around) + 1  # the last column is for neighbors that do not matter
    neighbor, counts = adjacency.taken(around)
    neighbor = numbers[neighbor].astype(np.intp)
    neighbor[neighbor < 0] = width - 1  # beyond the last distance
    widest = int(counts.max(initial=0))
    table = None
    if len(around) * widest <= 4 * len(neighbor):
        table = np.full((len(around), widest), width - 1)
        place = stretches(np.zeros(len(around), np.intp), counts)
        table[np.repeat(np.arange(len(around)), counts), place] = neighbor
    row = np.arange(len(centers))
    local = numbers[centers].astype(np.intp)
    seen = np.zeros((len(centers), width), bool)
    seen[row, local] = True
    seen[:, -1] = True
    rings = {}
    for distance in range(1, max(distances) + 1):
        if table is not None:
            reached = table.take(local, axis=0)
            reached += (row * width)[:, None]
        else:  # a few vertices have very many neighbors
            sizes = counts[local]
            reached = neighbor[stretches(starts(counts)[local], sizes)]
            reached += np.repeat(row * width, sizes)
        fresh = np.zeros(seen.shape, bool)
        fresh.reshape(-1)[reached] = True
        np.greater(fresh, seen, out=fresh)
        seen |= fresh
        keys = np.flatnonzero(fresh)
        row = keys // width
        local = keys - row * width
        if distance in distances:
            rings[distance] = Ring(row + first_row, around[local].astype(np.intp))
    return rings


def sorted_unique(values: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the distinct values in ascending order; sorts in place, many times faster than hashing them."""
    values.sort()
    is_first = np.ones(len(values), bool)
    np.not_equal(values[1:], values[:-1], out=is_first[1:])
    return values[is_first]
