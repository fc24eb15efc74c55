# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A steep low-pass of positions: the way for coarse meshes of smooth shapes.

Where edges are long in comparison with the radius of curvature, normals of neighboring faces differ as much
by shape as by noise, and positions, which are one number less differentiated, say more.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..normals.averages import Averages, Group, Weights
from ..normals.neighbors import Ragged
from ..surface.connectivity import Connectivity

ORDER = 5
"""How often what an average took away is averaged and added again: larger cuts off more steeply."""


class RingAverages(Averages):
    """Averages over the one-ring of each vertex, itself included; on a border, over the border only."""

    def __init__(self, connectivity: Connectivity, blocks: Blocks) -> None:
        offset, ring = connectivity.ring_offset, connectivity.ring
        is_rim = connectivity.boundary_neighbors[:, 0] >= 0

        def around(start: int, stop: int) -> Ragged:
            counts = np.where(is_rim[start:stop], 2, np.diff(offset[start : stop + 1])) + 1
            ends = np.concatenate(([0], np.cumsum(counts)))
            items = np.empty(ends[-1], np.int32)
            items[ends[:-1]] = np.arange(start, stop)
            others = np.ones(len(items), bool)
            others[ends[:-1]] = False
            rim = np.repeat(is_rim[start:stop], counts)
            inner = np.repeat(~is_rim[start:stop], np.diff(offset[start : stop + 1]))
            items[others & ~rim] = ring[offset[start] : offset[stop]][inner]
            rims = np.flatnonzero(is_rim[start:stop])
            items[others & rim] = connectivity.boundary_neighbors[start + rims].ravel()
            return Ragged(ends, items)

        super().__init__(around, connectivity.n_vertices, blocks)

    def weights(self, own: float, dtype: np.dtype) -> Weights:
        """Return weights: `own` for the vertex, the rest in equal parts for its neighbors."""

        def weigh(group: Group) -> NDArray[np.floating]:
            n_rows, count = group.members.shape
            found = np.full((n_rows, count), (1.0 - own) / max(count - 1, 1), dtype)
            found[:, 0] = own if count > 1 else 1.0
            return found

        return self.for_groups(weigh)


def smooth_positions(
    noisy: NDArray[np.floating], rings: RingAverages, n_averages: int
) -> NDArray[np.floating]:
    """Filter positions by a low-pass that leaves wide shapes as they are.

    Parameters
    ----------
    noisy : ndarray, shape (3, N)
        Noisy positions; not modified.
    rings : RingAverages
        Vertices around vertices.
    n_averages : int
        Number k of averages; larger takes away wider noise.

    Returns
    -------
    ndarray, shape (3, N)

    Notes
    -----
    With the average A of a vertex and the mean of its neighbors the filter is 1 - (1 - A^k)^m, m = `ORDER`.
    On wide shapes A is nearly 1, and they are kept up to the m-th power of the little that is missing.
    """
    weights = rings.weights(0.5, noisy.dtype)
    missing = np.ascontiguousarray(noisy.T)
    smooth = np.zeros_like(missing)
    for _ in range(ORDER):
        low = missing
        for _ in range(n_averages):
            low = rings.average(weights, low)
        smooth += low
        missing = missing - low
    return np.ascontiguousarray(smooth.T)
