# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Averages over faces that share a vertex, with weights that a guide cuts off at creases."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..surface.locality import spatial_order
from ..surface.surface_mesh import SurfaceMesh
from .averages import Averages, Chunk, Weights
from .neighbors import Ragged, pairs_of_faces


class FaceAverages(Averages):
    """The faces around each face, itself included, and what does not change of their weights.

    Parameters
    ----------
    surface : SurfaceMesh
        The mesh, for its faces.
    at_vertex : Ragged
        Faces at each vertex.
    centroids : ndarray, shape (F, 3)
        Face centroids.
    areas : ndarray, shape (F,)
        Face areas.
    spatial_sigma : float
        Width of the spatial weights, in the unit of the centroids.
    blocks : Blocks
        Threads to work on.
    """

    def __init__(
        self,
        surface: SurfaceMesh,
        at_vertex: Ragged,
        centroids: NDArray[np.floating],
        areas: NDArray[np.floating],
        spatial_sigma: float,
        blocks: Blocks,
    ) -> None:
        super().__init__(
            lambda faces: pairs_of_faces(surface, at_vertex, faces), spatial_order(centroids), blocks
        )
        self._centroids = np.ascontiguousarray(self.inward(centroids).T)
        self._areas = self.inward(areas)
        self._spatial_sigma = max(spatial_sigma, 1e-30)

    def weights(self, guide: NDArray[np.floating], range_sigma: float) -> Weights:
        """Return weights area exp(-|c_f - c_g|^2 / 2 sigma_c^2) exp(-|guide_f - guide_g|^2 / 2 s^2).

        They are divided by their sum over the faces g around f. `guide` has shape (F, 3).
        """
        guides = np.ascontiguousarray(self.inward(guide).T)
        factors = [guide.dtype.type(-0.5 / sigma**2) for sigma in (self._spatial_sigma, range_sigma)]
        smallest = np.finfo(guide.dtype).tiny

        def weigh(chunk: Chunk) -> NDArray[np.floating]:
            distance = _squared_distances(self._centroids, chunk)
            distance *= factors[0]
            turn = _squared_distances(guides, chunk)
            turn *= factors[1]
            distance += turn
            weights = np.exp(distance, out=distance)
            weights *= self._areas.take(chunk.members)[:, None]
            mask = chunk.mask
            weights *= mask
            total = weights.sum(axis=2, keepdims=True)
            # Around faces without area all weights are zero: the face itself stands in.
            np.divide(weights, total, out=weights, where=total > smallest)
            lost = total[:, :, 0] <= smallest
            if lost.any():
                itself = (chunk.members[:, None] == chunk.rows[:, :, None]) & mask
                weights[lost] = itself[lost]
            return weights

        return self.for_chunks(weigh)


def _squared_distances(rows: NDArray[np.floating], chunk: Chunk) -> NDArray[np.floating]:
    """Return |r_i - r_j|^2, shape (n, TILE, U), of items i and members j, for vectors in columns (3, n)."""
    n_tiles = len(chunk.members)
    first = chunk.rows
    total = np.zeros((*first.shape, chunk.members.shape[1]), rows.dtype)
    for row in rows:
        own = row[first[0, 0] : first[0, 0] + first.size].reshape(n_tiles, -1, 1) if n_tiles else row[first]
        apart = own - row.take(chunk.members)[:, None]
        apart *= apart
        total += apart
    return total
