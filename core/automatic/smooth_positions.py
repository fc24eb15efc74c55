# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A steep low-pass of positions: the way for coarse meshes of smooth shapes.

Where edges are long in comparison with the radius of curvature, normals of neighboring faces differ as much
by shape as by noise, and positions, which are one number less differentiated, say more.
"""

from __future__ import annotations

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
    if not rings.is_symmetric:
        return _step_by_step(noisy, rings, n_averages)
    points = rings.inward(padded(noisy))
    before = rings.mean(points)
    before -= points
    coefficients = [noisy.dtype.type(c) for c in _series(n_averages, float(np.finfo(noisy.dtype).eps))]
    change = coefficients[0] * before
    current = before
    for degree, coefficient in enumerate(coefficients[1:], 1):
        following = np.empty_like(before) if degree == 1 else before

        def step(
            part: slice,
            means: NDArray[np.floating],
            before: NDArray[np.floating] = before,
            following: NDArray[np.floating] = following,
            degree: int = degree,
            coefficient: np.floating = coefficient,
        ) -> None:
            # T_1 = P T_0, T_(j + 1) = 2 P T_j - T_(j - 1), which may take the place of the latter.
            if degree > 1:
                means *= 2
                means -= before[part]
            following[part] = means
            means *= coefficient
            change[part] += means

        rings.visit(current, step)
        before, current = current, following
    return noisy + rings.outward(change)[:, : len(noisy)].T


@cache
def _series(n_averages: int, eps: float) -> list[float]:
    """Return the Chebyshev coefficients of g(p), with which the filter is x + g(P) (P x - x)."""

    def g(p: Any) -> Any:
        powers = (0.5 * (1.0 + p)) ** np.arange(n_averages + 1)[:, None]
        return 0.5 * (1.0 - powers[-1]) ** (ORDER - 1) * powers[:-1].sum(axis=0)

    coefficients = chebyshev.chebinterpolate(g, ORDER * n_averages - 1)
    left_out = np.cumsum(np.abs(coefficients[::-1]))[::-1]
    return [float(c) for c in coefficients[left_out > _LEFT_OUT * eps]]


def _step_by_step(noisy: NDArray[np.floating], rings: RingAverages, n_averages: int) -> NDArray[np.floating]:
    """Return what `smooth_positions` returns, by as many averages as there are in the formula."""
    missing = rings.inward(padded(noisy))
    smooth = np.zeros_like(missing)
    for _ in range(ORDER):
        low = missing
        for _ in range(n_averages):
            mean = rings.mean(low)
            mean += low
            mean *= noisy.dtype.type(0.5)
            low = mean
        smooth += low
        missing = missing - low
    return np.ascontiguousarray(rings.outward(smooth)[:, : len(noisy)].T)
