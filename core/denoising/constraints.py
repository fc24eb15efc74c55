# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which vertices may move, and how."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..settings import DenoiseSettings
from ..stencils.boundary import boundary_corners
from ..surface.connectivity import Connectivity
from ..surface.geometry import vertex_normals
from ..surface.surface_mesh import SurfaceMesh


@dataclass(frozen=True, eq=False)
class Constraints:
    """Vertices that do not move (`pinned`, shape (p,)) and those that move along a line only.

    `railed`, shape (r,), are the latter; `rail`, shape (3, r), holds their unit directions.
    """

    pinned: NDArray[np.intp]
    railed: NDArray[np.intp]
    rail: NDArray[np.floating]

    def apply(self, points: NDArray[np.floating], origin: NDArray[np.floating]) -> None:
        """Bring moved points, shape (3, N or more), back to where they may be, in place."""
        if len(self.railed):
            start = origin[:, self.railed]
            along = ((points[:, self.railed] - start) * self.rail).sum(axis=0)
            points[:, self.railed] = start + self.rail * along
        points[:, self.pinned] = origin[:, self.pinned]


def find_constraints(
    surface: SurfaceMesh,
    connectivity: Connectivity,
    settings: DenoiseSettings,
    movable: NDArray[np.bool_] | None,
    dtype: np.dtype,
) -> Constraints:
    """Collect the constraints of a run.

    Parameters
    ----------
    surface : SurfaceMesh
        The noisy surface.
    connectivity : Connectivity
        Its neighborhoods.
    settings : DenoiseSettings
        With the boundary FIXED, boundary vertices are pinned. With ALONG, the corners of a border may move
        along their normals only; they are pinned if shrinkage depends on the axes, as what it does to the
        corner of a tilted plane is not parallel to the plane.
    movable : ndarray, shape (N,), bool, or None
        Vertices that may move at all; None for all.
    dtype : dtype
        Precision of the rails.

    Returns
    -------
    Constraints
    """
    is_pinned = connectivity.is_loose.copy()
    if movable is not None:
        is_pinned |= ~movable
    if settings.boundary == "FIXED":
        is_pinned |= connectivity.is_boundary
    railed = np.zeros(0, np.intp)
    rail = np.zeros((3, 0), dtype)
    if settings.boundary == "ALONG" and connectivity.is_boundary.any():
        normals = vertex_normals(surface)
        railed = boundary_corners(surface.vertices, normals, connectivity)
        if settings.method == "POSITIONS" and settings.shrinkage != "VECTOR":
            is_pinned[railed] = True
        railed = railed[~is_pinned[railed]]
        rail = normals[railed].T.astype(dtype)
    return Constraints(np.flatnonzero(is_pinned), railed, rail)
