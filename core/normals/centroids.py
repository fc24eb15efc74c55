# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Centroids of faces, with coordinates in rows."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..surface.surface_mesh import SurfaceMesh


def face_centroids(
    points: NDArray[np.floating], surface: SurfaceMesh, blocks: Blocks | None = None
) -> NDArray[np.floating]:
    """Return the mean of the corners of each face, shape (3, F), of points (3, N)."""
    size = surface.common_face_size()
    if size == 3:
        means = np.empty((3, surface.n_faces), points.dtype)
        points = np.ascontiguousarray(points)  # `take` would copy all of it each time

        def kernel(start: int, stop: int) -> None:
            corner = points.take(surface.corner_vertex[size * start : size * stop], axis=1, mode="clip")
            part = np.add(corner[:, 0::3], corner[:, 1::3], out=means[:, start:stop])
            part += corner[:, 2::3]
            part /= points.dtype.type(3)

        (blocks or Blocks(1)).run(kernel, surface.n_faces)
        return means
    sizes = surface.face_sizes()
    corners = points[:, surface.corner_vertex]
    filled = sizes > 0
    centroids = np.zeros((3, surface.n_faces), points.dtype)
    centroids[:, filled] = np.add.reduceat(corners, surface.face_offset[:-1][filled], axis=1)
    return centroids / np.maximum(sizes, 1).astype(points.dtype)
