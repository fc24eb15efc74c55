# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The paper's method, POSITIONS: shrink the frame coefficients of the vertex positions by split Bregman."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..noise import estimate_noise
from ..transform import choose_frame
from .problem import Problem, Solution
from .proximal import SoftThreshold
from .split_bregman import Steps, split_bregman
from .tuning import tuned


def shrink_positions(problem: Problem) -> Solution:
    """Denoise by one of the paper's algorithms (4.10), (4.12), (5.10), (5.11).

    Parameters
    ----------
    problem : Problem
        With a transform that was made on the noisy surface, in the dtype of the noisy positions. Its strength
        is a factor for λ, which is a height of noise like the strength of AUTO.

    Returns
    -------
    Solution
        With the parameters that the noise asks for, if the tuning is NOISE.
    """
    settings, noise = problem.settings, None
    if settings.tuning == "NOISE":
        noise = estimate_noise(problem.surface, problem.connectivity, problem.blocks, problem.movable)
        settings = tuned(settings, choose_frame(settings.frame, problem.connectivity), noise)
    lambda_ = settings.strength * settings.lambda_
    if lambda_ == 0.0:  # nothing is shrunk, so nothing moves
        return Solution(problem.noisy, settings.iterations, False, settings, noise)
    assert problem.transform is not None
    callback, n_all = problem.callback, settings.iterations

    def watch(iteration: int, _: NDArray[np.floating], motion: float) -> bool:
        return callback is not None and callback((iteration - 1) / (n_all - 1), motion)

    points, iterations, is_stopped = split_bregman(
        problem.noisy,
        problem.transform,
        SoftThreshold(lambda_, settings.shrinkage),
        Steps(settings.mu, settings.delta, n_all, settings.tolerance),
        problem.constraints,
        problem.blocks,
        watch,
    )
    return Solution(points, iterations, is_stopped, settings, noise)
