# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which vertices may move, and how."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..mesh.connectivity import Connectivity
from ..mesh.geometry import vertex_normals
from ..mesh.surface_mesh import SurfaceMesh
from ..settings import DenoiseSettings
from ..stencils.boundary import boundary_corners


@dataclass(frozen=True, eq=False)
class Constraints:
    """Vertices that do not move (`pinned`, shape (p,)) and those that move along a line only.

    `sliding`, shape (r,), are the latter; `slide_directions`, shape (3, r), holds their unit directions.
    """

    pinned: NDArray[np.intp]
    sliding: NDArray[np.intp]
    slide_directions: NDArray[np.floating]

    def apply(self, points: NDArray[np.floating], origin: NDArray[np.floating]) -> None:
        """Bring moved points, shape (3, N or more), back to where they may be, in place."""
        if len(self.sliding):
            start = origin[:, self.sliding]
            along = ((points[:, self.sliding] - start) * self.slide_directions).sum(axis=0)
            points[:, self.sliding] = start + self.slide_directions * along
        points[:, self.pinned] = origin[:, self.pinned]

    def with_pinned(self, vertices: NDArray[np.integer]) -> Constraints:
        """Return constraints that keep more vertices, shape (k,), where they are."""
        return replace(self, pinned=np.union1d(self.pinned, vertices))


@dataclass(frozen=True, eq=False)
class Corners:
    """Corners of open borders, `vertices` (r,), and the unit vertex normals there, `normals` (r, 3)."""

    vertices: NDArray[np.intp]
    normals: NDArray[np.float64]


def find_corners(surface: SurfaceMesh, connectivity: Connectivity, boundary: str) -> Corners:
    """Find the corners of borders that the boundary rule treats apart: with ALONG all, else none."""
    if boundary != "ALONG" or not connectivity.is_boundary.any():
        return Corners(np.zeros(0, np.intp), np.zeros((0, 3)))
    normals = vertex_normals(surface)
    corners = boundary_corners(surface.vertices, normals, connectivity)
    return Corners(corners, normals[corners])


def find_constraints(
    surface: SurfaceMesh,
    connectivity: Connectivity,
    settings: DenoiseSettings,
    movable: NDArray[np.bool_] | None,
    dtype: np.dtype,
    corners: Corners | None = None,
) -> Constraints:
    """Collect the constraints of a run.

    With the boundary FIXED, boundary vertices are pinned. With ALONG, the corners of a border may move along
    their normals only; they are pinned if shrinkage depends on the axes, as what it does to the corner of a
    tilted plane is not parallel to the plane. `movable`, shape (N,), are the vertices that may move at all,
    and `corners` what `find_corners` returns, if it is known already.
    """
    is_pinned = connectivity.is_loose.copy()
    if movable is not None:
        is_pinned |= ~movable
    if settings.boundary == "FIXED":
        is_pinned |= connectivity.is_boundary
    corners = corners or find_corners(surface, connectivity, settings.boundary)
    if settings.method == "POSITIONS" and settings.shrinkage != "VECTOR":
        is_pinned[corners.vertices] = True
    is_free = ~is_pinned[corners.vertices]
    slide_directions = corners.normals[is_free].T.astype(dtype)
    return Constraints(np.flatnonzero(is_pinned), corners.vertices[is_free], slide_directions)
