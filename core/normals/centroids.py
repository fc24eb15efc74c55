# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Centroids of faces, with coordinates in rows."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..surface.surface_mesh import SurfaceMesh


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
