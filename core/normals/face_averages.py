# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Averages over faces that share a vertex, with weights that a guide cuts off at creases.

Fields on faces have shape (F, C) here: an average is a product of a row of weights with gathered rows.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..surface.surface_mesh import SurfaceMesh
from .neighbors import Ragged, faces_around

FACES_AT_ONCE = 4096
"""Faces in a block, so that the gathered rows of a group stay in the cache."""


class _Group(NamedTuple):
    """Faces with the same number of faces around them: rows (n,), members and weights (n, K)."""

    rows: NDArray[np.intp]
    members: NDArray[np.int32]
    spatial: NDArray[np.floating]


Weights = list[list[NDArray[np.floating]]]
"""Row-stochastic weights of each group of each block, shape (n, K)."""


class FaceAverages:
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
        self._blocks = blocks.sized(FACES_AT_ONCE)
        self._n = surface.n_faces
        scale = centroids.dtype.type(-0.5 / max(spatial_sigma, 1e-30) ** 2)

        def kernel(start: int, stop: int) -> list[_Group]:
            around = faces_around(surface, at_vertex, start, stop)
            counts = np.diff(around.offset)
            groups = []
            for count in np.unique(counts[counts > 0]):
                rows = np.flatnonzero(counts == count)
                members = around.items[around.offset[rows][:, None] + np.arange(count)]
                apart = centroids.take(members, axis=0)
                apart -= centroids[start + rows][:, None]
                spatial = np.exp(np.einsum("nkc,nkc->nk", apart, apart) * scale)
                spatial *= areas.take(members)
                groups.append(_Group(start + rows, members, spatial))
            return groups

        self._groups = self._blocks.run(kernel, self._n)

    def weights(self, guide: NDArray[np.floating], range_sigma: float) -> Weights:
        """Return weights area exp(-|c_f - c_g|^2 / 2 sigma_c^2) exp(-|guide_f - guide_g|^2 / 2 s^2).

        They are divided by their sum over the faces g around f. `guide` has shape (F, 3).
        """
        scale = guide.dtype.type(-0.5 / range_sigma**2)
        smallest = np.finfo(guide.dtype).tiny

        def kernel(start: int, _: int) -> list[NDArray[np.floating]]:
            found = []
            for rows, members, spatial in self._groups[start // self._blocks.block_size]:
                apart = guide.take(members, axis=0)
                apart -= guide[rows][:, None]
                weights = np.exp(np.einsum("nkc,nkc->nk", apart, apart) * scale)
                weights *= spatial
                total = weights.sum(axis=1, keepdims=True)
                # Around faces without area all weights are zero: the face itself stands in.
                np.divide(weights, total, out=weights, where=total > smallest)
                lost = np.flatnonzero(total[:, 0] <= smallest)
                weights[lost] = members[lost] == rows[lost, None]
                found.append(weights)
            return found

        return self._blocks.run(kernel, self._n)

    def average(self, weights: Weights, field: NDArray[np.floating]) -> NDArray[np.floating]:
        """Return the averages, shape (F, C), of a field (F, C); faces without corners keep their value."""
        result = field.copy()

        def kernel(start: int, _: int) -> None:
            index = start // self._blocks.block_size
            for (rows, members, _spatial), weight in zip(self._groups[index], weights[index], strict=True):
                result[rows] = np.matmul(weight[:, None], field.take(members, axis=0))[:, 0]

        self._blocks.run(kernel, self._n)
        return result
