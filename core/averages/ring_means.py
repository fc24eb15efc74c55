# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Means over one-rings, and polynomials in them as Chebyshev series."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from ..blocks import Blocks
from ..surface.connectivity import Connectivity
from ..surface.locality import stable_order
from ..surface.surface_mesh import SurfaceMesh
from .means import Means
from .ragged import Ragged

LEFT_OUT = 0.01
"""Terms at the end of a series that sum up to less than this are left out: bands need no digits."""


class RingMeans(Means):
    """The mean P over the neighbors of each vertex; on a border, over those along border edges only.

    Neighbors of one kind are neighbors of each other, and borders do not depend on the inside. So P is block
    triangular with blocks that are similar to symmetric matrices, and its spectrum is real, between -1 and 1.
    A vertex without neighbors is its own.

    Parameters
    ----------
    surface : SurfaceMesh
        The mesh, for its edges.
    connectivity : Connectivity
        Its neighborhoods.
    blocks : Blocks
        Threads to work on.
    """

    def __init__(self, surface: SurfaceMesh, connectivity: Connectivity, blocks: Blocks) -> None:
        offset, ring = connectivity.ring_offset, connectivity.ring
        n_vertices = connectivity.n_vertices
        rim = surface.edges[connectivity.edge_face_count == 1]
        rim = rim[rim[:, 0] != rim[:, 1]]
        starts, ends = np.concatenate((rim, rim[:, ::-1])).T
        on_rim = np.bincount(starts, minlength=n_vertices)
        counts = np.where(on_rim > 0, on_rim, np.diff(offset))
        is_alone = counts == 0
        if not on_rim.any() and not is_alone.any():
            self._neighbors = Ragged(offset, ring)
            super().__init__(self._neighbors, blocks, is_square=True)
            return
        places = np.concatenate(([0], np.cumsum(counts + is_alone)))
        items = np.empty(places[-1], np.int32)
        items[places[:-1][is_alone]] = np.flatnonzero(is_alone)
        is_inner = np.repeat((on_rim == 0) & ~is_alone, counts + is_alone)
        items[is_inner] = ring[np.repeat((on_rim == 0) & ~is_alone, np.diff(offset))]
        is_inner[places[:-1][is_alone]] = True
        items[~is_inner] = ends[stable_order(starts.astype(np.int32), n_vertices)]
        self._neighbors = Ragged(places, items)
        super().__init__(self._neighbors, blocks, is_square=True)

    def mean_at(self, points: NDArray[np.floating], vertices: NDArray[np.integer]) -> NDArray[np.floating]:
        """Return the means, shape (3, n), of positions (3, N) over the neighbors of some vertices."""
        begin = self._neighbors.offset[vertices]
        counts = self._neighbors.offset[vertices + 1] - begin
        first = np.cumsum(counts) - counts
        member = np.arange(counts.sum()) + np.repeat(begin - first, counts)
        total = np.add.reduceat(points[:, self._neighbors.items[member]], first, axis=1)
        return total / counts.astype(points.dtype)

    def averaged(self, field: NDArray[np.floating], n_averages: int) -> NDArray[np.floating]:
        """Return A^k of a field, shape (N, C), numbered as inside; A = (1 + P) / 2. The field is used up."""
        return self._sums(field, [_power_series(n_averages)])[0]

    def low_passes(self, field: NDArray[np.floating], numbers: Sequence[int]) -> list[NDArray[np.floating]]:
        """Return what the low-passes L_k = 2 A^k - A^2k change of a field, shape (N, C), for several k.

        Fields are numbered as inside. L_k - 1 = -(1 - A^k)^2 is applied as a series in P to P x - x, which is
        small, so that single precision loses nothing. All k together cost as much as the largest alone.
        """
        first = self.mean(field)
        first -= field
        return self._sums(first, [_low_pass_series(number) for number in numbers])

    def _sums(
        self, first: NDArray[np.floating], series: Sequence[Sequence[float]]
    ) -> list[NDArray[np.floating]]:
        """Return sums of c_j T_j(P) x for several series of coefficients c_j; x may be used up."""
        dtype = first.dtype.type
        sums = [dtype(coefficients[0]) * first for coefficients in series]
        before = current = first
        for degree in range(1, max(map(len, series))):
            following = np.empty_like(before) if degree == 1 else before
            terms = [
                (total, dtype(coefficients[degree]))
                for total, coefficients in zip(sums, series, strict=True)
                if degree < len(coefficients)
            ]

            def step(
                part: slice,
                means: NDArray[np.floating],
                *,
                is_first: bool = degree == 1,
                before: NDArray[np.floating] = before,
                following: NDArray[np.floating] = following,
                terms: Sequence[tuple[NDArray[np.floating], np.floating]] = terms,
            ) -> None:
                # T_1 = P T_0, T_(j + 1) = 2 P T_j - T_(j - 1), which may take the place of the latter.
                if not is_first:
                    means *= 2
                    means -= before[part]
                following[part] = means
                for total, coefficient in terms[1:]:
                    total[part] += coefficient * means
                total, coefficient = terms[0]
                means *= coefficient
                total[part] += means

            self.visit(current, step)
            before, current = current, following
        return sums


@cache
def _low_pass_series(n_averages: int) -> list[float]:
    """Return the Chebyshev coefficients of g with L_k = 1 + g(P) (P - 1), the small ones left out."""

    def g(p: Any) -> Any:
        powers = (0.5 * (1.0 + p)) ** np.arange(n_averages)[:, None]
        return 0.25 * (1.0 - p) * powers.sum(axis=0) ** 2

    return _without_tail(chebyshev.chebinterpolate(g, 2 * n_averages - 1), LEFT_OUT)


@cache
def _power_series(n_averages: int) -> list[float]:
    """Return the Chebyshev coefficients of A^k, the small ones left out, with sum 1."""

    def power(p: Any) -> Any:
        return (0.5 * (1.0 + p)) ** n_averages

    kept = _without_tail(chebyshev.chebinterpolate(power, n_averages), LEFT_OUT)
    return [coefficient / sum(kept) for coefficient in kept]


def _without_tail(coefficients: NDArray[np.float64], left_out: float) -> list[float]:
    """Return coefficients without those at the end whose absolute values sum up to no more than that."""
    tails = np.cumsum(np.abs(coefficients[::-1]))[::-1]
    return [float(c) for c in coefficients[tails > left_out]]
