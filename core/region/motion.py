# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The motion of a run within its limits: direction, weights, offset, largest displacement."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..surface.connectivity import Connectivity
from ..surface.geometry import vertex_normals
from ..surface.surface_mesh import SurfaceMesh
from .region import Region

TAPER_RINGS = 4
"""Rings over which the offset that keeps the volume fades out beside vertices that stay."""


class Motion:
    """Displacements of vertices as a function of the height of an offset along the normals.

    Parameters
    ----------
    found : ndarray, shape (3, n), float64
        Displacements that a method found, in the unit of the mesh; kept and changed.
    surface : SurfaceMesh
        The mesh that it worked on, before.
    connectivity : Connectivity
        Its neighborhoods.
    region : Region
        Largest displacement, direction, volume.
    weights : ndarray, shape (n,), or None
        Share of its motion that each vertex makes.
    pinned : ndarray, shape (p,), int
        Vertices that do not move.
    """

    def __init__(
        self,
        found: NDArray[np.float64],
        surface: SurfaceMesh,
        connectivity: Connectivity,
        region: Region,
        weights: NDArray[np.floating] | None,
        pinned: NDArray[np.intp],
    ) -> None:
        self._found = found
        self._limit = region.max_displacement
        self._direction: NDArray[np.float64] | None = None
        if region.along_normals or region.keep_volume:
            # Those of the denoised surface, which is as smooth as it will be.
            normals = vertex_normals(surface.with_vertices(surface.vertices + found.T))
            normals = np.ascontiguousarray(normals.T)
            if region.along_normals:
                found[:] = normals * np.einsum("cn,cn->n", normals, found)
        if weights is not None:
            found *= weights
        if region.keep_volume and connectivity.is_closed:
            stays = np.zeros(surface.n_vertices, bool)
            stays[pinned] = True
            share = tapered(stays, surface.edges)
            self._direction = normals * (share if weights is None else share * weights)

    @property
    def has_offset(self) -> bool:
        """Whether an offset can do something."""
        return self._direction is not None and bool(self._direction.any())

    @property
    def mean_share(self) -> float:
        """Mean share that the vertices have in the offset."""
        if self._direction is None:
            return 0.0
        return float(np.sqrt(np.einsum("cn,cn->n", self._direction, self._direction)).mean())

    def at(self, offset: float = 0.0) -> NDArray[np.float64]:
        """Return the displacements, shape (3, n), with an offset along the normals, in the mesh's unit."""
        moved = self._found
        if offset and self._direction is not None:
            moved = moved + offset * self._direction
        if self._limit is None:
            return moved
        length = np.sqrt(np.einsum("cn,cn->n", moved, moved))
        is_far = length > self._limit
        return moved * np.divide(self._limit, length, out=np.ones_like(length), where=is_far)


def tapered(stays: NDArray[np.bool_], edges: NDArray[np.integer]) -> NDArray[np.float64]:
    """Return a share for each vertex, shape (N,): 0 where it stays, 1 far from there, smooth between.

    Parameters
    ----------
    stays : ndarray, shape (N,), bool
        Vertices with share 0.
    edges : ndarray, shape (E, 2), int
        The edges along which rings are counted.
    """
    share = np.where(stays, 0.0, 1.0)
    if not stays.any():
        return share
    reached = stays.copy()
    for ring in range(1, TAPER_RINGS):
        one, other = reached[edges[:, 0]], reached[edges[:, 1]]
        fresh = np.concatenate((edges[one & ~other, 1], edges[other & ~one, 0]))
        reached[fresh] = True
        step = ring / TAPER_RINGS
        share[fresh] = step * step * (3.0 - 2.0 * step)
    return share
