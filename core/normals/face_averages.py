# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Averages over faces that share a vertex, with weights that a guide cuts off at creases."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..surface.surface_mesh import SurfaceMesh
from .averages import Averages, Group, Weights
from .neighbors import Ragged, faces_around


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
        scale = centroids.dtype.type(-0.5 / max(spatial_sigma, 1e-30) ** 2)

        def around(start: int, stop: int) -> Ragged:
            return faces_around(surface, at_vertex, start, stop)

        super().__init__(around, surface.n_faces, blocks)

        def weigh(group: Group) -> NDArray[np.floating]:
            apart = centroids.take(group.members, axis=0)
            apart -= centroids[group.rows][:, None]
            spatial = np.exp(np.einsum("nkc,nkc->nk", apart, apart) * scale)
            spatial *= areas.take(group.members)
            return spatial

        self._spatial = self.for_groups(weigh)

    def weights(self, guide: NDArray[np.floating], range_sigma: float) -> Weights:
        """Return weights area exp(-|c_f - c_g|^2 / 2 sigma_c^2) exp(-|guide_f - guide_g|^2 / 2 s^2).

        They are divided by their sum over the faces g around f. `guide` has shape (F, 3).
        """
        scale = guide.dtype.type(-0.5 / range_sigma**2)
        smallest = np.finfo(guide.dtype).tiny

        def weigh(group: Group, spatial: NDArray[np.floating]) -> NDArray[np.floating]:
            apart = guide.take(group.members, axis=0)
            apart -= guide[group.rows][:, None]
            weights = np.exp(np.einsum("nkc,nkc->nk", apart, apart) * scale)
            weights *= spatial
            total = weights.sum(axis=1, keepdims=True)
            # Around faces without area all weights are zero: the face itself stands in.
            np.divide(weights, total, out=weights, where=total > smallest)
            lost = np.flatnonzero(total[:, 0] <= smallest)
            weights[lost] = group.members[lost] == group.rows[lost, None]
            return weights

        return self.for_groups(weigh, self._spatial)
