# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is to be small: one number from the risk of a result, its roughness, and the angle of a rehearsal."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

UNCERTAINTY = 0.08
"""In units of the variance of the noise: how well risks are known. It is added to them, so that risks that
are all nearly zero leave the choice to smoothness."""

SMOOTHNESS = (0.25, 0.25)
"""Powers of the two measures of roughness that risks are multiplied by for a first choice."""

REHEARSED = (0.7, 0.2, 0.1, 1.0)
"""Powers of the risk, of two measures of roughness, and of the rehearsed angle, for the last choice."""

PASSED = (0.5, 0.4, 0.0, 1.0)
"""The same for further passes."""

HELD = (0.0, 0.12, 0.5, 0.5)
"""The same for vertices that are held in place."""

IN_PLACE = 0.04
"""Share of the score that is taken off where all vertices are held in place, as that is worth something."""

TINY_ROUGHNESS = 1e-4
"""Differences of normals below this are rounding."""

TINY_ANGLE = 1e-3
"""Degrees; where no angle can be measured, or all are rounding, risk and roughness decide alone."""


def scores(
    judged: NDArray[np.float64],
    angles: NDArray[np.float64] | None = None,
    strength: float = 1.0,
    powers: tuple[float, float, float, float] = REHEARSED,
) -> NDArray[np.float64]:
    """Return what is to be small, shape (n,).

    Parameters
    ----------
    judged : ndarray, shape (n, 3)
        Risks in variances of the noise, and two measures of roughness.
    angles : ndarray, shape (n,), optional
        Angles of a rehearsal; without them, the score is that of the first choice.
    strength : float, optional
        Factor on the powers of roughness: who asks for more than was measured wants it smoother.
    powers : tuple of float, optional
        Those with angles.
    """
    risk, *roughness = judged.T
    of_risk, *of_roughness, of_angle = (1.0, *SMOOTHNESS, 0.0) if angles is None else powers
    found = (risk - min(0.0, float(risk.min())) + UNCERTAINTY) ** of_risk
    for rough, power in zip(roughness, of_roughness, strict=True):
        smallest = max(float(rough.min()), TINY_ROUGHNESS)
        found = found * (np.maximum(rough, smallest) / smallest) ** (strength * power)
    return found if angles is None else found * np.maximum(angles, TINY_ANGLE) ** of_angle


def risk_of(height: NDArray[np.float64], divergence: float) -> float:
    """Return Stein's estimate of the mean squared error, in variances of the noise.

    Parameters
    ----------
    height : ndarray, shape (m,)
        How far vertices were moved along their normals, in standard deviations of the noise.
    divergence : float
        How much of a motion of the vertices is in the result, 1 if all of it is.
    """
    return float(np.mean(height * height)) - 1.0 + 2.0 * divergence
