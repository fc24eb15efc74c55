# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A steep low-pass of positions: the way for coarse meshes of smooth shapes.

Where edges are long in comparison with the radius of curvature, normals of neighboring faces differ as much
by shape as by noise, and positions, which are one number less differentiated, say more.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from ..blocks import Blocks
from ..normals.means import Means, padded
from ..normals.neighbors import Ragged
from ..surface.connectivity import Connectivity

ORDER = 5
"""How often what an average took away is averaged and added again: larger cuts off more steeply."""

_LEFT_OUT = 8.0
"""Terms of the series that are left out sum up to less than so many units of rounding."""

_POWER_LEFT_OUT = 0.003
"""The same for `often_averaged`, as a share: energies need no digits."""


class RingAverages(Means):
    """Means over the neighbors of each vertex; on a border, over those on the border only.

    A vertex without neighbors is its own.
    """

    def __init__(self, connectivity: Connectivity, blocks: Blocks) -> None:
        offset, ring = connectivity.ring_offset, connectivity.ring
        is_rim = connectivity.boundary_neighbors[:, 0] >= 0
        counts = np.where(is_rim, 2, np.diff(offset))
        is_alone = counts == 0
        ends = np.concatenate(([0], np.cumsum(counts + is_alone)))
        items = np.empty(ends[-1], np.int32)
        items[ends[:-1][is_alone]] = np.flatnonzero(is_alone)
        rim = np.repeat(is_rim, counts + is_alone)
        items[rim] = connectivity.boundary_neighbors[is_rim].ravel()
        inner = ~rim
        inner[ends[:-1][is_alone]] = False
        items[inner] = ring[np.repeat(~is_rim, np.diff(offset))]
        super().__init__(Ragged(ends, items), blocks, is_square=True)
        self.is_symmetric = not connectivity.is_non_manifold.any()
        """Whether all neighbors of one kind of vertices are neighbors of each other, as far as is known."""

    def mean_of(self, points: NDArray[np.floating]) -> NDArray[np.floating]:
        """Return the means, shape (3, N), of positions in columns."""
        return self.outward(self.mean(self.inward(padded(points))))[:, :3].T


def smooth_positions(
    noisy: NDArray[np.floating], rings: RingAverages, n_averages: int
) -> NDArray[np.floating]:
    """Filter positions by a low-pass that leaves wide shapes as they are.

    Parameters
    ----------
    noisy : ndarray, shape (3, N) or (4, N)
        Noisy positions, and maybe another number for each vertex; not modified.
    rings : RingAverages
        Vertices around vertices.
    n_averages : int
        Number k of averages; larger takes away wider noise.

    Returns
    -------
    ndarray of the same shape

    Notes
    -----
    With the average A of a vertex and the mean P of its neighbors, A = (I + P) / 2, the filter is
    1 - (1 - A^k)^m, m = `ORDER`. On wide shapes A is nearly 1, and they are kept up to the m-th power of the
    little that is missing.

    It is a polynomial of degree k m in P, whose spectrum is real and between -1 and 1 where neighbors are
    neighbors of each other. Written in Chebyshev polynomials its coefficients fall off like a Gaussian of
    width sqrt(k m), so that a fifth of the steps is enough for k = 64. It is applied to P x - x, which is
    small, so that single precision does. Elsewhere, the averages are taken one by one.
    """
    (change,) = low_pass_changes(rings.inward(padded(noisy)), rings, (n_averages,))
    return noisy + rings.outward(change)[:, : len(noisy)].T


def low_pass_changes(
    fields: NDArray[np.floating], rings: RingAverages, numbers: Sequence[int]
) -> list[NDArray[np.floating]]:
    """Return what low-passes change of fields, for several numbers of averages.

    Fields and changes have shape (n, C) and are numbered as inside `rings`. See `smooth_positions`. It costs
    as much as the largest number alone, but where neighbors are not neighbors of each other, all of them.
    """
    if not rings.is_symmetric:
        return [_step_by_step(fields, rings, number) - fields for number in numbers]
    first = rings.mean(fields)
    first -= fields
    eps = float(np.finfo(fields.dtype).eps)
    return _chebyshev_sums(first, rings, [_series(number, eps) for number in numbers])


def often_averaged(
    fields: NDArray[np.floating], rings: RingAverages, n_averages: int
) -> NDArray[np.floating]:
    """Return A^k of fields, shape (n, C), for smoothing: the smallest terms of the series are left out.

    The fields are used up.
    """
    if not rings.is_symmetric:
        for _ in range(n_averages):
            fields = _half_way(fields, rings)
        return fields
    return _chebyshev_sums(fields, rings, [_power_series(n_averages)])[0]


def _chebyshev_sums(
    first: NDArray[np.floating], rings: RingAverages, series: Sequence[Sequence[float]]
) -> list[NDArray[np.floating]]:
    """Return sums of c_j T_j(P) x, for several series of coefficients c_j; x may be used up."""
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
        rings.visit(current, _chebyshev_step(before, following, terms, is_first=degree == 1))
        before, current = current, following
    return sums


def _chebyshev_step(
    before: NDArray[np.floating],
    following: NDArray[np.floating],
    terms: Sequence[tuple[NDArray[np.floating], np.floating]],
    *,
    is_first: bool,
) -> Callable[[slice, NDArray[np.floating]], None]:
    """Return what makes the next polynomial of the means, and adds it to sums with their coefficients."""

    def step(part: slice, means: NDArray[np.floating]) -> None:
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

    return step


@cache
def _series(n_averages: int, eps: float) -> list[float]:
    """Return the Chebyshev coefficients of g(p), with which the filter is x + g(P) (P x - x)."""

    def g(p: Any) -> Any:
        powers = (0.5 * (1.0 + p)) ** np.arange(n_averages + 1)[:, None]
        return 0.5 * (1.0 - powers[-1]) ** (ORDER - 1) * powers[:-1].sum(axis=0)

    return _without_tail(chebyshev.chebinterpolate(g, ORDER * n_averages - 1), _LEFT_OUT * eps)


@cache
def _power_series(n_averages: int) -> list[float]:
    """Return the Chebyshev coefficients of ((1 + p) / 2)^k, the small ones left out, with sum 1."""

    def power(p: Any) -> Any:
        return (0.5 * (1.0 + p)) ** n_averages

    kept = _without_tail(chebyshev.chebinterpolate(power, n_averages), _POWER_LEFT_OUT)
    return [coefficient / sum(kept) for coefficient in kept]


def _without_tail(coefficients: NDArray[np.float64], left_out: float) -> list[float]:
    """Return coefficients without those at the end whose absolute values sum up to no more than that."""
    tails = np.cumsum(np.abs(coefficients[::-1]))[::-1]
    return [float(c) for c in coefficients[tails > left_out]]


def _half_way(fields: NDArray[np.floating], rings: RingAverages) -> NDArray[np.floating]:
    """Return A of fields, half of each vertex and half of the mean of its ring."""
    mean = rings.mean(fields)
    mean += fields
    mean *= fields.dtype.type(0.5)
    return mean


def _step_by_step(fields: NDArray[np.floating], rings: RingAverages, n_averages: int) -> NDArray[np.floating]:
    """Return low-passed fields by as many averages as there are in the formula."""
    missing = fields
    smooth = np.zeros_like(fields)
    for _ in range(ORDER):
        low = missing
        for _ in range(n_averages):
            low = _half_way(low, rings)
        smooth += low
        missing = missing - low
    return smooth
