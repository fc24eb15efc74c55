# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Averages over faces that share a vertex, with weights that a guide cuts off at creases."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..surface.locality import spatial_order
from ..surface.surface_mesh import SurfaceMesh
from ..transform.adaptive_level import Neighbors
from .averages import TILE, Averages, Chunk, Members, Weights, united
from .centroids import face_centroids
from .neighbors import Ragged, members_around
from .pilot import Tick, neighbor_distances, unit_columns

_SAMPLE = 512
"""Tiles that are looked at to choose an order."""


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
        def around(faces: NDArray[np.int32]) -> Members:
            return members_around(surface, at_vertex, faces)

        super().__init__(around, _compact_order(centroids, around), blocks)
        self._centroids = self.inward_columns(centroids.T)
        self._areas = self.inward(areas)
        self._spatial_sigma = max(spatial_sigma, 1e-30)

    def weights(self, guide: NDArray[np.floating], range_sigma: float) -> Weights:
        """Return weights area exp(-|c_f - c_g|^2 / 2 sigma_c^2) exp(-|guide_f - guide_g|^2 / 2 s^2).

        They are divided by their sum over the faces g around f. `guide` has shape (3, F).
        """
        guides = self.inward_columns(guide)
        factors = [guide.dtype.type(-0.5 / sigma**2) for sigma in (self._spatial_sigma, range_sigma)]
        smallest = np.finfo(guide.dtype).tiny

        def weigh(chunk: Chunk, weights: NDArray[np.floating]) -> None:
            _squared_distances(self._centroids, chunk, weights)
            weights *= factors[0]
            turn = np.empty_like(weights)
            _squared_distances(guides, chunk, turn)
            turn *= factors[1]
            weights += turn
            np.exp(weights, out=weights)
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

        return self.for_chunks(weigh, guide.dtype)

    def smooth(
        self, noisy: NDArray[np.floating], weights: Weights, steps: int, tick: Tick = lambda: None
    ) -> NDArray[np.floating]:
        """Average unit normals, shape (3, F), so many times, and return unit normals.

        A face whose average has no direction keeps its normal.
        """
        normals = self.inward_rows(list(noisy))
        for _ in range(steps):
            following = self.average(weights, normals)

            def shorten(
                start: int,
                stop: int,
                normals: NDArray[np.floating] = normals,
                following: NDArray[np.floating] = following,
            ) -> None:
                part = following[start:stop]
                part[...] = unit_columns(part.T, normals[start:stop].T).T

            self.for_items(shorten)
            normals = following
            tick()
        return np.ascontiguousarray(self.outward(normals).T)


def face_averages(
    points: NDArray[np.floating],
    surface: SurfaceMesh,
    at_vertex: Ragged,
    neighbors: Neighbors,
    areas: NDArray[np.floating],
    blocks: Blocks,
) -> FaceAverages:
    """Return averages for faces at positions (3, N): spatial weights are as wide as neighbors are apart."""
    centroids = face_centroids(points, surface, blocks)
    distance = neighbor_distances(centroids, neighbors, blocks)
    distance = distance[distance > 0]
    spatial_sigma = float(distance.mean()) if len(distance) else 1.0
    return FaceAverages(surface, at_vertex, np.ascontiguousarray(centroids.T), areas, spatial_sigma, blocks)


def _compact_order(
    centroids: NDArray[np.floating], around: Callable[[NDArray[np.int32]], Members]
) -> NDArray[np.int32]:
    """Return the order of the faces whose tiles have fewer members: as they are, or along a curve."""
    n_faces = len(centroids)
    orders = [np.arange(n_faces, dtype=np.int32), spatial_order(centroids)]
    n_tiles = n_faces // TILE
    tiles = np.linspace(0, max(n_tiles - 1, 0), min(n_tiles, _SAMPLE)).astype(np.intp)
    places = TILE * tiles[:, None] + np.arange(TILE)
    sizes = [len(united(around(order[places]), len(tiles), n_faces).member) for order in orders]
    return orders[int(np.argmin(sizes))]


def _squared_distances(rows: NDArray[np.floating], chunk: Chunk, out: NDArray[np.floating]) -> None:
    """Set |r_i - r_j|^2, shape (n, TILE, U), of items i and members j, for vectors in columns (3, n)."""
    items = slice(TILE * chunk.begin, TILE * (chunk.begin + len(chunk.members)))
    apart = np.empty_like(out)
    for number, row in enumerate(rows):
        np.subtract(row[items].reshape(-1, TILE, 1), row.take(chunk.members)[:, None], out=apart)
        if number:
            apart *= apart
            out += apart
        else:
            np.multiply(apart, apart, out=out)
