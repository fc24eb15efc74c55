# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Keeping triangles from folding over when vertices move."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..surface.surface_mesh import SurfaceMesh
from .noise_sample import area_vectors

ROUNDS = 12
DAMPING = 0.6
"""Share of their way that the vertices of folded faces keep in each round; after all rounds it is 0.2 %."""


def damp_folds(
    points: NDArray[np.floating],
    origin: NDArray[np.floating],
    normals: NDArray[np.floating],
    surface: SurfaceMesh,
) -> NDArray[np.floating]:
    """Take vertices of faces that the motion folded part of the way back, until no new fold remains.

    Parameters
    ----------
    points, origin : ndarray, shape (3, N)
        Moved positions, and those before; not modified.
    normals : ndarray, shape (3, F)
        Normals that the faces should have: a face is folded if it looks the other way.
    surface : SurfaceMesh
        The mesh, for its faces.

    Returns
    -------
    ndarray, shape (3, N)
        Positions with at most as many folded faces as before, as far as the rounds suffice.
    """
    was_good = _side(origin, normals, surface) > 0
    points = points.copy()
    face_of_corner = np.repeat(np.arange(surface.n_faces), surface.face_sizes())
    for round_ in range(ROUNDS + 1):
        folded = was_good & (_side(points, normals, surface) <= 0)
        if not folded.any():
            break
        vertices = np.unique(surface.corner_vertex[folded[face_of_corner]])
        share = points.dtype.type(DAMPING if round_ < ROUNDS else 0.0)
        points[:, vertices] = origin[:, vertices] + share * (points[:, vertices] - origin[:, vertices])
    return points


def _side(
    points: NDArray[np.floating], normals: NDArray[np.floating], surface: SurfaceMesh
) -> NDArray[np.floating]:
    """Return areas seen from the direction of the normals, shape (F,); negative for folded faces."""
    return np.einsum("cf,cf->f", area_vectors(points, surface), normals)
