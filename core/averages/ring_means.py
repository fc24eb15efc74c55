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
from ..mesh.connectivity import Connectivity
from ..mesh.locality import stable_order
from ..mesh.ragged import Ragged, starts
from ..mesh.surface_mesh import SurfaceMesh
from .means import Means

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
    is_left_out : ndarray, shape (E,), bool, optional
        Edges that make no neighbors. A vertex with no other edges still has the mean of its neighbors, but
        counts for none of them.
    """

    def __init__(
        self,
        surface: SurfaceMesh,
        connectivity: Connectivity,
        blocks: Blocks,
        is_left_out: NDArray[np.bool_] | None = None,
    ) -> None:
        n_vertices = connectivity.n_vertices
        count = connectivity.edge_face_count
        is_plain = surface.edges[:, 0] != surface.edges[:, 1]
        rim = surface.edges[(count == 1) & is_plain]
        is_rim = np.zeros(n_vertices, bool)
        is_rim[rim] = True
        has_all = is_left_out is None or not is_left_out.any()
        if has_all and not len(rim) and not connectivity.is_loose.any():
            self._neighbors = Ragged(connectivity.ring_offset, connectivity.ring)
        else:
            inner = (count > 0) & is_plain
            if is_left_out is not None:
                inner &= ~is_left_out
                rim = surface.edges[(count == 1) & is_plain & ~is_left_out]
            pairs = surface.edges[inner]
            pairs = np.concatenate((pairs, pairs[:, ::-1]))
            pairs = np.concatenate((pairs[~is_rim[pairs[:, 0]]], rim, rim[:, ::-1]))
            if not has_all:
                is_far = np.bincount(pairs[:, 0], minlength=n_vertices) == 0
                far = surface.edges[(count > 0) & is_plain]
                far = np.concatenate((far, far[:, ::-1]))
                pairs = pairs[~is_far[pairs[:, 1]]]
                pairs = np.concatenate((pairs, far[is_far[far[:, 0]] & ~is_far[far[:, 1]]]))
            alone = np.flatnonzero(np.bincount(pairs[:, 0], minlength=n_vertices) == 0)
            pairs = np.concatenate((pairs, np.stack((alone, alone), axis=1)))
            counts = np.bincount(pairs[:, 0], minlength=n_vertices)
            order = stable_order(pairs[:, 0].astype(np.int32), n_vertices)
            self._neighbors = Ragged.of_lengths(counts, pairs[order, 1].astype(np.int32))
        super().__init__(self._neighbors, blocks, is_square=True)

    def mean_at(self, points: NDArray[np.floating], vertices: NDArray[np.integer]) -> NDArray[np.floating]:
        """Return the means, shape (3, n), of positions (3, N) over the neighbors of some vertices."""
        members, counts = self._neighbors.taken(vertices)
        total = np.add.reduceat(points[:, members], starts(counts), axis=1)
        return total / counts.astype(points.dtype)

    def averaged(self, field: NDArray[np.floating], n_averages: int) -> NDArray[np.floating]:
        """Return A^k of a field, shape (N, C), numbered as inside; A = (1 + P) / 2. Overwrites it."""
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
        """Return sums of c_j T_j(P) x for several series of coefficients c_j; x may be overwritten."""
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
