# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Split Bregman as a function of a transform and a penalty of one's own."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..blocks import Blocks
from ..errors import SettingError
from ..transform import FrameTransform
from ..transform.level import Bands
from ..value_checks import check_callable, check_number, shown
from .proximal import FirmThreshold, HardThreshold, OwnPenalty, Penalty, SoftThreshold
from .split_bregman import Steps
from .split_bregman import split_bregman as iterate

LEAST_MU = 1e-12
"""Penalty that is positive: beside smaller ones nothing of the positions is left."""

Observer = Callable[[int, NDArray[np.floating], float], bool | None]
"""`callback(iteration, vertices, objective)`: the iterate, shape (N, 3), and 1/2 |S - S~|^2 + g(W S) there;
returns True to stop."""


def split_bregman(
    vertices: ArrayLike,
    transform: FrameTransform,
    prox: Penalty | Callable[[Bands, float], Bands],
    *,
    penalty: Callable[[Bands], float] | None = None,
    mu: float = 1.0,
    delta: float = 0.0,
    iterations: int = 10,
    tolerance: float = 0.0,
    callback: Observer | None = None,
) -> NDArray[np.floating]:
    """Minimize 1/2 |S - S~|^2 + g(W S) over positions S by split Bregman (4.10).

    Parameters
    ----------
    vertices : array_like, shape (N, 3)
        Noisy positions S~; not modified. Weights and thresholds are in their unit.
    transform : FrameTransform
        W, made on these positions.
    prox : SoftThreshold, HardThreshold, FirmThreshold, or callable
        The penalty g, or the proximal operator of one: ``prox(bands, step)`` returns the minimum over x of
        g(x) + |x - bands|^2 / 2 step, where `bands`, shape (3, H, n), are the high bands of n vertices. It is
        called for parts of the mesh, with step = 1 / mu.
    penalty : callable, optional
        ``penalty(bands)`` returns the g that `prox` belongs to, for the objective.
    mu, delta, iterations, tolerance : optional
        As in `DenoiseSettings`; the tolerance in the unit of the positions.
    callback : callable, optional
        `callback(iteration, vertices, objective)` after each iteration; True stops. Of an operator without
        its penalty the objective is NaN. It costs an analysis an iteration.

    Returns
    -------
    ndarray, shape (N, 3)
        Positions in the dtype of the transform. First differences that a frame leaves alone, see
        `Level.unpenalized`, take no part in g.

    Raises
    ------
    MeshError
        If the positions do not fit the transform.
    SettingError
        If a number is not allowed.

    Examples
    --------
    >>> from framelet.core import FrameTransform
    >>> points = np.random.default_rng(0).normal(0, 0.1, (25, 3))
    >>> points[:, :2] += np.stack(np.meshgrid(range(5), range(5)), axis=-1).reshape(-1, 2)
    >>> corner = np.arange(20).reshape(4, 5)[:, :4].ravel()
    >>> faces = np.stack((corner, corner + 1, corner + 6, corner + 5), axis=1)
    >>> W = FrameTransform(points, faces, "linear-spline")
    >>> objectives = []
    >>> keep = lambda iteration, vertices, objective: objectives.append(objective)
    >>> clean = split_bregman(points, W, SoftThreshold(0.1), callback=keep)
    >>> objectives[-1] < objectives[0]
    True
    """
    if not isinstance(transform, FrameTransform):
        raise SettingError(f"The transform is {shown(transform)}; give a FrameTransform.")
    positions = transform.positions_of(vertices)
    check_number("mu", mu, LEAST_MU)
    check_number("delta", delta, 0.0, 1.0)
    check_number("The number of iterations", iterations, 1, is_whole=True)
    check_number("The tolerance", tolerance, 0.0)
    check_callable("The proximal operator", () if prox is None else prox)
    check_callable("The penalty", penalty)
    check_callable("The callback", callback)
    known = prox if isinstance(prox, SoftThreshold | HardThreshold | FirmThreshold) else None
    g: Penalty = known or (prox if hasattr(prox, "removed") else OwnPenalty(prox, penalty))  # type: ignore
    noisy = np.ascontiguousarray(positions.T, transform.dtype)

    def after_step(iteration: int, points: NDArray[np.floating], _: float) -> bool:
        if callback is None:
            return False
        objective = _objective(points, noisy, transform, g)
        return bool(callback(iteration, np.ascontiguousarray(points.T), objective))

    found = iterate(noisy, transform, g, Steps(mu, delta, iterations, tolerance), None, Blocks(1), after_step)
    return np.ascontiguousarray(found[0].T)


def _objective(
    points: NDArray[np.floating], noisy: NDArray[np.floating], transform: FrameTransform, g: Penalty
) -> float:
    """Return 1/2 |S - S~|^2 + g(W S) at positions, shape (3, N)."""
    apart = points.astype(np.float64) - noisy
    total = 0.5 * float((apart * apart).sum())
    for level, chunks in zip(transform.levels, transform.analyze(points.T).chunks, strict=True):
        for index, chunk in enumerate(chunks):
            bands = chunk.copy()
            bands[:, level.unpenalized(index)] = 0
            total += g.value(bands, level.group_starts(index))
    return total
