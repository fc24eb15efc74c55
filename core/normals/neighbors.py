# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces around faces and faces around vertices."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..surface.connectivity import Connectivity
from ..surface.surface_mesh import SurfaceMesh
from ..transform.adaptive_level import Neighbors
from .averages import BITS, TILE, Members, united


class Ragged(NamedTuple):
    """Rows of different lengths: row i is `items[offset[i]:offset[i + 1]]`."""

    offset: NDArray[np.int64]
    items: NDArray[np.int32]


def edge_neighbors(surface: SurfaceMesh, connectivity: Connectivity) -> Neighbors:
    """Return the faces across the edges of each face; without exactly one, the face itself stands in."""
    sizes = surface.face_sizes()
    own = np.repeat(np.arange(surface.n_faces, dtype=np.int32), sizes)
    across = np.where(connectivity.face_across >= 0, connectivity.face_across, own)
    nothing = np.zeros(surface.n_faces, bool)
    return Neighbors(surface.face_offset, across, nothing, nothing)


def faces_of_vertices(surface: SurfaceMesh, connectivity: Connectivity | None = None) -> Ragged:
    """Return the faces at each vertex; a face that names a vertex twice counts twice.

    They are ascending; on manifold meshes with `connectivity`, which is many times faster, in ring order.
    """
    if connectivity is not None and not connectivity.is_non_manifold.any():
        corner, offset = connectivity.ring_corner, connectivity.ring_offset
        is_there = corner >= 0
        if not is_there.all():
            offset = np.concatenate(([0], np.cumsum(is_there)))[offset]
            corner = corner[is_there]
        size = surface.common_face_size()
        if size:
            return Ragged(offset, corner // np.int32(size))
        own = np.repeat(np.arange(surface.n_faces, dtype=np.int32), surface.face_sizes())
        return Ragged(offset, own[corner])
    order = np.argsort(surface.corner_vertex, kind="stable")
    own = np.repeat(np.arange(surface.n_faces, dtype=np.int32), surface.face_sizes())
    counts = np.bincount(surface.corner_vertex, minlength=surface.n_vertices)
    return Ragged(np.concatenate(([0], np.cumsum(counts))), own[order])


MOST_FACES = 64
"""Faces at a vertex beyond which they do not count as neighbors by way of that vertex: the number of pairs
would grow with the square. In a fan they are neighbors by way of its rim, edge by edge."""


def members_around(surface: SurfaceMesh, at_vertex: Ragged, faces: NDArray[np.integer]) -> Members:
    """Return the faces that share a vertex with the faces of tiles, shape (n, TILE), themselves included.

    Faces without a corner share none.
    """
    n_tiles = len(faces)
    flat = faces.ravel()
    begin = surface.face_offset[flat]
    sizes = surface.face_offset[flat + 1] - begin
    place = np.repeat(np.arange(flat.size), sizes)
    corner = np.arange(len(place)) + np.repeat(begin - (np.cumsum(sizes) - sizes), sizes)
    tile, item = np.divmod(place, TILE)
    vertices = united(Members(tile, surface.corner_vertex[corner], BITS[item]), n_tiles, surface.n_vertices)
    counts = at_vertex.offset[vertices.member + 1] - at_vertex.offset[vertices.member]
    counts[counts > MOST_FACES] = 0
    first = at_vertex.offset[vertices.member] - (np.cumsum(counts) - counts)
    around = at_vertex.items[np.arange(counts.sum()) + np.repeat(first, counts)]
    tile = np.repeat(np.repeat(np.arange(n_tiles), np.diff(vertices.offset)), counts)
    filled = np.flatnonzero(sizes)
    return Members(
        np.concatenate((tile, filled // TILE)),
        np.concatenate((around, flat[filled])),
        np.concatenate((np.repeat(vertices.bits, counts), BITS[filled % TILE])),
    )
