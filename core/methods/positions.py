# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The paper's method, POSITIONS: shrink the frame coefficients of the vertex positions by split Bregman."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..noise import NoiseEstimate, estimate_noise
from ..settings import DenoiseSettings
from .problem import Problem, Solution
from .proximal import SoftThreshold
from .split_bregman import Steps, split_bregman

FACTORS = {
    ("BANDS", "TRIANGLES"): 4.0,
    ("VECTOR", "TRIANGLES"): 1.75,
    ("SCALAR", "QUADS"): 0.65,
    ("VECTOR", "QUADS"): 0.85,
    ("VECTOR", "ADAPTIVE"): 3.0,
}
"""λ in units of the noise, by shrinkage and kind of frame: where the geometric mean of the angle errors of
development models with noise of 0.1, 0.2 and 0.5 edge lengths was lowest or no longer fell much, with the
preset of that shrinkage: on four models of triangles and two of quads. The last one was not fitted so: its
best λ was seen between 0.5 and 1 at noise of 0.2 edge lengths."""

OTHER_FACTOR = 1.0
MU = 1.0
ITERATIONS = 10


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
        assert problem.transform is not None
        settings = tuned(settings, problem.transform.frame, noise)
    lambda_ = settings.strength * settings.lambda_
    if lambda_ == 0.0:  # nothing is shrunk, so nothing moves
        return Solution(problem.noisy, settings.iterations, False, settings, noise)
    assert problem.transform is not None
    callback, n_all = problem.callback, settings.iterations

    def after_step(iteration: int, _: NDArray[np.floating], motion: float) -> bool:
        return callback is not None and callback((iteration - 1) / (n_all - 1), motion)

    points, iterations, is_stopped = split_bregman(
        problem.noisy,
        problem.transform,
        SoftThreshold(lambda_, settings.shrinkage),
        Steps(settings.mu, settings.delta, n_all, settings.tolerance),
        problem.constraints,
        problem.blocks,
        after_step,
    )
    return Solution(points, iterations, is_stopped, settings, noise)


def tuned(settings: DenoiseSettings, frame: str, noise: NoiseEstimate) -> DenoiseSettings:
    """Return settings with λ, μ and the number of iterations for a noise, and the frame that was made.

    A mesh without noise gets λ = 0, so that nothing moves. Of impulsive noise the root mean square counts.
    """
    sigma = noise.sigma_edges
    if noise.is_impulsive and noise.sigma > 0:
        sigma *= noise.rms / noise.sigma
    if frame in ("ADAPTIVE", "PAIRWISE"):
        kind = "ADAPTIVE"
    else:
        kind = "TRIANGLES" if frame.startswith("BOX_SPLINE_111") else "QUADS"
    factor = FACTORS.get((settings.shrinkage, kind), OTHER_FACTOR)
    return settings.with_changes(lambda_=min(factor * sigma, 100.0), mu=MU, iterations=ITERATIONS)
