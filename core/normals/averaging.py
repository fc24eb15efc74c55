# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The second stage: averages of the noisy normals, guided by the pilot.

It follows the pilot as Wiener filtering follows thresholding of wavelet coefficients.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..surface.surface_mesh import SurfaceMesh
from .neighbors import Ragged, faces_around
from .pilot import Tick, unit_columns


class GuidedAverage:
    """Averages of normals over faces that share a vertex.

    Parameters
    ----------
    surface : SurfaceMesh
        The mesh, for its faces.
    at_vertex : Ragged
        Faces at each vertex.
    centroids : ndarray, shape (3, F)
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
        self._blocks = blocks
        self._n = surface.n_faces

        def kernel(start: int, stop: int) -> tuple[Ragged, NDArray[np.floating]]:
            around = faces_around(surface, at_vertex, start, stop)
            row = np.repeat(np.arange(start, stop), np.diff(around.offset))
            apart = centroids[:, around.items] - centroids[:, row]
            scale = centroids.dtype.type(-0.5 / max(spatial_sigma, 1e-30) ** 2)
            weights = np.exp((apart * apart).sum(axis=0) * scale)
            weights *= areas[around.items]
            return around, weights

        self._parts = blocks.run(kernel, self._n)

    def smooth(
        self,
        noisy: NDArray[np.floating],
        pilot: NDArray[np.floating],
        range_sigma: float,
        steps: int,
        tick: Tick = lambda: None,
    ) -> NDArray[np.floating]:
        """Average noisy normals (3, F) `steps` times with weights exp(-|pilot_f - pilot_g|^2 / 2 s^2)."""
        scale = pilot.dtype.type(-0.5 / range_sigma**2)

        def weigh(start: int, stop: int) -> NDArray[np.floating]:
            around, spatial = self._parts[start // self._blocks.block_size]
            row = np.repeat(np.arange(start, stop), np.diff(around.offset))
            apart = pilot[:, around.items] - pilot[:, row]
            weights = np.exp((apart * apart).sum(axis=0) * scale)
            weights *= spatial
            return weights

        weights = self._blocks.run(weigh, self._n)
        normals = noisy
        for _ in range(steps):
            following = np.empty_like(normals)

            def average(
                start: int,
                stop: int,
                normals: NDArray[np.floating] = normals,
                following: NDArray[np.floating] = following,
            ) -> None:
                index = start // self._blocks.block_size
                around = self._parts[index][0]
                gathered = normals[:, around.items]
                gathered *= weights[index]
                following[:, start:stop] = normals[:, start:stop]
                filled = np.flatnonzero(np.diff(around.offset))  # faces without corners touch nothing
                if len(filled):
                    sums = np.add.reduceat(gathered, around.offset[filled], axis=1)
                    following[:, start + filled] = unit_columns(sums, normals[:, start + filled])

            self._blocks.run(average, self._n)
            normals = following
            tick()
        return normals
