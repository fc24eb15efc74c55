# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bands of positions with gains: the way for coarse meshes of smooth shapes.

Where edges are long in comparison with the radius of curvature, normals of neighboring faces differ as much
by shape as by noise, and positions, which are one number less differentiated, say more.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..normals.averages import Averages, Group, Weights
from ..normals.band_shrinkage import shrink_bands
from ..normals.neighbors import Ragged
from ..surface.connectivity import Connectivity

PILOT_STEPS = 8
"""Averages of the first pilot; twice as many in all, as what they take from its shape is added again."""

PASSES = 2


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
    noisy: NDArray[np.floating],
    noise: NDArray[np.floating],
    rings: RingAverages,
    n_bands: int,
    caution: float,
) -> NDArray[np.floating]:
    """Shrink the bands of positions.

    Parameters
    ----------
    noisy, noise : ndarray, shape (3, N)
        Noisy positions and a sample of the noise in them; not modified.
    rings : RingAverages
        Vertices around vertices.
    n_bands : int
        Number of bands.
    caution : float
        See `normals.band_shrinkage`.

    Returns
    -------
    ndarray, shape (3, N)
    """
    weights = rings.weights(0.5, noisy.dtype)
    rows, sample = np.ascontiguousarray(noisy.T), np.ascontiguousarray(noise.T)
    low = rows
    for _ in range(PILOT_STEPS):
        low = rings.average(weights, low)
    lost = rows - low
    for _ in range(PILOT_STEPS):
        lost = rings.average(weights, lost)
    pilot = low + lost
    for _ in range(PASSES):
        pilot = shrink_bands(rows, sample, pilot, rings, weights, n_bands, caution)
    return np.ascontiguousarray(pilot.T)
