# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Corners of some faces, faces at some vertices."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .connectivity import Connectivity
from .ragged import Ragged, stretches
from .surface_mesh import SurfaceMesh


def corners_of(surface: SurfaceMesh, faces: NDArray[np.integer]) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return how many corners each of some faces has, shape (n,), and the corners, face by face."""
    first = surface.face_offset[:-1][faces].astype(np.intp)
    counts = surface.face_offset[1:][faces].astype(np.intp) - first
    return counts, stretches(first, counts)


def face_of(surface: SurfaceMesh, corner: NDArray[np.intp]) -> NDArray[np.intp]:
    """Return the face of each of some corners, shape (n,)."""
    size = surface.common_face_size()
    if size:
        return corner // size
    return np.searchsorted(surface.face_offset, corner, side="right") - 1


def faces_at(surface: SurfaceMesh, is_wanted: NDArray[np.bool_]) -> NDArray[np.intp]:
    """Return the faces that have one of the wanted vertices, a mask of shape (N,), ascending."""
    corner = np.flatnonzero(is_wanted[surface.corner_vertex])
    face = face_of(surface, corner)
    return face[np.diff(face, prepend=-1) > 0]


def faces_of_vertices(surface: SurfaceMesh, connectivity: Connectivity | None = None) -> Ragged:
    """Return the faces at each vertex; a face that names a vertex twice counts twice.

    They are ascending; on manifold meshes with `connectivity`, which is many times faster, in ring order.
    """
    if connectivity is not None and not connectivity.is_non_manifold.any():
        corners = Ragged(connectivity.ring_offset, connectivity.ring_corner)
        is_there = corners.items >= 0
        if not is_there.all():
            corners = corners.kept(is_there)
        size = surface.common_face_size()
        if size:
            return Ragged(corners.offset, corners.items // np.int32(size))
        own = surface.face_of_corner()
        return Ragged(corners.offset, own[corners.items])
    order = np.argsort(surface.corner_vertex, kind="stable")
    own = surface.face_of_corner()
    counts = np.bincount(surface.corner_vertex, minlength=surface.n_vertices)
    return Ragged.of_lengths(counts, own[order])


def corners_around(
    surface: SurfaceMesh, connectivity: Connectivity, vertices: NDArray[np.intp]
) -> NDArray[np.intp]:
    """Return the corners at some vertices, ascending; no vertex is given twice."""
    if connectivity.is_non_manifold[vertices].any():
        is_wanted = np.zeros(surface.n_vertices, bool)
        is_wanted[vertices] = True
        return np.flatnonzero(is_wanted[surface.corner_vertex])
    corner, _ = Ragged(connectivity.ring_offset, connectivity.ring_corner).taken(vertices)
    return np.sort(corner[corner >= 0]).astype(np.intp)


def some_faces(surface: SurfaceMesh, faces: NDArray[np.integer]) -> SurfaceMesh:
    """Return a mesh of some faces with the numbers and positions of all vertices, without edges."""
    counts, corner = corners_of(surface, faces)
    vertex = surface.corner_vertex[corner]
    offset = np.concatenate(([0], np.cumsum(counts))).astype(np.int32)
    return SurfaceMesh.trusted(surface.vertices, vertex, vertex, offset, np.zeros((0, 2), np.int32))
