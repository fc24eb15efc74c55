# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The mesh whose vertices move, and how the mesh that was worked on lies over it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from .connectivity import Connectivity
from .normalization import displaced
from .surface_mesh import SurfaceMesh


@dataclass(frozen=True, eq=False)
class WeldedMesh:
    """Two meshes that lie over each other: the one that moves, and the one that was worked on.

    Attributes
    ----------
    surface : SurfaceMesh
        The mesh whose vertices move.
    topology : SurfaceMesh
        The mesh that was worked on: the same one, or the same one with its vertices welded.
    connectivity : Connectivity
        The neighborhoods of `topology`.
    edge : float
        Mean edge length of `topology`.
    vertex : ndarray, shape (N,), int, or None
        Vertex of `topology` that each vertex of `surface` goes with; None if they are the same.
    face : ndarray, shape (F,), int, or None
        Face of `surface` that each face of `topology` is; None if they are the same.
    """

    surface: SurfaceMesh
    topology: SurfaceMesh
    connectivity: Connectivity
    edge: float
    vertex: NDArray[np.integer] | None = None
    face: NDArray[np.integer] | None = None

    def moved(self, displacement: NDArray[np.float64], blocks: Blocks | None = None) -> NDArray[np.floating]:
        """Return the positions of `surface`, shape (N, 3), after a displacement of `topology`, (3, n)."""
        return displaced(self.surface.vertices, displacement, self.vertex, blocks)
