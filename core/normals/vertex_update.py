# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moving the vertices until the faces have the wanted normals."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..surface.surface_mesh import SurfaceMesh
from .neighbors import Ragged


def face_centroids(points: NDArray[np.floating], surface: SurfaceMesh) -> NDArray[np.floating]:
    """Return the mean of the corners of each face, shape (3, F), of points (3, N)."""
    sizes = surface.face_sizes()
    corners = points[:, surface.corner_vertex]
    if (sizes == 3).all():
        return (corners[:, 0::3] + corners[:, 1::3] + corners[:, 2::3]) / points.dtype.type(3)
    filled = sizes > 0
    centroids = np.zeros((3, surface.n_faces), points.dtype)
    centroids[:, filled] = np.add.reduceat(corners, surface.face_offset[:-1][filled], axis=1)
    return centroids / np.maximum(sizes, 1).astype(points.dtype)


def update_vertices(
    points: NDArray[np.floating],
    normals: NDArray[np.floating],
    surface: SurfaceMesh,
    at_vertex: Ragged,
    blocks: Blocks,
) -> NDArray[np.floating]:
    """Move each vertex by the mean over its faces of n <n, centroid - vertex>.

    Each face pulls its vertices towards the plane through its centroid with the wanted normal.

    Parameters
    ----------
    points : ndarray, shape (3, N)
        Positions; not modified.
    normals : ndarray, shape (3, F)
        Wanted unit normals.
    surface : SurfaceMesh
        The mesh, for its faces.
    at_vertex : Ragged
        Faces at each vertex.
    blocks : Blocks
        Threads to work on.

    Returns
    -------
    ndarray, shape (3, N)
        New positions; loose vertices stay.
    """
    centroids = face_centroids(points, surface)
    moved = points.copy()

    def kernel(start: int, stop: int) -> None:
        begin, end = at_vertex.offset[start], at_vertex.offset[stop]
        faces = at_vertex.items[begin:end]
        counts = np.diff(at_vertex.offset[start : stop + 1])
        filled = counts > 0
        if not filled.any():
            return
        normal = normals[:, faces]
        arm = centroids[:, faces]
        arm -= np.repeat(points[:, start:stop], counts, axis=1)
        normal *= (normal * arm).sum(axis=0)
        sums = np.add.reduceat(normal, (at_vertex.offset[start:stop] - begin)[filled], axis=1)
        moved[:, start + np.flatnonzero(filled)] += sums / counts[filled].astype(points.dtype)

    blocks.run(kernel, points.shape[1])
    return moved
