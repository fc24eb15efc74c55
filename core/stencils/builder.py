# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Collects the taps of a stencil by their places on the lattice."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..blocks import Blocks
from ..mesh.ragged import starts, stretches
from .stencil import Stencil

Place = tuple[int, int]
"""(row, column) of a tap, as in `FilterBank.offsets`."""


class StencilBuilder:
    """Collects slots and virtual points, then makes the `Stencil`.

    Parameters
    ----------
    n_vertices : int
        Number of vertices.
    offsets : array_like, shape (T, 2), int
        Places of the taps. What is set at a place without a tap is dropped, so that the rules can describe a
        whole neighborhood and each bank takes what it needs.
    n_sites : int, optional
        Number of cells, if the sites are cells. Otherwise the sites are the vertices, and a place that is
        never set holds the vertex itself: such taps carry no detail.
    is_vertex_centered : bool
        Whether tap 0 is the vertex itself.
    """

    def __init__(
        self,
        n_vertices: int,
        offsets: ArrayLike,
        n_sites: int | None = None,
        *,
        is_vertex_centered: bool = True,
        blocks: Blocks | None = None,
    ) -> None:
        self.n_vertices = n_vertices
        self.row_of = {(int(row), int(column)): tap for tap, (row, column) in enumerate(np.asarray(offsets))}
        self._is_vertex_centered = is_vertex_centered and n_sites is None
        is_vertices = n_sites is None
        n_sites = n_vertices if n_sites is None else n_sites
        self.slots = slots = np.empty((len(self.row_of), n_sites), np.int32)

        def fill(start: int, stop: int) -> None:
            slots[:, start:stop] = np.arange(start, stop, dtype=np.int32) if is_vertices else 0

        (blocks or Blocks(1)).run(fill, n_sites)
        self.is_irregular = np.zeros(n_sites, bool)
        self._n_points = n_vertices
        self._counts: list[NDArray[np.int64]] = []
        self._vertices: list[NDArray[np.int32]] = []
        self._weights: list[NDArray[np.float64]] = []

    def has(self, *places: Place) -> bool:
        """Return whether the stencil has a tap at one of the places."""
        return any(place in self.row_of for place in places)

    def set(self, place: Place, sites: NDArray[np.intp], points: NDArray[np.integer]) -> None:
        """Put points, shape (n,), under the tap at a place, if there is one."""
        if place in self.row_of:
            self.slots[self.row_of[place], sites] = points

    def add_means(
        self, values: NDArray[np.int32], begin: NDArray[np.integer], counts: NDArray[np.integer]
    ) -> tuple[NDArray[np.int32], NDArray[np.bool_]]:
        """Add the means over ragged rows of vertices, passing over negative entries.

        Parameters
        ----------
        values : ndarray of int32
            Vertex numbers; -1 stands for none.
        begin, counts : ndarray, shape (n,)
            Row i is `values[begin[i]:begin[i] + counts[i]]`.

        Returns
        -------
        points : ndarray, shape (m,), int32
            The means of the rows that have an entry, in order.
        is_filled : ndarray, shape (n,), bool
            Which rows those are.
        """
        row = np.repeat(np.arange(len(begin)), counts)
        members = values[stretches(begin, counts)]
        row, members = row[members >= 0], members[members >= 0]
        found = np.bincount(row, minlength=len(begin)).astype(np.int64)
        is_filled = found > 0
        found = found[is_filled]
        self._counts.append(found)
        self._vertices.append(members)
        self._weights.append(np.repeat(1.0 / found, found))
        return self._number(len(found)), is_filled

    def add_mirrored(self, centers: NDArray[np.integer], points: NDArray[np.integer]) -> NDArray[np.int32]:
        """Add the mirror images 2 V - P of points at vertices, both shape (n,); return their numbers, (n,).

        The mirror image of a vertex in itself is the vertex. Points may be virtual.
        """
        result = points.astype(np.int32)
        is_virtual = result >= self.n_vertices
        plain = (result != centers) & ~is_virtual
        result[plain] = self.add_combined(np.stack((centers[plain], points[plain])), (2.0, -1.0))
        if is_virtual.any():
            result[is_virtual] = self._mirror_virtual(centers[is_virtual], result[is_virtual])
        return result

    def _mirror_virtual(self, centers: NDArray[np.integer], points: NDArray[np.int32]) -> NDArray[np.int32]:
        """Add mirror images of virtual points by writing out their combinations."""
        counts, vertices, weights = self._all_virtual()
        offset = np.concatenate(([0], np.cumsum(counts)))
        wanted = points - self.n_vertices
        sizes = counts[wanted]
        place = stretches(offset[wanted], sizes)
        front = starts(sizes)
        self._counts.append(sizes + 1)
        self._vertices.append(np.insert(vertices[place], front, centers).astype(np.int32))
        self._weights.append(np.insert(-weights[place], front, 2.0))
        return self._number(len(points))

    def add_combined(self, vertices: NDArray[np.integer], weights: tuple[float, ...]) -> NDArray[np.int32]:
        """Add combinations of r vertices each, given as shape (r, n); return their numbers, shape (n,)."""
        n = vertices.shape[1]
        self._counts.append(np.full(n, len(weights), np.int64))
        self._vertices.append(vertices.T.astype(np.int32).ravel())
        self._weights.append(np.tile(weights, n))
        return self._number(n)

    def add_midpoints(self, one: NDArray[np.int64], two: NDArray[np.int64]) -> NDArray[np.int32]:
        """Return midpoints of vertices, both shape (n,), or the one that is there; -1 where none is."""
        points = np.maximum(one, two).astype(np.int32)
        differ = (one >= 0) & (two >= 0) & (one != two)
        points[differ] = self.add_combined(np.stack((one[differ], two[differ])), (0.5, 0.5))
        return points

    def positions(self, vertices: NDArray[np.floating], points: NDArray[np.int32]) -> NDArray[np.float64]:
        """Return the positions of points, vertices or virtual ones, shape (..., 3), float64."""
        is_virtual = points >= self.n_vertices
        result = vertices[np.where(is_virtual, 0, points)].astype(np.float64)
        if is_virtual.any():
            counts, members, weights = self._all_virtual()
            owner = np.repeat(np.arange(len(counts)), counts)
            virtual = np.stack(
                [np.bincount(owner, weights * vertices[members, axis], len(counts)) for axis in range(3)],
                axis=1,
            )
            result[is_virtual] = virtual[points[is_virtual] - self.n_vertices]
        return result

    def _number(self, n: int) -> NDArray[np.int32]:
        numbers = np.arange(self._n_points, self._n_points + n, dtype=np.int32)
        self._n_points += n
        return numbers

    def _all_virtual(self) -> tuple[NDArray[np.int64], NDArray[np.int32], NDArray[np.float64]]:
        return (
            np.concatenate([np.zeros(0, np.int64), *self._counts]),
            np.concatenate([np.zeros(0, np.int32), *self._vertices]),
            np.concatenate([np.zeros(0), *self._weights]),
        )

    def finish(self) -> Stencil:
        """Return the stencil."""
        counts, vertices, weights = self._all_virtual()
        offset = np.concatenate(([0], np.cumsum(counts)))
        return Stencil(
            self.n_vertices,
            self.slots,
            self._is_vertex_centered,
            offset,
            vertices,
            weights,
            self.is_irregular,
        )
