# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A first estimate of the clean normals: split Bregman with the exact adjoint of the pairwise face frame."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..transform.adaptive_level import Neighbors
from .face_pairs import FacePairs
from .parts import empty_parts

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
    meshes of one kind of faces the measure is constant. As W* W n = n, and with the new b', W*(d - b') is
    n + W*(b - 2 b'), in which only differences count: the low-pass is neither made nor sent back.
    """
    pairs = FacePairs(neighbors, blocks)
    scale = median_difference(noisy, neighbors, blocks) if unit is None else unit
    shrink = _Reweighted(pairs, threshold * scale, sharpness, noisy.dtype)
    mu = noisy.dtype.type(COUPLING)
    normals = noisy
    for round_ in range(n_rounds(sharpness)):
        if round_:
            pairs.visit(normals, shrink.reweigh)
        normals = noisy.copy()
        for _ in range(ITERATIONS):
            returned = pairs.returned(normals, shrink)

            def step(
                faces: NDArray[np.int32] | slice,
                change: NDArray[np.floating],
                normals: NDArray[np.floating] = normals,
            ) -> None:
                change += normals[:, faces]
                change *= mu
                change += noisy[:, faces]
                normals[:, faces] = unit_columns(change, noisy[:, faces])

            returned.for_faces(step)
            tick()
    return normals


class _Reweighted:
    """Turns differences n_i - n_j into b - 2 b' with thresholds of their own, and keeps b'.

    All are k + 1 times those of the coefficients.
    """

    def __init__(self, pairs: FacePairs, threshold: float, sharpness: float, dtype: np.dtype) -> None:
        self._thresholds = [dtype.type(threshold * len(chunk.taps)) for chunk in pairs.chunks]
        self._sharpness = dtype.type(max(sharpness, float(np.finfo(dtype).tiny)))
        self._smallest = np.finfo(dtype).tiny
        # Of k + 1 taps there are k (k + 1) / 2 pairs.
        shapes = [(3, len(taps) * (len(taps) - 1) // 2, taps.shape[1]) for taps, _ in pairs.chunks]
        self._residual = empty_parts(shapes, dtype)
        self._is_started = [False] * len(pairs.chunks)
        self._factor: list[NDArray[np.floating] | None] = [None] * len(pairs.chunks)

    def __call__(self, index: int, apart: NDArray[np.floating]) -> NDArray[np.floating]:
        """Return b - 2 b' of a chunk, in the memory of its differences; a `Change`."""
        residual, is_started = self._residual[index], self._is_started[index]
        if is_started:
            apart += residual
        norm = _lengths(apart)
        factor = self._factor[index]
        limit = self._thresholds[index] if factor is None else self._thresholds[index] * factor
        np.maximum(norm, np.maximum(limit, self._smallest), out=norm)
        np.divide(limit, norm, out=norm)
        if not is_started:
            np.multiply(apart, norm, out=residual)
            self._is_started[index] = True
            return np.multiply(residual, apart.dtype.type(-2), out=apart)
        shrunk = apart * norm
        np.subtract(residual, shrunk, out=apart)
        apart -= shrunk
        residual[...] = shrunk
        return apart

    def reweigh(self, index: int, apart: NDArray[np.floating]) -> None:
        """Set the factors of a chunk from its differences, and start afresh; a `Change`."""
        self._factor[index] = self._sharpness / (_lengths(apart) + self._sharpness)
        self._is_started[index] = False


def _lengths(vectors: NDArray[np.floating]) -> NDArray[np.floating]:
    """Return lengths, shape (...), of vectors (3, ...)."""
    squares = vectors[0] * vectors[0]
    squares += vectors[1] * vectors[1]
    squares += vectors[2] * vectors[2]
    return np.sqrt(squares, out=squares)


def unit_columns(vectors: NDArray[np.floating], fallback: NDArray[np.floating]) -> NDArray[np.floating]:
    """Return vectors, shape (3, n), scaled to length one; where there is no direction, the fallback."""
    length = _lengths(vectors)
    good = length > np.finfo(vectors.dtype).tiny
    if good.all():
        return vectors / length
    return np.where(good, vectors / np.where(good, length, 1), fallback)


def median_difference(
    normals: NDArray[np.floating], neighbors: Neighbors, blocks: Blocks | None = None
) -> float:
    """Return the median of |n_f - n_g| over neighboring faces, 0.0 if no face has a neighbor."""
    apart = neighbor_distances(normals, neighbors, blocks)
    return float(np.median(apart)) if len(apart) else 0.0


def neighbor_distances(
    values: NDArray[np.floating], neighbors: Neighbors, blocks: Blocks | None = None
) -> NDArray[np.floating]:
    """Return |v_f - v_g| of all neighboring faces f < g, shape (n,), for values of shape (3, F)."""
    offset = neighbors.offset

    def kernel(start: int, stop: int) -> NDArray[np.floating]:
        own = np.repeat(np.arange(start, stop, dtype=np.int32), np.diff(offset[start : stop + 1]))
        other = neighbors.neighbor[offset[start] : offset[stop]]
        once = np.flatnonzero(own < other)  # every pair once, and no face with itself
        apart = values.take(own[once], axis=1)
        apart -= values.take(other[once], axis=1)
        return _lengths(apart)

    return np.concatenate((blocks or Blocks(1)).run(kernel, len(offset) - 1))
