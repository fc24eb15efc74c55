# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How strong the noise of a mesh is, from the mesh alone."""

from __future__ import annotations

from dataclasses import dataclass
from statistics import NormalDist

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..surface.checks import check_surface
from ..surface.connectivity import Connectivity, connect
from ..surface.normalization import normalize
from ..surface.surface_mesh import SurfaceMesh
from .fits import Leftovers, fit_heights
from .patches import find_patches, spread_sample

N_PATCHES = 16_384
"""Patches that are looked at; on larger meshes they are spread over the surface."""

PATCHES_AT_ONCE = 1024
LEAST_FREEDOM = 3.0
QUANTILE = 0.15


@dataclass(frozen=True)
class NoiseEstimate:
    """The noise of a mesh."""

    sigma: float
    sigma_edges: float
    sigma_clean_edges: float
    is_impulsive: bool
    rms: float


def estimate_noise(
    surface: SurfaceMesh, connectivity: Connectivity | None = None, blocks: Blocks | None = None
) -> NoiseEstimate:
    """Estimate the noise of a mesh."""
    edge = check_surface(surface)
    blocks = blocks or Blocks(1)
    connectivity = connectivity or connect(surface, blocks)
    positions = normalize(surface, connectivity, edge)
    leftovers = _all_leftovers(positions, connectivity, blocks)
    if leftovers is None:
        return NoiseEstimate(0.0, 0.0, 0.0, False, 0.0)
    sigma, used = _select(leftovers)
    return NoiseEstimate(sigma * edge, sigma, sigma, False, sigma * edge)


def _all_leftovers(
    positions: NDArray[np.float64], connectivity: Connectivity, blocks: Blocks
) -> Leftovers | None:
    centers = spread_sample(positions, np.flatnonzero(~connectivity.is_loose), N_PATCHES)

    def kernel(degree: int, start: int, stop: int) -> Leftovers:
        return fit_heights(positions, find_patches(connectivity, centers[start:stop]), degree)

    for degree in (3, 2):
        parts = blocks.sized(PATCHES_AT_ONCE).run(lambda a, b: kernel(degree, a, b), len(centers))  # noqa: B023
        leftovers = Leftovers(*(np.concatenate(column) for column in zip(*parts, strict=True)))
        fits = leftovers.freedom >= LEAST_FREEDOM
        if fits.any():
            return Leftovers(*(column[fits] for column in leftovers))
    return None


def _scaled_quantile(leftovers: Leftovers, quantile: float, share: float = 1.0) -> float:
    """Return sigma by which a quantile of the local estimates is that of white noise."""
    nu = leftovers.freedom
    expected = chi_quantile(nu, quantile / share)
    return float(np.quantile(np.sqrt(leftovers.variance / expected), quantile))


def chi_quantile(freedom: NDArray[np.float64], quantile: float) -> NDArray[np.float64]:
    """Return a quantile of chi-squared by its degrees of freedom (Wilson and Hilferty's cube)."""
    spread = 2.0 / (9.0 * freedom)
    return np.maximum(1.0 - spread + NormalDist().inv_cdf(quantile) * np.sqrt(spread), 1e-3) ** 3


def _select(leftovers: Leftovers) -> tuple[float, NDArray[np.bool_]]:
    """Return sigma from patches that are wide enough for it."""
    used = leftovers.extent >= np.median(leftovers.extent)
    least = np.quantile(leftovers.extent, 0.75)
    for _ in range(4):
        sigma = _scaled_quantile(Leftovers(*(c[used] for c in leftovers)), QUANTILE)
        used = leftovers.extent >= min(1.3 * sigma, least)
    return sigma, used
