# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertices that slid within the surface go back to where they were measured."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..normals.noise_sample import normals_of
from ..surface.surface_mesh import SurfaceMesh

LARGEST_TURN = 15.0
"""Degrees by which a face may turn when its vertices go back: folds and slivers turn farther."""

HALVINGS = 4
"""How often vertices of faces that turn too far go back half as far, before they stay where they are."""


def held_in_place(
    points: NDArray[np.floating],
    noisy: NDArray[np.floating],
    normals: NDArray[np.floating],
    share: float,
    surface: SurfaceMesh,
    blocks: Blocks,
) -> NDArray[np.floating]:
    """Return positions with a share of their motion within the surface taken back.

    Low-passes, and averages of any kind, even out triangles: on irregular meshes vertices slide within the
    surface by several times the noise, away from where they were measured. Where they sit says nothing about
    the shape, so that to take it back costs nothing but the noise that there is within the surface. Where
    that would fold triangles, or make slivers of them, vertices go back less far.

    Parameters
    ----------
    points, noisy : ndarray, shape (3, N)
        Positions after and before.
    normals : ndarray, shape (3, N)
        Unit normals of the surface afterwards at the vertices; vertices with zeros may go all the way back.
    share : float
        From 0 to 1.
    surface : SurfaceMesh
        The mesh, for its faces.
    blocks : Blocks
        Threads to work on.

    Returns
    -------
    ndarray, shape (3, N)
    """
    motion = points - noisy
    within = motion - normals * np.einsum("cn,cn->n", normals, motion)
    shares = np.full(points.shape[1], share, points.dtype)
    before = normals_of(points, surface, blocks)
    least_cosine = np.cos(np.radians(LARGEST_TURN))
    face_of_corner = np.repeat(np.arange(surface.n_faces), surface.face_sizes())
    n_rounds = 0
    while True:
        held = points - shares * within
        cosines = np.einsum("cf,cf->f", before, normals_of(held, surface, blocks))
        # Faces without an area have no normal to turn, before or after.
        turns = (cosines < least_cosine) & before.any(axis=0)
        if not turns.any():
            return held
        turned = surface.corner_vertex[turns[face_of_corner]]
        if not shares[turned].any():
            return held  # by rounding only: a face whose vertices all stay does not turn
        # Vertices that stay may turn faces whose others go back: this takes as many rounds as it needs.
        shares[turned] *= 0.5 if n_rounds < HALVINGS else 0.0
        n_rounds += 1
