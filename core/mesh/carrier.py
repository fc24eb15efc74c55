# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The mesh whose vertices move, and how the mesh that was worked on lies over it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from .connectivity import Connectivity
from .surface_mesh import SurfaceMesh


@dataclass(frozen=True, eq=False)
class Carrier:
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
        """Return the positions of `surface` after a displacement of `topology`.

        Parameters
        ----------
        displacement : ndarray, shape (3, n)
            For each vertex of `topology`, in scene units.
        blocks : Blocks, optional
            Threads to work on.

        Returns
        -------
        ndarray, shape (N, 3)
            In the dtype of the surface. Coordinates that are not displaced keep their bits, the sign of a
            zero included.
        """
        vertices = self.surface.vertices
        result = np.empty_like(vertices)

        def kernel(start: int, stop: int) -> None:
            part = slice(start, stop)
            step = displacement[:, part] if self.vertex is None else displacement[:, self.vertex[part]]
            moved = (vertices[part] + step.T).astype(vertices.dtype)
            result[part] = np.where(step.T != 0, moved, vertices[part])

        (blocks or Blocks(1)).run(kernel, len(vertices))
        return result
