# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The space that solvers work in: around the center of the mesh, in mean edge lengths."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from .connectivity import Connectivity
from .surface_mesh import SurfaceMesh


def normalize(
    surface: SurfaceMesh, connectivity: Connectivity, edge: float, blocks: Blocks | None = None
) -> NDArray[np.float64]:
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
    blocks = blocks or Blocks(1)
    positions = np.empty((surface.n_vertices, 3))
    used = ~connectivity.is_loose

    def bounds(start: int, stop: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        rows = surface.vertices[start:stop].T.astype(np.float64, order="C")
        part = used[start:stop]
        low = rows.min(axis=1, initial=np.inf, where=part)
        return low, rows.max(axis=1, initial=-np.inf, where=part)

    found = blocks.run(bounds, surface.n_vertices)
    low = np.min([part[0] for part in found], axis=0)
    high = np.max([part[1] for part in found], axis=0)
    center = low + 0.5 * (high - low)

    def move(start: int, stop: int) -> None:
        part = positions[start:stop]
        part[:] = surface.vertices[start:stop]
        part[~used[start:stop]] = center
        part -= center
        part /= edge

    blocks.run(move, surface.n_vertices)
    return positions


def displaced(
    vertices: NDArray[np.floating],
    displacement: NDArray[np.float64],
    vertex: NDArray[np.integer] | None = None,
    blocks: Blocks | None = None,
) -> NDArray[np.floating]:
    """Return positions after a displacement.

    Parameters
    ----------
    vertices : ndarray, shape (N, 3)
        Positions in scene units; not modified.
    displacement : ndarray, shape (3, n)
        Displacements in scene units.
    vertex : ndarray, shape (N,), int, optional
        Which displacement each vertex takes; its own by default.

    Returns
    -------
    ndarray, shape (N, 3)
        In the dtype of the vertices. Coordinates that are not displaced keep their bits, the sign of a zero
        included.
    """
    result = np.empty_like(vertices)

    def kernel(start: int, stop: int) -> None:
        part = slice(start, stop)
        step = displacement[:, part] if vertex is None else displacement[:, vertex[part]]
        moved = (vertices[part] + step.T).astype(vertices.dtype)
        result[part] = np.where(step.T != 0, moved, vertices[part])

    (blocks or Blocks(1)).run(kernel, len(vertices))
    return result
