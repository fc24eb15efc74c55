# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The paper's noise model (section 4.1): Gaussian displacements along the vertex normals."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..errors import SettingError
from ..mesh.checks import check_surface
from ..mesh.geometry import vertex_normals
from ..mesh.surface_mesh import SurfaceMesh
from ..value_checks import check_number

PAPER_SIGMA = 0.2
"""Standard deviation in the paper's experiments, in mean edge lengths (section 4.2)."""


def add_noise(surface: SurfaceMesh, sigma: float = PAPER_SIGMA, seed: int = 0) -> NDArray[np.floating]:
    """Displace the vertices of a surface along their normals by Gaussian noise.

    Parameters
    ----------
    surface : SurfaceMesh
        The clean surface; not modified.
    sigma : float
        Standard deviation in mean edge lengths.
    seed : int
        Seed of the random numbers; the same seed gives the same noise.

    Returns
    -------
    ndarray, shape (N, 3), dtype of the vertices
        Noisy positions. Loose vertices have no normal and stay.

    Raises
    ------
    SettingError
        If sigma is negative or not finite, or the mesh has no faces, no size or positions that are not
        finite.
    """
    check_number("The noise level", sigma, 0.0)
    check_number("The seed", seed, 0, is_whole=True)
    edge = check_surface(surface)
    offset = np.random.default_rng(seed).normal(0.0, 1.0, surface.n_vertices)
    with np.errstate(over="ignore", invalid="ignore"):
        vertices = surface.vertices + (offset * (float(sigma) * edge))[:, None] * vertex_normals(surface)
        noisy = vertices.astype(surface.vertices.dtype)
    if not np.isfinite(noisy).all():
        raise SettingError(f"The noise level is {sigma:g}; with it there are no numbers for the positions.")
    return noisy
