# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Fills the one-rings of a mesh: fans of a few faces by blocks of vertices, all others by general walks."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from .half_edges import HalfEdges, shifted
from .ragged import stretches
from .rings import LONGEST_WALK, Walks, walk
from .surface_mesh import SurfaceMesh


class Rings(NamedTuple):
    """The arrays to fill; see `Connectivity` for what they hold.

    `offset` (N + 1,) is `ring_offset`, `ring` (R,), `corner` (R,) is `ring_corner` and `rim` (N, 2) is
    `boundary_neighbors`.
    """

    offset: NDArray[np.int64]
    ring: NDArray[np.int32]
    corner: NDArray[np.int32]
    rim: NDArray[np.int32]


def fill_rings(
    rings: Rings,
    surface: SurfaceMesh,
    half_edges: HalfEdges,
    n_corners: NDArray[np.intp],
    first: NDArray[np.int32],
    non_manifold: NDArray[np.bool_],
    is_inconsistent: NDArray[np.bool_],
    labels: NDArray[np.int32] | None,
    blocks: Blocks,
) -> None:
    """Fill the rings of all vertices that have a single fan of faces.

    Parameters
    ----------
    rings : Rings
        Filled, also with -1 where there is nothing; `ring` is left as it is at vertices without a fan.
    surface : SurfaceMesh
        The mesh.
    half_edges : HalfEdges
        Its half-edges.
    n_corners : ndarray, shape (N,), intp
        Number of corners at each vertex.
    first : ndarray, shape (N,), int32
        A corner of each vertex, if it has one; changed.
    non_manifold : ndarray, shape (N,), bool
        Vertices that are known to have no single fan; those that are found to have none are added.
    is_inconsistent : ndarray, shape (N,), bool
        Vertices where neighboring faces disagree in orientation.
    labels : ndarray, shape (N,), int32, or None
        By which numbers a neighbor is the lowest-numbered one; None for their own.
    """
    corners = _make_corners(half_edges, first, labels, blocks)

    def kernel(start: int, stop: int) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        part = slice(start, stop)
        rings.corner[rings.offset[start] : rings.offset[stop]] = -1
        rings.rim[part] = -1
        sizes = np.where(non_manifold[part], 0, n_corners[part])
        inconsistent = np.flatnonzero(is_inconsistent[part] & (sizes > 0))
        sizes[inconsistent] = 0
        long = np.flatnonzero(sizes > LONGEST_WALK)
        sizes[long] = 0
        for size in np.flatnonzero(np.bincount(sizes)):
            if size:
                _fill_short(rings, corners, start + np.flatnonzero(sizes == size), int(size), non_manifold)
        return start + long, start + inconsistent

    found = blocks.run(kernel, surface.n_vertices)
    wanted = np.concatenate([np.zeros(0, np.intp), *(long for long, _ in found)])
    if len(wanted):
        walks = walk(corners.following, corners.first[wanted], corners.vertex, corners.keys(), blocks)
        source = corners.vertex[half_edges.previous_corner]
        _store(_Fans(walks, wanted, corners.target, source, 1), rings, n_corners, non_manifold)
    wanted = np.concatenate([np.zeros(0, np.intp), *(inconsistent for _, inconsistent in found)])
    if len(wanted):
        _store(_walk_darts(surface, half_edges, wanted, labels, blocks), rings, n_corners, non_manifold)


class _Corners(NamedTuple):
    """What is needed to walk around vertices whose faces agree in orientation, corner by corner."""

    following: NDArray[np.int32]
    """The corner in the next face counterclockwise; -1 at the end of an open fan."""
    first: NDArray[np.int32]
    """A corner of each vertex; of an open fan the first one."""
    vertex: NDArray[np.int32]
    target: NDArray[np.int32]
    half_edges: HalfEdges
    labels: NDArray[np.int32] | None

    def keys(self) -> NDArray[np.int32]:
        """Return for each corner the number by which the vertex that its edge leads to is compared."""
        return self.target if self.labels is None else self.labels[self.target]


def _make_corners(
    half_edges: HalfEdges, first: NDArray[np.int32], labels: NDArray[np.int32] | None, blocks: Blocks
) -> _Corners:
    surface, partner = half_edges.surface, half_edges.partner
    vertex = surface.corner_vertex
    # The partner of the incoming half-edge leaves the same vertex, in the next face counterclockwise.
    following = shifted(partner, surface, -1, blocks)
    rim = blocks.indices(lambda start, stop: partner[start:stop] < 0, len(partner)).astype(np.int32)
    first[vertex[rim]] = rim  # an open fan begins where no face lies on the other side of the outgoing edge
    return _Corners(following, first, vertex, half_edges.target, half_edges, labels)


def _fill_short(
    rings: Rings, corners: _Corners, vertices: NDArray[np.intp], size: int, non_manifold: NDArray[np.bool_]
) -> None:
    """Fill the rings of vertices that have `size` corners each, or mark them as non-manifold.

    In a fan the walk comes to its start or to an end after `size` steps and not before. No corner follows two
    others, so that a walk that is at its start then, but not for the first time, was there after a divisor.
    """
    items = np.empty((size + 1, len(vertices)), np.int32)
    np.take(corners.first, vertices, out=items[0], mode="clip")
    for step in range(size):
        # Behind an end this reads something that means nothing; such a walk is found out below.
        np.take(corners.following, items[step], out=items[step + 1], mode="clip")
    is_open = items[size] < 0
    is_fan = is_open | (items[size] == items[0])
    is_fan &= items[:size].min(axis=0) >= 0
    for divisor in range(1, size // 2 + 1):
        if size % divisor == 0:
            is_fan &= items[divisor] != items[0]
    is_fan &= rings.offset[vertices + 1] - rings.offset[vertices] == size + is_open
    items = items[:size]
    if not is_fan.all():
        non_manifold[vertices[~is_fan]] = True
        vertices, items, is_open = vertices[is_fan], items[:, is_fan], is_open[is_fan]
        if not len(vertices):
            return
    ends = corners.target.take(items)
    keys = ends if corners.labels is None else corners.labels.take(ends)
    turn = np.where(is_open, 0, _lowest_row(keys, rings.offset.size))
    # Twice the rows one below the other, so that a turned column is a column further down.
    place = turn * len(vertices) + np.arange(len(vertices))
    place = place + (np.arange(size) * len(vertices))[:, None]
    items, ends = (np.concatenate((rows, rows)).reshape(-1).take(place) for rows in (items, ends))
    begin = rings.offset[vertices]
    place = begin + np.arange(size)[:, None]
    rings.ring[place] = ends
    rings.corner[place] = items
    if is_open.any():
        begin, last = begin[is_open], items[-1, is_open]
        rim = corners.vertex[corners.half_edges.previous_corner[last]]
        rings.ring[begin + size] = rim
        rings.rim[vertices[is_open], 0] = rings.ring[begin]
        rings.rim[vertices[is_open], 1] = rim


def _lowest_row(keys: NDArray[np.int32], n: int) -> NDArray[np.integer]:
    """Return the row of the least value of each column, the first of equals; values are below n."""
    rows = 2 * LONGEST_WALK
    kind = np.int32 if n < 2**31 // rows else np.int64
    codes = np.multiply(keys, rows, dtype=kind)
    np.add(codes, np.arange(len(keys), dtype=kind)[:, None], out=codes)
    return codes.min(axis=0) % rows


class _Fans(NamedTuple):
    """Walks around vertices, and what the walked items mean."""

    walks: Walks
    vertices: NDArray[np.intp]
    pointed: NDArray[np.int32]
    """The vertex that an item points to."""
    beyond: NDArray[np.int32]
    """The vertex behind an item's face, which ends the ring after the last item of an open walk."""
    items_per_corner: int


def _walk_darts(
    surface: SurfaceMesh,
    half_edges: HalfEdges,
    vertices: NDArray[np.intp],
    labels: NDArray[np.int32] | None,
    blocks: Blocks,
) -> _Fans:
    """Walk around vertices where neighboring faces disagree in orientation, dart by dart (see `rings`)."""
    vertex = surface.corner_vertex
    n_darts = 2 * surface.n_corners
    half_edge = np.empty(n_darts, np.int32)
    half_edge[0::2] = np.arange(surface.n_corners)
    half_edge[1::2] = half_edges.previous_corner
    owner = np.repeat(vertex, 2)
    pointed = np.empty(n_darts, np.int32)
    pointed[0::2], pointed[1::2] = half_edges.target, vertex[half_edges.previous_corner]
    keys = pointed if labels is None else labels[pointed]
    partner = half_edges.partner[half_edge]
    leaves = vertex[partner] == owner  # the partner half-edge starts at this vertex, or ends at it
    across = np.where(leaves, 2 * partner, 2 * half_edges.next_corner[partner] + 1)
    across = np.where(partner >= 0, across, -1).astype(np.int32)
    turned = np.arange(n_darts) ^ 1
    following = across[turned]
    start = np.full(surface.n_vertices, -1, np.int32)
    start[owner] = np.arange(n_darts, dtype=np.int32)
    rim = np.flatnonzero(across < 0).astype(np.int32)
    rim = rim[np.argsort(-keys[rim], kind="stable")]  # the lower-numbered end is written last and wins
    start[owner[rim]] = rim
    walks = walk(following, start[vertices], owner, keys, blocks)
    return _Fans(walks, vertices, pointed, pointed[turned], 2)


def _store(fans: _Fans, rings: Rings, n_corners: NDArray[np.intp], non_manifold: NDArray[np.bool_]) -> None:
    """Copy the walks that are whole fans into the rings, and mark the other vertices as non-manifold."""
    walks, vertices = fans.walks, fans.vertices
    lengths = np.diff(walks.offset)
    is_fan = lengths == n_corners[vertices]
    is_fan &= lengths + walks.is_open == rings.offset[vertices + 1] - rings.offset[vertices]
    non_manifold[vertices[~is_fan]] = True
    place = stretches(rings.offset[vertices], lengths)
    good = np.repeat(is_fan, lengths)
    rings.ring[place[good]] = fans.pointed[walks.items[good]]
    rings.corner[place[good]] = walks.items[good] // fans.items_per_corner
    is_rim = is_fan & walks.is_open
    rim = vertices[is_rim]
    rings.ring[rings.offset[rim + 1] - 1] = fans.beyond[walks.items[walks.offset[1:][is_rim] - 1]]
    rings.rim[rim, 0] = rings.ring[rings.offset[rim]]
    rings.rim[rim, 1] = rings.ring[rings.offset[rim + 1] - 1]
