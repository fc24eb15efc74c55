# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What many local variances say: which of them are noise alone, and whether it is Gaussian."""

from __future__ import annotations

from statistics import NormalDist
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .fits import Residuals

SHARES = (1.0, 0.7, 0.5, 0.35, 0.25, 0.18, 0.12)
"""Shares of the patches that may be free of shape."""

PLACES = (0.1, 0.25, 0.5, 0.75)
"""Where the distribution of the local variances is compared with that of white noise."""

FLAT_ENOUGH = 0.07
"""Relative rise of sigma over the places at which the local variances count as those of white noise."""

TOO_STEEP = 1.0
"""Rise from which the patches do not show one noise at all."""

WIDE_ENOUGH = 1.3
"""Least extent of a patch in standard deviations of the noise. On narrower patches the fitted plane may turn
into the noise, so that it looks too weak."""

ALWAYS_WIDE = 0.75
"""The patches whose extent is above this quantile count as wide in any case."""

ROUNDS = 5
"""Most rounds of finding sigma and the wide patches; two or three are usual."""

CUBIC_TO_REST = 0.12
"""Shape that a cubic fit leaves over, as a share of what its cubic terms take away, both per degree of
freedom: measured on meshes with fine relief."""

MOST_EXCESS = 3.0
"""Most that the cubic terms count for, in variances of the noise: noise that is not white shows there too."""


class LocalNoise(NamedTuple):
    """What the patches agree on, in the units of the positions."""

    sigma: float
    rise: float
    """How much larger sigma is by the upper of the quiet variances than by the lower ones, minus 1."""
    share: float
    """Share of the wide patches that seem to be free of shape."""
    is_wide: NDArray[np.bool_]


def find_local_noise(residuals: Residuals) -> LocalNoise:
    """Find sigma and the patches to measure it on, which depend on each other."""
    always = np.quantile(residuals.extent, ALWAYS_WIDE)
    is_wide = residuals.extent >= always
    found = LocalNoise(0.0, 0.0, 1.0, is_wide)
    for _ in range(ROUNDS):
        found = _quiet_sigma(select_patches(residuals, is_wide))._replace(is_wide=is_wide)
        before, is_wide = is_wide, residuals.extent >= min(WIDE_ENOUGH * found.sigma, always)
        if (is_wide == before).all():
            break
    return found


def _quiet_sigma(residuals: Residuals) -> LocalNoise:
    """Return sigma from the largest share of quiet patches that is distributed as white noise would be.

    Shape that the fits leave over only adds to the local variances. If a share w of the patches has none, the
    quantile p w of all is the quantile p of theirs, and for the right w all places p give one sigma. Without
    such a share the one with the least rise is taken, and where all rise steeply, as on clean meshes with
    creases, the smallest.
    """
    best = LocalNoise(0.0, np.inf, SHARES[-1], np.zeros(0, bool))
    for share in SHARES:
        sigmas = [scaled_quantile(residuals, place * share, place) for place in PLACES]
        rise = sigmas[-1] / sigmas[0] - 1.0 if sigmas[0] > 0.0 else np.inf
        if rise < best.rise:
            best = LocalNoise(float(np.median(sigmas)), rise, share, best.is_wide)
        if rise < FLAT_ENOUGH:
            break
    if best.rise > TOO_STEEP:
        best = best._replace(sigma=float(np.median(sigmas)), share=SHARES[-1])
    return best


def without_shape(residuals: Residuals, sigma: float) -> float:
    """Return what to multiply sigma by so that relief which is in all patches does not count as noise."""
    known = residuals.cubic_degrees_of_freedom >= 1.0
    if not known.any() or sigma == 0.0:
        return 1.0
    cubic = residuals.cubic[known] / chi_squared_quantile(residuals.cubic_degrees_of_freedom[known], 0.5)
    excess = min(max(float(np.median(cubic)) / sigma**2 - 1.0, 0.0), MOST_EXCESS)
    return float(np.sqrt(1.0 - CUBIC_TO_REST * excess))


def scaled_quantile(residuals: Residuals, quantile: float, place: float) -> float:
    """Return the sigma of white noise for which a quantile of the local variances is at the given place."""
    scaled = residuals.variance / chi_squared_quantile(residuals.degrees_of_freedom, place)
    return float(np.sqrt(np.quantile(scaled, quantile)))


def kurtosis(residuals: Residuals) -> float:
    """Return the kurtosis of the centers' residuals in units of that of Gaussian noise; 0 without any.

    Each residual is studentized by its patch, so that patches with more shape or noise count no more than
    others. With nu degrees of freedom its kurtosis is 3 nu / (nu + 2) for Gaussian noise.
    """
    squares = residuals.studentized**2
    if not squares.any():
        return 0.0
    expected = 3.0 * residuals.degrees_of_freedom / (residuals.degrees_of_freedom + 2.0)
    return float((squares**2).mean() / expected.mean() / squares.mean() ** 2)


def chi_squared_quantile(degrees_of_freedom: NDArray[np.float64], place: float) -> NDArray[np.float64]:
    """Return a quantile of chi-squared by its degrees of freedom, after Wilson and Hilferty (1931)."""
    spread = 2.0 / (9.0 * degrees_of_freedom)
    return np.maximum(1.0 - spread + NormalDist().inv_cdf(place) * np.sqrt(spread), 0.01) ** 3


def select_patches(residuals: Residuals, which: NDArray[np.bool_]) -> Residuals:
    """Return some of the patches."""
    return Residuals(*(column[which] for column in residuals))
