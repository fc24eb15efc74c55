# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbering for locality: vertices along a space-filling curve, and faces in the order of their vertices.

Where neighbors have far-off numbers, as after decimation or in scans, each look-up of a neighbor misses the
caches. Renumbering costs as much as a few passes over the mesh and is done for large, scattered meshes only.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from .ragged import stretches
from .surface_mesh import SurfaceMesh

SMALLEST = 2**16
"""Meshes with fewer vertices stay in the caches in any order."""

WINDOW = 192
"""Consecutive corners that are looked at together to tell whether a mesh is scattered."""

_WINDOWS = 256
_NEAR = 64  # vertices on one page of the look-up
_CURVE_BITS = 10  # for each coordinate; three of them fit into 32 bits


@dataclass(frozen=True, eq=False)
class Reordering:
    """A mesh with other numbers.

    Attributes
    ----------
    surface : SurfaceMesh
        The same mesh: vertices, faces and edges in another order, the corners of each face in the same or
        all the other way around.
    vertex_order : ndarray, shape (N,), int32
        Vertex k of `surface` is vertex `vertex_order[k]` of the original.
    face_order : ndarray, shape (F,), int32
        Face f of `surface` is face `face_order[f]` of the original.
    is_reversed : ndarray, shape (F,), bool, or None
        Faces of `surface` that walk around their corners the other way, so that neighbors agree; None for
        none.
    """

    surface: SurfaceMesh
    vertex_order: NDArray[np.int32]
    face_order: NDArray[np.int32]
    is_reversed: NDArray[np.bool_] | None = None

    def with_vertices(self, vertices: NDArray[np.floating]) -> Reordering:
        """Return the same numbers for a mesh with other positions, shape (N, 3), in the original order."""
        moved = self.surface.with_vertices(vertices.take(self.vertex_order, axis=0))
        return replace(self, surface=moved)

    def vertices_back(self, values: NDArray[Any]) -> NDArray[Any]:
        """Return one value for each vertex, shape (N, ...), in the original order."""
        result = np.empty_like(values)
        result[self.vertex_order] = values
        return result


def same_order(surface: SurfaceMesh) -> Reordering:
    """Return a mesh with the numbers that it has."""
    vertices, faces = (np.arange(n, dtype=np.int32) for n in (surface.n_vertices, surface.n_faces))
    return Reordering(surface, vertices, faces)


def is_scattered(surface: SurfaceMesh, smallest: int = SMALLEST) -> bool:
    """Tell whether renumbering a mesh pays: it is large, and neighbors have far-off numbers.

    Of windows of consecutive corners, spread over the mesh, it counts how many pages of vertices they touch.
    A few streams of vertices side by side, as subdivision leaves them, are not scattered. Meshes with fewer
    vertices than `smallest` stay in the caches in any order.
    """
    if surface.n_vertices < smallest or surface.n_corners < WINDOW:
        return False
    start = np.linspace(0, surface.n_corners - WINDOW, _WINDOWS).astype(np.int64)
    pages = np.sort(surface.corner_vertex[start[:, None] + np.arange(WINDOW)] // _NEAR, axis=1)
    n_touched = (np.diff(pages, axis=1) > 0).sum(axis=1) + 1
    return bool(np.median(n_touched) > WINDOW / 2)


def spatial_order(vertices: NDArray[np.floating]) -> NDArray[np.int32]:
    """Return the order of vertices along a Z-order curve through their bounding box.

    Parameters
    ----------
    vertices : ndarray, shape (N, 3)
        Finite positions.

    Returns
    -------
    ndarray, shape (N,), int32
        Numbers of the vertices in the order of the curve; those in one of its cells in ascending order.
    """
    if not len(vertices):
        return np.zeros(0, np.int32)
    coordinates = [np.ascontiguousarray(column) for column in vertices.T]
    low = [column.min() for column in coordinates]
    extent = max(float(column.max()) - float(least) for column, least in zip(coordinates, low, strict=True))
    scale = (2**_CURVE_BITS - 1) / extent if 0.0 < extent < np.inf else 0.0
    keys = np.zeros(len(vertices), np.uint32)
    for axis, (column, least) in enumerate(zip(coordinates, low, strict=True)):
        cells = ((column.astype(np.float64) - float(least)) * scale).astype(np.uint32)
        keys |= _spread(cells) << np.uint32(axis)
    return stable_order(keys, 2 ** (3 * _CURVE_BITS))


def stable_order(keys: NDArray[np.integer], limit: int) -> NDArray[np.int32]:
    """Return what `argsort(keys, kind="stable")` returns, for numbers from 0 to below `limit`, up to 2^32.

    Stable sorts of 16 bits count instead of comparing, so that two of them are faster than one of 32.
    """
    order = np.argsort(keys.astype(np.uint16), kind="stable").astype(np.int32)
    if limit > 2**16:
        high = (keys >> 16).astype(np.uint16)[order]
        order = order[np.argsort(high, kind="stable")]
    return order


def _spread(cells: NDArray[np.uint32]) -> NDArray[np.uint32]:
    """Return 10-bit numbers with two zero bits behind each bit."""
    for shift, mask in ((16, 0x030000FF), (8, 0x0300F00F), (4, 0x030C30C3), (2, 0x09249249)):
        cells = (cells | (cells << np.uint32(shift))) & np.uint32(mask)
    return cells


def reorder(
    surface: SurfaceMesh, vertex_order: NDArray[np.integer], blocks: Blocks | None = None
) -> Reordering:
    """Renumber the vertices of a mesh, and put its faces into the order of their first vertices.

    Parameters
    ----------
    surface : SurfaceMesh
        Any mesh; not modified.
    vertex_order : ndarray, shape (N,), int
        The vertices in their new order, each once; from `spatial_order`, say.
    """
    blocks = blocks or Blocks(1)
    n_vertices = surface.n_vertices
    old_number = np.asarray(vertex_order, np.int32)
    new_number = _inverse(old_number, blocks)
    corner_vertex = blocks.take(new_number, surface.corner_vertex)
    edges = blocks.take(new_number, surface.edges.reshape(-1)).reshape(-1, 2)

    sizes = surface.face_sizes()
    filled = np.minimum(surface.face_offset[:-1], max(surface.n_corners - 1, 0))
    firsts = (corner_vertex[filled] if surface.n_corners else sizes, edges[:, 0])
    orders = blocks.with_block_size(1).run(lambda one, _: _coarse_order(firsts[one], n_vertices), 2)
    face_order, edge_order = orders
    size = surface.common_face_size()
    offset = surface.face_offset  # if all faces have as many corners, they begin where they did
    if not size:
        offset = np.concatenate(([0], np.cumsum(sizes[face_order]))).astype(np.int32)
    new_edge = _inverse(edge_order, blocks)
    moved_vertex, moved_edge = np.empty_like(corner_vertex), np.empty_like(corner_vertex)

    def move(start: int, stop: int) -> None:
        faces = face_order[start:stop]
        if size:
            rows = [
                x.reshape(-1, size) for x in (corner_vertex, surface.corner_edge, moved_vertex, moved_edge)
            ]
            rows[0].take(faces, axis=0, out=rows[2][start:stop], mode="clip")
            new_edge.take(rows[1].take(faces, axis=0), out=rows[3][start:stop], mode="clip")
            return
        part = slice(offset[start], offset[stop])
        corner = stretches(surface.face_offset[faces], sizes[faces])
        corner_vertex.take(corner, out=moved_vertex[part], mode="clip")
        new_edge.take(surface.corner_edge[corner], out=moved_edge[part], mode="clip")

    blocks.run(move, surface.n_faces)
    renumbered = SurfaceMesh.trusted(
        vertices=surface.vertices.take(old_number, axis=0),
        corner_vertex=moved_vertex,
        corner_edge=moved_edge,
        face_offset=offset,
        edges=blocks.take(edges, edge_order),
    )
    return Reordering(renumbered, old_number, face_order)


def _inverse(order: NDArray[np.int32], blocks: Blocks) -> NDArray[np.int32]:
    """Return the new number of each item, from the items in their new order."""
    number = np.empty(len(order), np.int32)

    def write(start: int, stop: int) -> None:
        number[order[start:stop]] = np.arange(start, stop, dtype=np.int32)

    blocks.run(write, len(order))
    return number


def _coarse_order(vertices: NDArray[np.int32], n_vertices: int) -> NDArray[np.int32]:
    """Return the order of items by the upper 16 bits of a vertex number; among equals they keep theirs."""
    key = vertices >> max(0, int(n_vertices).bit_length() - 16)
    return np.argsort(key.astype(np.uint16), kind="stable").astype(np.int32)
