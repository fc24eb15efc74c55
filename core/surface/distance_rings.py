# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rings of vertices at a given number of steps, found for a block of center vertices at once."""

from __future__ import annotations

from collections.abc import Collection
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .connectivity import Connectivity
from .surface_mesh import SurfaceMesh

LARGEST_CLIQUE = 8
"""In larger faces only edge neighbors are adjacent; all pairs of a huge n-gon would fill the memory."""


class Adjacency(NamedTuple):
    """Neighbors of vertex k: `neighbor[offset[k]:offset[k + 1]]`."""

    offset: NDArray[np.int64]
    neighbor: NDArray[np.int32]


def edge_adjacency(connectivity: Connectivity) -> Adjacency:
    """Return adjacency along edges, the distance of triangle lattices."""
    return Adjacency(connectivity.ring_offset, connectivity.ring)


def face_adjacency(surface: SurfaceMesh, connectivity: Connectivity) -> Adjacency:
    """Return adjacency by a common face, the distance of quad lattices."""
    n = surface.n_vertices
    sizes = surface.face_sizes()
    source = np.repeat(np.arange(n), connectivity.valence)
    keys = [source * n + connectivity.ring]
    for size in range(4, LARGEST_CLIQUE + 1):
        corners = surface.corner_vertex[surface.face_offset[:-1][sizes == size, None] + np.arange(size)]
        for step in range(2, size - 1):
            keys.append((corners.astype(np.int64) * n + np.roll(corners, -step, axis=1)).ravel())
    unique = sorted_unique(np.concatenate(keys))
    owner, neighbor = np.divmod(unique, n)
    apart = owner != neighbor
    offset = np.concatenate(([0], np.cumsum(np.bincount(owner[apart], minlength=n))))
    return Adjacency(offset, neighbor[apart].astype(np.int32))


class Ring(NamedTuple):
    """Pairs of center (`row`, counted from the start of the block) and ring vertex, in ascending order."""

    row: NDArray[np.intp]
    vertex: NDArray[np.intp]


def distance_rings(
    adjacency: Adjacency, start: int, stop: int, distances: Collection[int]
) -> dict[int, Ring]:
    """Find the vertices at exact distances from each of a range of vertices, by breadth-first search.

    Parameters
    ----------
    adjacency : Adjacency
        Who is one step away.
    start, stop : int
        Range of center vertices.
    distances : collection of int
        Wanted distances, at least 1.

    Returns
    -------
    dict
        The `Ring` at each distance.
    """
    n = len(adjacency.offset) - 1
    inner = np.zeros(0, np.int64)
    keys = np.arange(stop - start) * n + np.arange(start, stop)
    rings = {}
    for distance in range(1, max(distances) + 1):
        row, vertex = np.divmod(keys, n)
        counts = adjacency.offset[vertex + 1] - adjacency.offset[vertex]
        begin = np.repeat(adjacency.offset[vertex] - (np.cumsum(counts) - counts), counts)
        reached = adjacency.neighbor[begin + np.arange(len(begin))] + np.repeat(row * n, counts)
        reached = sorted_unique(reached)
        fresh = ~_contains(keys, reached) & ~_contains(inner, reached)
        inner, keys = keys, reached[fresh]
        if distance in distances:
            rings[distance] = Ring(*np.divmod(keys, n))
    return rings


def sorted_unique(values: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the distinct values in ascending order; sorts in place, many times faster than hashing them."""
    values.sort()
    is_first = np.ones(len(values), bool)
    np.not_equal(values[1:], values[:-1], out=is_first[1:])
    return values[is_first]


def _contains(ascending: NDArray[np.int64], values: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Return which values stand in an ascending array."""
    if not len(ascending):
        return np.zeros(len(values), bool)
    place = np.minimum(np.searchsorted(ascending, values), len(ascending) - 1)
    return ascending[place] == values
