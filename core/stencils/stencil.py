# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Stencils: which points fill the taps of each vertex's mask.

A point is a vertex or a *virtual* point, a fixed affine combination of vertices (a mean, a midpoint, a
mirrored point). Virtual points are numbered behind the vertices, so that a stencil is one table of indices
and filling the data-matrix is one gather.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks


@dataclass(frozen=True, eq=False)
class Stencil:
    """Taps of every vertex.

    Attributes
    ----------
    slots : ndarray, shape (T - 1, N), int32
        Points of taps 1 to T - 1; tap 0 is the vertex itself. Numbers from N on are virtual points.
    virtual_offset : ndarray, shape (X + 1,), int64
        Virtual point x combines the vertices `virtual_vertex[virtual_offset[x]:virtual_offset[x + 1]]`.
    virtual_vertex : ndarray, shape (Y,), int32
        Vertices of the combinations.
    virtual_weight : ndarray, shape (Y,), float64
        Their weights, which sum to 1 for each virtual point.
    is_irregular : ndarray, shape (N,), bool
        Vertices with faces that took a rule for irregular vertices, boundary ones included.
    """

    slots: NDArray[np.int32]
    virtual_offset: NDArray[np.int64]
    virtual_vertex: NDArray[np.int32]
    virtual_weight: NDArray[np.float64]
    is_irregular: NDArray[np.bool_]

    @property
    def n_vertices(self) -> int:
        """Number of vertices, N."""
        return self.slots.shape[1]

    @property
    def n_taps(self) -> int:
        """Number of taps, T, the vertex included."""
        return len(self.slots) + 1

    @property
    def n_points(self) -> int:
        """Number of points, N + X: vertices, then virtual points."""
        return self.n_vertices + len(self.virtual_offset) - 1

    def fill_virtual(self, points: NDArray[np.floating], blocks: Blocks) -> None:
        """Compute the virtual points from the vertices, in place.

        Parameters
        ----------
        points : ndarray, shape (3, N + X)
            Coordinates in rows; the first N columns are read, the others are written.
        blocks : Blocks
            Threads to work on.
        """
        offset = self.virtual_offset
        weight = self.virtual_weight.astype(points.dtype)

        def kernel(start: int, stop: int) -> None:
            part = slice(offset[start], offset[stop])
            members = points.take(self.virtual_vertex[part], axis=1, mode="clip")
            members *= weight[part]
            begin = self.n_vertices
            np.add.reduceat(
                members, offset[start:stop] - offset[start], axis=1, out=points[:, begin + start : begin + stop]
            )

        blocks.run(kernel, len(offset) - 1)

    def extended(self, vertices: NDArray[np.floating], blocks: Blocks | None = None) -> NDArray[np.floating]:
        """Return the coordinates of all points in rows, shape (3, N + X), from vertices of shape (N, 3)."""
        points = np.empty((3, self.n_points), vertices.dtype)
        points[:, : self.n_vertices] = vertices.T
        self.fill_virtual(points, blocks or Blocks(1))
        return points

    def gather(self, points: NDArray[np.floating], start: int, stop: int) -> NDArray[np.floating]:
        """Return the data-matrix of vertices start to stop, shape (3, T, stop - start)."""
        matrix = np.empty((3, self.n_taps, stop - start), points.dtype)
        matrix[:, 0] = points[:, start:stop]
        matrix[:, 1:] = points.take(self.slots[:, start:stop], axis=1, mode="clip")
        return matrix

    def data_matrix(self, vertices: NDArray[np.floating]) -> NDArray[np.floating]:
        """Return the whole data-matrix D = C(S) of section 3.1, shape (T, N, 3)."""
        return self.gather(self.extended(vertices), 0, self.n_vertices).transpose(1, 2, 0)


class StencilBuilder:
    """Collects slots and virtual points, then makes the `Stencil`.

    Slots that are never set hold the vertex itself: such taps carry no detail, and the vertex stays.
    """

    def __init__(self, n_vertices: int, n_taps: int) -> None:
        self.slots = np.repeat(np.arange(n_vertices, dtype=np.int32)[None], n_taps - 1, axis=0)
        self.is_irregular = np.zeros(n_vertices, bool)
        self._n_points = n_vertices
        self._counts: list[NDArray[np.int64]] = []
        self._vertices: list[NDArray[np.int32]] = []
        self._weights: list[NDArray[np.float64]] = []

    def add_ragged(self, vertices: NDArray[np.int32], counts: NDArray[np.integer]) -> NDArray[np.int32]:
        """Add means of consecutive groups of vertices; return the new points' numbers, shape (n,)."""
        counts = counts.astype(np.int64)
        self._counts.append(counts)
        self._vertices.append(vertices.astype(np.int32))
        self._weights.append(np.repeat(1.0 / counts, counts))
        return self._number(len(counts))

    def add_mirrored_means(
        self, centers: NDArray[np.integer], vertices: NDArray[np.int32], counts: NDArray[np.integer]
    ) -> NDArray[np.int32]:
        """Add the mirror images 2 V - P of means P as in `add_ragged`, at the centers V, shape (n,)."""
        counts = counts.astype(np.int64)
        place = np.cumsum(counts) - counts
        self._counts.append(counts + 1)
        self._vertices.append(np.insert(vertices, place, centers).astype(np.int32))
        self._weights.append(np.insert(np.repeat(-1.0 / counts, counts), place, 2.0))
        return self._number(len(counts))

    def add_combined(self, vertices: NDArray[np.integer], weights: tuple[float, ...]) -> NDArray[np.int32]:
        """Add combinations of r vertices each, given as shape (r, n); return the new points' numbers, (n,)."""
        n = vertices.shape[1]
        self._counts.append(np.full(n, len(weights), np.int64))
        self._vertices.append(vertices.T.astype(np.int32).ravel())
        self._weights.append(np.tile(weights, n))
        return self._number(n)

    def _number(self, n: int) -> NDArray[np.int32]:
        numbers = np.arange(self._n_points, self._n_points + n, dtype=np.int32)
        self._n_points += n
        return numbers

    def finish(self) -> Stencil:
        """Return the stencil."""
        counts = np.concatenate([np.zeros(1, np.int64), *self._counts])
        return Stencil(
            self.slots,
            np.cumsum(counts),
            np.concatenate([np.zeros(0, np.int32), *self._vertices]),
            np.concatenate([np.zeros(0), *self._weights]),
            self.is_irregular,
        )
