# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Lengths, normals, areas and volume of a polygon mesh."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .surface_mesh import SurfaceMesh

_CORNERS_AT_ONCE = 2**16
"""Blocks of corners whose temporaries stay in the cache."""


def mean_edge_length(surface: SurfaceMesh) -> float:
    """Return the mean edge length over all face-edge incidences, in scene units; 0.0 without faces.

    An edge between two faces counts twice, so that on a closed mesh this is the mean over its edges.
    """
    if not surface.n_corners:
        return 0.0
    vertex = surface.corner_vertex
    following = vertex[surface.next_corner()]
    total = 0.0
    for start in range(0, len(vertex), _CORNERS_AT_ONCE):
        part = slice(start, start + _CORNERS_AT_ONCE)
        edge = surface.vertices[following[part]] - surface.vertices[vertex[part]].astype(np.float64)
        total += float(np.sqrt(np.einsum("ci,ci->c", edge, edge)).sum())
    return total / len(vertex)


def face_area_vectors(surface: SurfaceMesh) -> NDArray[np.float64]:
    """Return the vector area of each face, shape (F, 3), float64: its normal times its area.

    By Newell's formula, which serves planar and non-planar polygons alike: half the cross product of two
    edges for a triangle and half that of the diagonals for a quad.
    """
    vectors = np.zeros((surface.n_faces, 3))
    sizes = surface.face_sizes()
    for size in (3, 4):
        faces = np.flatnonzero(sizes == size)
        first = surface.face_offset[:-1][faces]
        corners = [surface.vertices[surface.corner_vertex[first + step]] for step in range(size)]
        origin = corners[0].astype(np.float64)
        if size == 3:
            vectors[faces] = _half_cross(corners[1] - origin, corners[2] - origin)
        else:
            vectors[faces] = _half_cross(corners[2] - origin, corners[3].astype(np.float64) - corners[1])
    faces = np.flatnonzero(sizes > 4)
    if len(faces):
        vectors[faces] = _newell_areas(surface, faces)
    return vectors


def _half_cross(first: NDArray[np.float64], second: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return half the cross products of vectors, shape (n, 3)."""
    (a, b, c), (x, y, z) = first.T, second.T
    return 0.5 * np.stack((b * z - c * y, c * x - a * z, a * y - b * x), axis=1)


def _newell_areas(surface: SurfaceMesh, faces: NDArray[np.intp]) -> NDArray[np.float64]:
    """Return the vector areas of polygons of any size, shape (n, 3)."""
    counts = surface.face_sizes()[faces]
    begin = np.cumsum(counts) - counts
    corner = np.arange(counts.sum()) + np.repeat(surface.face_offset[:-1][faces] - begin, counts)
    following = np.arange(1, len(corner) + 1)
    following[begin + counts - 1] = begin
    points = surface.vertices[surface.corner_vertex[corner]].astype(np.float64)
    # Relative to the face's first corner, so that a mesh far from the origin loses no digits.
    points -= np.repeat(points[begin], counts, axis=0)
    return np.add.reduceat(_half_cross(points, points[following]), begin, axis=0)


def unit_vectors(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return vectors scaled to length one along the last axis; zero vectors stay zero."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.divide(vectors, length, out=np.zeros_like(vectors), where=length > 0)


def face_normals(surface: SurfaceMesh) -> NDArray[np.float64]:
    """Return unit face normals, shape (F, 3), float64; zero for faces without area."""
    return unit_vectors(face_area_vectors(surface))


def vertex_normals(surface: SurfaceMesh) -> NDArray[np.float64]:
    """Return unit vertex normals, shape (N, 3), float64: area-weighted means of the faces around a vertex.

    Zero at loose vertices and where the faces cancel out.
    """
    per_corner = np.repeat(face_area_vectors(surface), surface.face_sizes(), axis=0)
    sums = [
        np.bincount(surface.corner_vertex, per_corner[:, axis], minlength=surface.n_vertices)
        for axis in range(3)
    ]
    return unit_vectors(np.stack(sums, axis=1).astype(np.float64, copy=False))


def signed_volume(surface: SurfaceMesh, area_vectors: NDArray[np.float64] | None = None) -> float:
    """Return the enclosed volume, in cubed scene units, of a closed and consistently oriented mesh.

    Faces with more than three corners count as fans around the mean of their corners. `area_vectors` are
    those of `face_area_vectors`, if they are known already.
    """
    if not surface.n_faces:
        return 0.0
    vectors = face_area_vectors(surface) if area_vectors is None else area_vectors
    sizes = surface.face_sizes()
    filled = np.flatnonzero(sizes > 0)
    # For a triangle every point of its plane does as well as the mean; the first corner costs least.
    tip = surface.vertices[surface.corner_vertex[surface.face_offset[:-1][filled]]].astype(np.float64)
    for size in np.unique(sizes[sizes > 3]):
        faces = sizes[filled] == size
        corner = surface.face_offset[:-1][filled[faces], None] + np.arange(size)
        tip[faces] = surface.vertices[surface.corner_vertex[corner]].mean(axis=1, dtype=np.float64)
    tip -= tip.mean(axis=0)  # near the origin, so that a mesh far away loses no digits
    return float(np.einsum("fi,fi->", tip, vectors[filled]) / 3.0)
