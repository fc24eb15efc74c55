# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Patches: a vertex with the vertices a few edges around it, for many vertices at once."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..surface.connectivity import Connectivity
from ..surface.distance_rings import sorted_unique

ENOUGH = 16
"""A patch with fewer vertices takes a third ring: on quads, and at borders."""

MOST_STEPS = 256
"""A patch does not grow where its next ring would be found over more edges than this."""


class Patches(NamedTuple):
    """Vertices around centers: those of patch i are `vertex[offset[i]:offset[i + 1]]`, its center first."""

    offset: NDArray[np.int64]
    vertex: NDArray[np.int64]

    @property
    def row(self) -> NDArray[np.intp]:
        """The patch of each entry of `vertex`."""
        return np.repeat(np.arange(len(self.offset) - 1), np.diff(self.offset))


def spread_sample(positions: NDArray[np.float64], candidates: NDArray[np.intp], n: int) -> NDArray[np.intp]:
    """Return at most n of the candidates: every k-th by distance from their mean position.

    Order by distance, and not by number, makes the sample independent of the numbering of the vertices and
    of where the mesh is and how it is turned, except for rounding where distances are equal.
    """
    if len(candidates) <= n:
        return candidates
    offset = positions[candidates] - positions[candidates].mean(axis=0)
    order = np.argsort(np.einsum("vi,vi->v", offset, offset), kind="stable")
    return candidates[order[(np.arange(n) * len(candidates)) // n]]


def find_patches(connectivity: Connectivity, centers: NDArray[np.intp]) -> Patches:
    """Return each center with its two-ring, or its three-ring where that has fewer than `ENOUGH` vertices.

    Parameters
    ----------
    connectivity : Connectivity
        One-rings.
    centers : ndarray, shape (n,), intp
        Vertices in the middle of the patches.
    """
    n_vertices = connectivity.n_vertices
    known = front = np.arange(len(centers)) * n_vertices + centers
    rings = [known]
    for step in range(3):
        row = front // n_vertices
        if step == 2:
            count = np.bincount(known // n_vertices, minlength=len(centers))
            front = front[count[row] < ENOUGH]
        front = _next_ring(connectivity, front, known, len(centers))
        known = np.concatenate((known, front))
        known.sort()
        rings.append(front)
    keys = np.concatenate(rings)
    order = np.argsort(keys // n_vertices, kind="stable")  # the center stays first
    row, vertex = np.divmod(keys[order], n_vertices)
    return Patches(np.searchsorted(row, np.arange(len(centers) + 1)), vertex)


def _next_ring(
    connectivity: Connectivity, front: NDArray[np.int64], known: NDArray[np.int64], n_patches: int
) -> NDArray[np.int64]:
    """Return the keys, patch times number of vertices plus vertex, that are one edge beyond the front."""
    n_vertices = connectivity.n_vertices
    row, vertex = np.divmod(front, n_vertices)
    steps = np.bincount(row, connectivity.valence[vertex], minlength=n_patches)
    grows = steps[row] <= MOST_STEPS
    row, vertex = row[grows], vertex[grows]
    counts = connectivity.valence[vertex].astype(np.int64)
    begin = np.repeat(connectivity.ring_offset[vertex] - (np.cumsum(counts) - counts), counts)
    reached = connectivity.ring[begin + np.arange(len(begin))] + np.repeat(row * n_vertices, counts)
    reached = sorted_unique(reached.astype(np.int64))
    if not len(reached):
        return reached
    place = np.minimum(np.searchsorted(known, reached), len(known) - 1)
    return reached[known[place] != reached]
