# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How strong the noise of a mesh is, from the mesh alone."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..mesh.checks import check_mesh, check_surface
from ..mesh.connectivity import Connectivity, check_connectivity, connect
from ..mesh.normalization import normalize
from ..mesh.surface_mesh import SurfaceMesh
from .fits import Residuals, fit_heights
from .local_noise import (
    TOO_STEEP,
    LocalNoise,
    chi_squared_quantile,
    find_local_noise,
    kurtosis,
    scaled_quantile,
    select_patches,
    without_shape,
)
from .patches import find_patches, local_adjacency, spread_sample

N_PATCHES = 8192
"""Patches that are looked at; on larger meshes they are spread over the surface."""

PATCHES_AT_ONCE = 1024
"""Patches in a block: their temporaries take about 15 MB."""

LEAST_DEGREES_OF_FREEDOM = 3.0
"""Degrees of freedom that a patch needs to say something about noise."""

LARGEST_PART = 1 / 3
"""Share of the mesh's vertices beyond which a patch is not local: tiny meshes cannot tell noise."""

LEAST_SIGMA = 0.01
"""Noise in mean edge lengths below which no tails are looked for; what is left there is the shape's."""

HEAVY, SCATTER = 1.22, 1.5
"""Where quiet patches have noise: product of their kurtosis and that of all patches, in units of that of
Gaussian noise, from which noise is impulsive, and how much more it takes by the root of the patches."""

HEAVY_IF_SPARSE = 1.5
"""Where quiet patches have none: kurtosis of all from which noise is impulsive. Creases of clean meshes reach
1.3."""


@dataclass(frozen=True)
class NoiseEstimate:
    """The noise of a mesh as its own surface shows it. All numbers are finite.

    Attributes
    ----------
    sigma : float
        Standard deviation of the displacement's component along the surface normal, in scene units: that of
        the paper's noise, which moves vertices along their normals, and for noise in all directions that of
        each coordinate. Components in the surface do not change its shape and are not counted. 0 if the mesh
        has too few vertices to tell noise from shape. Of impulsive noise, and of noise that differs from
        place to place, that of the quieter places.
    sigma_edges : float
        The same in mean edge lengths of the mesh as it is.
    sigma_clean_edges : float
        The same in mean edge lengths before the noise lengthened them, as far as that can be known: as if
        all edges had one length and the noise were along the normals.
    is_impulsive : bool
        Whether some vertices are moved much more than others, and not only where the surface has creases.
    rms : float
        Root mean square of the same component over all vertices, in scene units. Equal to `sigma` for
        Gaussian noise, larger for impulsive noise.
    """

    sigma: float
    sigma_edges: float
    sigma_clean_edges: float
    is_impulsive: bool
    rms: float


def estimate_noise(
    surface: SurfaceMesh,
    connectivity: Connectivity | None = None,
    blocks: Blocks | None = None,
    where: NDArray[np.bool_] | None = None,
) -> NoiseEstimate:
    """Estimate the noise of a mesh, or of a part of it, from the mesh alone.

    Parameters
    ----------
    surface : SurfaceMesh
        Any polygon mesh; not modified.
    connectivity : Connectivity, optional
        Its neighborhoods, if they are known already.
    blocks : Blocks, optional
        Threads to work on; results do not depend on their number.
    where : ndarray, shape (N,), bool, optional
        Vertices around which it is measured; by default all.

    Raises
    ------
    ValueError
        If the mesh has no faces, no size or positions that are not finite, or if the neighborhoods are not
        its own.

    Notes
    -----
    A cubic height field is fitted to the two-ring of each vertex, or of `N_PATCHES` vertices spread over a
    larger mesh (`fits`). Its residuals have the variance of the noise times known degrees of freedom. Shape
    that is finer than the fit adds to them, at creases in some patches and elsewhere in all: the first is
    told apart by the distribution of the local variances (`local_noise`), the second by what the cubic terms
    take away beyond noise.

    The noise has to be white: independent from vertex to vertex. A mesh whose own detail is that fine has it
    counted as noise.
    """
    check_mesh(surface)
    check_connectivity(connectivity, surface)
    edge = check_surface(surface)
    blocks = blocks or Blocks(1)
    connectivity = connectivity or connect(surface, blocks)
    positions = normalize(surface, connectivity, edge)
    residuals = _residuals(positions, surface, connectivity, blocks, where)
    if residuals is None:
        return NoiseEstimate(0.0, 0.0, 0.0, False, 0.0)
    noise = find_local_noise(residuals)
    wide = select_patches(residuals, noise.is_wide)
    quiet = select_patches(
        wide, wide.variance <= noise.sigma**2 * chi_squared_quantile(wide.degrees_of_freedom, 0.9)
    )
    sigma = rms = noise.sigma * without_shape(quiet, noise.sigma)
    is_impulsive = _has_heavy_tails(noise, quiet, wide)
    if is_impulsive:
        rms = max(sigma, scaled_quantile(wide, 0.5, 0.5))
    return NoiseEstimate(sigma * edge, sigma, sigma / _clean_edge(sigma), is_impulsive, rms * edge)


def _residuals(
    positions: NDArray[np.float64],
    surface: SurfaceMesh,
    connectivity: Connectivity,
    blocks: Blocks,
    where: NDArray[np.bool_] | None,
) -> Residuals | None:
    """Return what the fits leave over, or None without a patch that is small in the mesh."""
    used = np.flatnonzero(~connectivity.is_loose)
    centers = used if where is None else used[where[used]]
    if not len(centers):
        return None
    centers = spread_sample(positions, centers, N_PATCHES)
    adjacency = local_adjacency(surface, connectivity, centers)

    def kernel(start: int, stop: int) -> Residuals:
        patches = find_patches(adjacency, centers[start:stop])
        residuals = fit_heights(positions, patches)
        is_small = np.diff(patches.offset) <= LARGEST_PART * len(used)
        return select_patches(
            residuals, is_small & (residuals.degrees_of_freedom >= LEAST_DEGREES_OF_FREEDOM)
        )

    parts = blocks.with_block_size(PATCHES_AT_ONCE).run(kernel, len(centers))
    residuals = Residuals(*(np.concatenate(column) for column in zip(*parts, strict=True)))
    return residuals if len(residuals.variance) else None


def _has_heavy_tails(noise: LocalNoise, quiet: Residuals, wide: Residuals) -> bool:
    """Return whether the noise is impulsive."""
    of_all = kurtosis(wide)
    if noise.sigma > LEAST_SIGMA and noise.rise < TOO_STEEP:
        return of_all * kurtosis(quiet) > HEAVY + SCATTER / math.sqrt(len(wide.variance))
    return of_all > HEAVY_IF_SPARSE and scaled_quantile(wide, 0.5, 0.5) > LEAST_SIGMA


def _clean_edge(sigma: float) -> float:
    """Return the clean mean edge length, with that of the noisy mesh as unit, for noise along the normals.

    An edge of length e becomes sqrt(e^2 + 2 sigma^2 g^2) with a Gaussian g, whose mean by the quadrature with
    three nodes is 2 e / 3 + sqrt(e^2 + 6 sigma^2) / 3. That is set to 1 and solved for e.
    """
    return max(2.0 - math.sqrt(1.0 + 2.0 * sigma**2), 1.0 / 3.0)  # no noise makes edges much longer than that
