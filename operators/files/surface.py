# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A part of a file as the mesh that is worked on."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ...core.mesh.ragged import starts
from .mesh_file import MeshFile, Part

if TYPE_CHECKING:
    from ...core import SurfaceMesh


def surface_of(file: MeshFile, part: Part) -> SurfaceMesh:
    """Return the mesh of a part, in the precision of the file.

    Parameters
    ----------
    file : MeshFile
        What was read.
    part : Part
        One of its parts.

    Returns
    -------
    SurfaceMesh
        Vertex k is vertex `part.vertices[k]` of the file. Corners that repeat the one before, faces that are
        left with less than three different vertices, name a vertex twice or come twice are left out: they say
        nothing about the surface. The file keeps them.

    Examples
    --------
    >>> from framelet.operators.files.obj import ObjFile
    >>> file = ObjFile(b"v 0 0 0\\nv 1 0 0\\nv 0 1 0\\nf 1 2 3\\nf 2 3 1\\nf 1 1 2\\n", "triangle")
    >>> surface = surface_of(file, file.parts()[0])
    >>> surface.n_faces, surface.edges.tolist()
    (1, [[0, 2], [0, 1], [1, 2]])
    """
    from ...core import SurfaceMesh

    n = len(part.vertices)
    is_whole = n == len(file.positions) and len(part.faces) == file.n_faces
    offset, corner, loose = file.face_offset, file.corner_vertex, file.loose_edges
    if not is_whole:
        number = np.full(len(file.positions), -1, np.int64)
        number[part.vertices] = np.arange(n)
        begin = offset[part.faces]
        sizes = offset[part.faces + 1] - begin
        offset = np.concatenate(([0], np.cumsum(sizes)))
        corner = number[corner[np.arange(offset[-1]) + np.repeat(begin - offset[:-1], sizes)]]
        loose = number[loose]
        loose = loose[(loose >= 0).all(axis=1)]
    vertices = file.positions[part.vertices] if not is_whole else file.positions
    corner, offset = _without_repeats(corner, offset)
    corner, offset = _without_doubles(corner, offset)
    corner_edge, edges = _number_edges(corner, offset, loose, n)
    return SurfaceMesh.trusted(
        np.ascontiguousarray(vertices, file.precision),
        corner.astype(np.int32),
        corner_edge.astype(np.int32),
        offset.astype(np.int32),
        edges.astype(np.int32),
    )


def _next_corner(offset: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the next corner of the face of each corner."""
    following = np.arange(1, int(offset[-1]) + 1)
    filled = np.diff(offset) > 0
    following[offset[1:][filled] - 1] = offset[:-1][filled]
    return following


def _without_repeats(
    corner: NDArray[np.int64], offset: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Leave out corners that repeat the one before, and faces that are no polygons then."""
    sizes = np.diff(offset)
    face = np.repeat(np.arange(len(sizes)), sizes)
    stays = corner != corner[_next_corner(offset)]
    left = np.bincount(face[stays], minlength=len(sizes)) if not stays.all() else sizes
    is_kept = left >= 3
    # A polygon that comes back to a vertex has fewer different ones than corners.
    for size in np.unique(left[left > 3]).tolist():
        faces = np.flatnonzero((left == size) & is_kept)
        begin = starts(left)
        rows = np.sort(corner[stays][begin[faces][:, None] + np.arange(size)], axis=1)
        is_kept[faces[(np.diff(rows, axis=1) == 0).any(axis=1)]] = False
    if stays.all() and is_kept.all():
        return corner, offset
    corner = corner[stays & is_kept[face]]
    return corner, np.concatenate(([0], np.cumsum(left[is_kept])))


def _without_doubles(
    corner: NDArray[np.int64], offset: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Leave out faces with the same vertices as one before."""
    sizes = np.diff(offset)
    is_kept = np.ones(len(sizes), bool)
    for size in np.unique(sizes).tolist():
        faces = np.flatnonzero(sizes == size)
        if len(faces) == len(sizes):
            rows = corner.reshape(-1, size)
        else:
            rows = corner[offset[faces][:, None] + np.arange(size)]
        # Faces that come twice have the same sums; few others have.
        key = np.zeros(len(rows), np.uint64)
        for column in rows.T:
            mixed = column.astype(np.uint64) * np.uint64(0x9E3779B97F4A7C15)
            mixed ^= mixed >> np.uint64(32)  # or sums of squares would be equal, and all sums of multiples
            mixed *= np.uint64(0xC2B2AE3D27D4EB4F)
            mixed ^= mixed >> np.uint64(29)
            key += mixed
        ascending = np.sort(key)  # several times faster than to sort places, and mostly enough
        if not (ascending[1:] == ascending[:-1]).any():
            continue
        order = np.argsort(key)
        is_same = key[order[1:]] == key[order[:-1]]
        near = np.zeros(len(key), bool)
        near[order[1:][is_same]] = near[order[:-1][is_same]] = True
        doubtful = np.flatnonzero(near)
        _, first = np.unique(np.sort(rows[doubtful], axis=1), axis=0, return_index=True)
        is_first = np.zeros(len(doubtful), bool)
        is_first[first] = True
        is_kept[faces[doubtful[~is_first]]] = False
    if is_kept.all():
        return corner, offset
    return corner[np.repeat(is_kept, sizes)], np.concatenate(([0], np.cumsum(sizes[is_kept])))


def _number_edges(
    corner: NDArray[np.int64], offset: NDArray[np.int64], loose: NDArray[np.int64], n_vertices: int
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the edge of each corner, and the edges.

    Edges are numbered as Blender numbers those of a small mesh, so that results have the same bits: by the
    first corner before which they lie.
    """
    from ...core.mesh.edge_list import find_edges

    following = _next_corner(offset)
    before = np.empty_like(following)
    before[following] = np.arange(len(following))
    loose = loose[loose[:, 0] != loose[:, 1]]
    edges, corner_edge = find_edges(corner, corner[following], loose, n_vertices)
    # Of all that is written to one place the last one stays: here the first.
    seen = corner_edge[before]
    first = np.full(len(edges), len(seen), np.int64)
    first[seen[::-1]] = np.arange(len(seen))[::-1]
    order = np.argsort(first, kind="stable")
    number = np.empty(len(edges), np.int64)
    number[order] = np.arange(len(edges))
    return number[corner_edge], edges[order].astype(np.int64)
