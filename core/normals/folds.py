# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Unfolding faces that look the other way."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ..surface.surface_mesh import SurfaceMesh
from .noise_sample import area_vectors

ROUNDS = 16
STEP = 0.5
"""Share of the way to the mean of their neighbors that vertices of folded faces go in a round."""


def unfold(
    points: NDArray[np.floating],
    normals: NDArray[np.floating],
    surface: SurfaceMesh,
    ring_mean: Callable[[NDArray[np.floating]], NDArray[np.floating]],
) -> NDArray[np.floating]:
    """Move the vertices of folded faces towards the means of their one-rings until nothing is folded.

    Parameters
    ----------
    points : ndarray, shape (3, N)
        Positions; not modified.
    normals : ndarray, shape (3, F)
        Normals that the faces should have: a face is folded if it looks the other way.
    surface : SurfaceMesh
        The mesh, for its faces.
    ring_mean : callable
        Returns the means, shape (3, N), of positions over the neighbors of each vertex.

    Returns
    -------
    ndarray, shape (3, N)
        The positions with the fewest folded faces that were found.
    """
    face_of_corner = np.repeat(np.arange(surface.n_faces), surface.face_sizes())
    best, fewest = points, surface.n_faces + 1
    for _ in range(ROUNDS):
        folded = np.einsum("cf,cf->f", area_vectors(points, surface), normals) < 0
        n_folded = int(folded.sum())
        if n_folded < fewest:
            best, fewest = points, n_folded
        if not n_folded:
            break
        vertices = np.unique(surface.corner_vertex[folded[face_of_corner]])
        goal = ring_mean(points)
        points = points.copy()
        points[:, vertices] += points.dtype.type(STEP) * (goal[:, vertices] - points[:, vertices])
    return best
