# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The space that solvers work in: around the center of the mesh, in mean edge lengths."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .connectivity import Connectivity
from .surface_mesh import SurfaceMesh


def normalize(surface: SurfaceMesh, connectivity: Connectivity, edge: float) -> NDArray[np.float64]:
    """Return positions around the center of the surface, in units of the mean edge length.

    Parameters
    ----------
    surface : SurfaceMesh
        The mesh; not modified.
    connectivity : Connectivity
        Its neighborhoods.
    edge : float
        Mean edge length.

    Returns
    -------
    ndarray, shape (N, 3), float64
        Loose vertices, which may be anywhere, are put at the center, so that they cost no digits.
    """
    positions = surface.vertices.astype(np.float64)
    used = ~connectivity.is_loose
    low, high = positions[used].min(axis=0), positions[used].max(axis=0)
    center = low + 0.5 * (high - low)
    positions[~used] = center
    return (positions - center) / edge


def displaced(vertices: NDArray[np.floating], displacement: NDArray[np.floating]) -> NDArray[np.floating]:
    """Return vertices plus a displacement, both shape (N, 3), in the dtype of the vertices.

    Coordinates that are not displaced keep their bits, the sign of a zero included.
    """
    moved = (vertices.astype(np.float64) + displacement).astype(vertices.dtype)
    return np.where(displacement != 0, moved, vertices)
