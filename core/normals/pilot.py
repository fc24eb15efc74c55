# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A first estimate of the clean normals: split Bregman with the exact adjoint of the pairwise face frame."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..frames.valence_masks import PairwiseBank
from ..transform.adaptive_level import AdaptiveLevel, Neighbors
from ..transform.level import Chunk

COUPLING = 10.0
"""Penalty mu; far larger than 1, so that a step changes directions little and normalizing is harmless."""

ITERATIONS = 30
ROUNDS = 4
"""Rounds of reweighted shrinkage."""

Tick = Callable[[], None]


def n_rounds(sharpness: float) -> int:
    """Return the number of rounds of `ITERATIONS` that the pilot runs."""
    return ROUNDS if sharpness else 1


def pilot_normals(
    noisy: NDArray[np.floating],
    neighbors: Neighbors,
    threshold: float,
    sharpness: float,
    blocks: Blocks,
    tick: Tick = lambda: None,
    unit: float | None = None,
) -> NDArray[np.floating]:
    """Shrink the differences of neighboring normals.

    Parameters
    ----------
    noisy : ndarray, shape (3, F)
        Unit normals of the noisy faces; not modified.
    neighbors : Neighbors
        Faces across edges.
    threshold : float
        Shrinkage threshold, in units of `unit`.
    sharpness : float
        0 for plain shrinkage. Otherwise the eps of reweighted shrinkage, for shapes made of planes: in each
        round after the first the threshold of a difference d is multiplied by eps / (|d| + eps).
    blocks : Blocks
        Threads to work on.
    tick : callable, optional
        Called after each iteration.
    unit : float, optional
        Typical difference of neighboring normals; by default the median of the noisy ones.

    Returns
    -------
    ndarray, shape (3, F)
        Unit normals.

    Notes
    -----
    n <- normalize((n0 + mu W*(d - b)) / (1 + mu)), d <- T(W n + b), b <- b + W n - d, where T shrinks each
    difference vector. Low-pass weights are equal, 1 / (k + 1) for a face with k edges, so that on closed
    meshes of one kind of faces the measure is constant.
    """
    level = AdaptiveLevel(neighbors, _EqualBank, np.ones(noisy.shape[1]), noisy.dtype, blocks)
    scale = median_difference(noisy, neighbors) if unit is None else unit
    shrink = _Reweighted(len(level.sites), threshold * scale, sharpness)
    mu = noisy.dtype.type(COUPLING)
    normals = noisy
    for round_ in range(n_rounds(sharpness)):
        if round_:
            level.forward(normals, shrink.reweigh)
        normals = noisy
        for _ in range(ITERATIONS):
            low, pending = level.forward(normals, shrink)
            normals = unit_columns(noisy + mu * level.backward(low, pending), noisy)
            tick()
    return normals


class _EqualBank(PairwiseBank):
    """Differences with equal weights: a pair of normals has the coefficient (n_i - n_j) / (k + 1)."""

    def __init__(self, valence: int) -> None:
        super().__init__(valence, np.full(valence + 1, 1.0 / (valence + 1)))


class _Reweighted:
    """Turns differences y into y - 2 b with thresholds of their own, and keeps b."""

    def __init__(self, n_chunks: int, threshold: float, sharpness: float) -> None:
        self._threshold = threshold
        self._sharpness = sharpness
        self._residual: list[Chunk | None] = [None] * n_chunks
        self._factor: list[NDArray[np.floating] | None] = [None] * n_chunks

    def __call__(self, index: int, high: Chunk) -> None:
        """Shrink a chunk in place; a `Visit`."""
        residual = self._residual[index]
        if residual is not None:
            high += residual
        norm = _lengths(high)
        threshold = high.dtype.type(self._threshold)
        factor = self._factor[index]
        limit = threshold if factor is None else threshold * factor
        np.maximum(norm, np.maximum(limit, np.finfo(high.dtype).tiny), out=norm)
        np.divide(limit, norm, out=norm)
        cut = high * norm
        self._residual[index] = cut
        high -= cut
        high -= cut

    def reweigh(self, index: int, high: Chunk) -> None:
        """Set the factors of a chunk from its differences, and start afresh; a `Visit`."""
        # Coefficients are differences divided by k + 1, and there are k (k + 1) / 2 of them.
        n_slots = (1.0 + np.sqrt(1.0 + 8.0 * high.shape[1])) / 2.0
        eps = high.dtype.type(max(self._sharpness, float(np.finfo(high.dtype).tiny)))
        self._factor[index] = eps / (_lengths(high) * high.dtype.type(n_slots) + eps)
        self._residual[index] = None


def _lengths(vectors: Chunk) -> NDArray[np.floating]:
    """Return lengths, shape (H, n), of vectors (3, H, n)."""
    squares = vectors[0] * vectors[0]
    squares += vectors[1] * vectors[1]
    squares += vectors[2] * vectors[2]
    return np.sqrt(squares, out=squares)


def unit_columns(vectors: NDArray[np.floating], fallback: NDArray[np.floating]) -> NDArray[np.floating]:
    """Return vectors, shape (3, n), scaled to length one; where there is no direction, the fallback."""
    length = np.sqrt(vectors[0] ** 2 + vectors[1] ** 2 + vectors[2] ** 2)
    good = length > np.finfo(vectors.dtype).tiny
    return np.where(good, vectors / np.where(good, length, 1), fallback)


def median_difference(normals: NDArray[np.floating], neighbors: Neighbors) -> float:
    """Return the median of |n_f - n_g| over neighboring faces, 0.0 if no face has a neighbor."""
    counts = np.diff(neighbors.offset)
    own = np.repeat(np.arange(len(counts)), counts)
    apart = own < neighbors.neighbor  # every pair once, and no face with itself
    if not apart.any():
        return 0.0
    difference = normals[:, own[apart]] - normals[:, neighbors.neighbor[apart]]
    return float(np.median(np.sqrt((difference * difference).sum(axis=0))))
