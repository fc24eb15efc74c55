# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Split Bregman on vertex positions: the paper's algorithms (4.10), (4.12), (5.10), (5.11)."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..limits.constraints import Constraints
from ..transform import FrameTransform
from ..transform.level import Bands, Level
from .problem import rms_motion
from .proximal import Penalty

Callback = Callable[[int, NDArray[np.floating], float], bool]
"""`callback(iteration, points, motion)`: iterations done, positions (3, N) and rms motion of the last one;
returns True to stop."""


class Steps(NamedTuple):
    """How the iteration goes: penalty mu, feedback delta, how often, and the motion at which it ends."""

    mu: float
    delta: float
    iterations: int
    tolerance: float


def split_bregman(
    noisy: NDArray[np.floating],
    transform: FrameTransform,
    penalty: Penalty,
    steps: Steps,
    constraints: Constraints | None,
    blocks: Blocks,
    callback: Callback | None = None,
) -> tuple[NDArray[np.floating], int, bool]:
    """Minimize 1/2 |S - S~|^2 + g(W S), with g = lambda |.|_1 in the paper (4.1).

    Parameters
    ----------
    noisy : ndarray, shape (3, N)
        Noisy positions S~ in mean edge lengths, coordinates in rows; not modified.
    transform : FrameTransform
        W with frozen stencils, chosen on the noisy surface, in the dtype of `noisy`.
    penalty : Penalty
        What is to be small, g; lambda |.|_1 in the paper.
    steps : Steps
        mu, delta, iterations, tolerance.
    constraints : Constraints or None
        Vertices that may not move freely.
    callback : callable, optional
        See `Callback`.

    Returns
    -------
    points : ndarray, shape (3, N)
        Denoised positions, in the dtype of `noisy`.
    iterations : int
        Iterations that ran.
    is_stopped : bool
        True if the callback stopped the run.

    Notes
    -----
    One iteration of (4.10) is::

        S <- (S~ - c + mu V(d - b)) / (1 + mu)
        d <- T(W S + b),  b <- b + W S - d,  c <- c + delta (S - S~)

    V rebuilds a surface: by the row v in the paper's transforms, by the true adjoint, as in (4.6), where
    masks fit the valence. With y = W S + b it holds that d - b = 2 d - y = y - 2 b' for the new b', so that
    only b and S are kept. As V W S = S, the next S needs V(d - b) = S + V(b - 2 b') only. The low-pass is not
    shrunk, so its b stays zero. From the start S = S~, d = W S~, b = c = 0 the first S is S~ itself, which is
    not computed.
    """
    dtype = noisy.dtype.type
    mu, delta, damping = dtype(steps.mu), dtype(steps.delta), dtype(1.0 / (1.0 + steps.mu))
    visits = [_Shrinkage(level, penalty, steps.mu) for level in transform.levels]
    current, moved = noisy.copy(), np.empty_like(noisy)
    drift = np.zeros_like(noisy) if steps.delta > 0 else None  # c

    for iteration in range(2, steps.iterations + 1):
        change = transform.rebuild_changes(current, visits)

        def update(
            start: int,
            stop: int,
            current: NDArray[np.floating] = current,
            moved: NDArray[np.floating] = moved,
            change: NDArray[np.floating] = change,
        ) -> None:
            part = slice(start, stop)
            block = np.add(current[:, part], change[:, part], out=moved[:, part])
            if mu != 1:
                block *= mu
            block += noisy[:, part]
            if drift is not None:
                drift[:, part] += delta * (current[:, part] - noisy[:, part])
                block -= drift[:, part]
            block *= damping

        blocks.run(update, noisy.shape[1])
        del change, update  # their memory is needed by the next iteration
        if constraints is not None:
            constraints.apply(moved, noisy)
        motion = rms_motion(moved, current, blocks)
        current, moved = moved, current
        if callback is not None and callback(iteration, current, motion):
            return current, iteration, True
        if motion < steps.tolerance:
            return current, iteration, False
    return current, steps.iterations, False


class _Shrinkage:
    """Turns the bands W S of one level into b - 2 b', where b' is the new b, and keeps that."""

    def __init__(self, level: Level, penalty: Penalty, mu: float) -> None:
        self._groups = [level.group_starts(index) for index in range(len(level.sites))]
        self._unpenalized = [level.unpenalized(index) for index in range(len(level.sites))]
        self._residual: list[Bands | None] = [None] * len(level.sites)  # b, zero at first
        self._penalty, self._mu = penalty, mu

    def __call__(self, index: int, high: Bands) -> None:
        """Replace the high bands of one chunk, in place; a `Visit`."""
        free = self._unpenalized[index]
        begin, end, _ = free.indices(high.shape[1])
        # b is kept for the bands that are shrunk only: (bands, where their b is).
        shrunk = [(slice(0, begin), slice(0, begin)), (slice(end, None), slice(begin, None))]
        if begin == end:
            shrunk = [(slice(None), slice(None))]
        residual = self._residual[index]
        if residual is not None:
            for bands, own in shrunk:
                high[:, bands] += residual[:, own]
        cut = self._penalty.removed(high, self._mu, self._groups[index])
        cut[:, free] = 0
        np.multiply(cut, high.dtype.type(-2), out=high)
        if residual is not None:
            for bands, own in shrunk:
                high[:, bands] += residual[:, own]
        if begin == end:
            self._residual[index] = cut
            return
        if residual is None:
            shape = (3, high.shape[1] - (end - begin), high.shape[2])
            residual = self._residual[index] = np.empty(shape, high.dtype)
        for bands, own in shrunk:
            residual[:, own] = cut[:, bands]
