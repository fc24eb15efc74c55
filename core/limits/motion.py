# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The motion of a run within its limits: direction, weights, offset, largest displacement."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..mesh.geometry import vertex_normals
from ..mesh.welded_mesh import WeldedMesh
from .region import Region
from .seam import fade_shift_in, faded_in, rings_beside


class Motion:
    """Displacements of vertices as a function of the height of an offset along the normals.

    Parameters
    ----------
    found : ndarray, shape (3, n), float64
        Displacements that a method found, in the unit of the mesh; kept and changed.
    welded : WeldedMesh
        The mesh that it worked on.
    region : Region
        Largest displacement, direction, volume.
    movable : ndarray, shape (n,), bool, or None
        Vertices that may move at all; beside the others shifts fade in.
    weights : ndarray, shape (n,), or None
        Share of its motion that each vertex makes.
    pinned : ndarray, shape (p,), int
        Vertices that do not move.
    """

    def __init__(
        self,
        found: NDArray[np.float64],
        welded: WeldedMesh,
        region: Region,
        movable: NDArray[np.bool_] | None,
        weights: NDArray[np.floating] | None,
        pinned: NDArray[np.intp],
    ) -> None:
        surface = welded.topology
        self._found = found
        self._edge = welded.edge
        self._surface = surface
        self._limit = region.max_displacement
        self._weights, self._pinned = weights, pinned
        self._normals: NDArray[np.float64] | None = None
        self._direction: NDArray[np.float64] | None = None
        if movable is not None or region.along_normals:
            # Those of the denoised surface, which is as smooth as it will be.
            normals = self._normals_after(found)
        if movable is not None:
            fade_shift_in(found, normals, ~movable, pinned, surface.edges)
        if region.along_normals:
            found[:] = normals * np.einsum("cn,cn->n", normals, found)
            self._normals = normals
        if weights is not None:
            found *= weights

    def allow_offset(self, shares: NDArray[np.float64]) -> float:
        """Choose the directions of the offset: the normals after the displacements, beside pins fading in.

        Parameters
        ----------
        shares : ndarray, shape (n,)
            Share of its displacement that each vertex makes.

        Returns
        -------
        float
            Mean share that the vertices have in the offset.
        """
        normals = self._normals_after(self.at() * shares) if self._normals is None else self._normals
        stays = np.zeros(self._surface.n_vertices, bool)
        stays[self._pinned] = True
        share = faded_in(rings_beside(stays, self._surface.edges))
        if self._weights is not None:
            share *= self._weights
        self._direction = normals * (self._edge * share)
        return float(share.mean())

    def at(self, offset: float = 0.0) -> NDArray[np.float64]:
        """Return the displacements, shape (3, n), with an offset along the normals in mean edge lengths."""
        moved = self._found
        if offset and self._direction is not None:
            moved = moved + offset * self._direction
        if self._limit is None:
            return moved
        length, limit = self._lengths(moved), self._limit / self._edge
        return moved * np.divide(limit, length, out=np.ones_like(length), where=length > limit)

    def _normals_after(self, displacement: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the unit normals of vertices after a displacement, shape (3, n)."""
        # In edge lengths, so that squares of areas are within the range of numbers.
        points = (self._surface.vertices + displacement.T) / self._edge
        return np.ascontiguousarray(vertex_normals(self._surface.with_vertices(points)).T)

    def _lengths(self, vectors: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the lengths of vectors, shape (3, n), in mean edge lengths."""
        vectors = vectors / self._edge
        return np.sqrt(np.einsum("cn,cn->n", vectors, vectors))
