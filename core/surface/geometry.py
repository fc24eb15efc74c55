# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Lengths, normals, areas and volume of a polygon mesh."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .surface_mesh import SurfaceMesh


def mean_edge_length(surface: SurfaceMesh) -> float:
    """Return the mean edge length over all face-edge incidences, in scene units; 0.0 without faces.

    An edge between two faces counts twice, so that on a closed mesh this is the mean over its edges.
    """
    if not surface.n_corners:
        return 0.0
    start = surface.vertices[surface.corner_vertex]
    stop = start[surface.next_corner()]
    return float(np.linalg.norm(stop.astype(np.float64) - start, axis=1).mean())


def face_area_vectors(surface: SurfaceMesh) -> NDArray[np.float64]:
    """Return the vector area of each face, shape (F, 3), float64: its normal times its area.

    By Newell's formula, which serves planar and non-planar polygons alike: half the cross product of two
    edges for a triangle and half that of the diagonals for a quad.
    """
    if not surface.n_faces:
        return np.zeros((0, 3))
    start = surface.vertices[surface.corner_vertex].astype(np.float64)
    sizes = surface.face_sizes()
    filled = sizes > 0
    # Relative to the face's first corner, so that a mesh far from the origin loses no digits.
    start -= np.repeat(start[surface.face_offset[:-1][filled]], sizes[filled], axis=0)
    cross = np.cross(start, start[surface.next_corner()])
    vectors = np.zeros((surface.n_faces, 3))
    vectors[filled] = 0.5 * np.add.reduceat(cross, surface.face_offset[:-1][filled], axis=0)
    return vectors


def face_centroids(surface: SurfaceMesh) -> NDArray[np.float64]:
    """Return the mean of the corners of each face, shape (F, 3), float64."""
    centroids = np.zeros((surface.n_faces, 3))
    sizes = surface.face_sizes()
    filled = sizes > 0
    if filled.any():
        corners = surface.vertices[surface.corner_vertex].astype(np.float64)
        centroids[filled] = np.add.reduceat(corners, surface.face_offset[:-1][filled], axis=0)
        centroids[filled] /= sizes[filled, None]
    return centroids


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


def signed_volume(surface: SurfaceMesh) -> float:
    """Return the enclosed volume, in cubed scene units, of a closed and consistently oriented mesh."""
    if not surface.n_faces:
        return 0.0
    shifted = surface.with_vertices(
        surface.vertices.astype(np.float64) - surface.vertices.mean(0, np.float64)
    )
    return float(np.einsum("fi,fi->", face_centroids(shifted), face_area_vectors(shifted)) / 3.0)
