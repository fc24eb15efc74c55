# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Several meshes as one, each moved to its place; nothing is welded."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .surface_mesh import SurfaceMesh


class Placement(NamedTuple):
    """A mesh and where it lies: its vertices v are at `linear @ v + origin`.

    `linear` has shape (3, 3), `origin` (3,), both float64. Where `linear` mirrors, faces are turned over, so
    that what was outside stays outside.
    """

    surface: SurfaceMesh
    linear: NDArray[np.float64]
    origin: NDArray[np.float64]


def joined(placements: Sequence[Placement]) -> SurfaceMesh:
    """Return one mesh of several, with vertices, edges and faces one mesh after the other.

    Parameters
    ----------
    placements : sequence of Placement
        The meshes; not modified.

    Returns
    -------
    SurfaceMesh
        Positions are float64.

    Examples
    --------
    >>> import numpy as np
    >>> from framelet.core import SurfaceMesh
    >>> mesh = SurfaceMesh.from_faces([[1, 0, 0], [2, 0, 0], [1, 1, 0]], [(0, 1, 2)])
    >>> mirror = Placement(mesh, np.diag([-1.0, 1.0, 1.0]), np.zeros(3))
    >>> both = joined([Placement(mesh, np.eye(3), np.zeros(3)), mirror])
    >>> both.corner_vertex.tolist(), both.vertices[3].tolist()
    ([0, 1, 2, 5, 4, 3], [-1.0, 0.0, 0.0])
    """
    vertices, corners, corner_edges, sizes, edges = [], [], [], [], []
    n_vertices = n_edges = 0
    for surface, linear, origin in placements:
        vertices.append(surface.vertices.astype(np.float64) @ linear.T + origin)
        corner: NDArray[np.integer] = surface.corner_vertex
        edge: NDArray[np.integer] = surface.corner_edge
        if np.linalg.det(linear) < 0.0:
            corner, edge = _turned_over(surface)
        corners.append(corner.astype(np.int64) + n_vertices)
        corner_edges.append(edge.astype(np.int64) + n_edges)
        edges.append(surface.edges.astype(np.int64) + n_vertices)
        sizes.append(surface.face_sizes())
        n_vertices += surface.n_vertices
        n_edges += surface.n_edges
    offset = np.concatenate(([0], np.cumsum(np.concatenate(sizes))))
    return SurfaceMesh.trusted(
        np.concatenate(vertices),
        np.concatenate(corners).astype(np.int32),
        np.concatenate(corner_edges).astype(np.int32),
        offset.astype(np.int32),
        np.concatenate(edges).astype(np.int32),
    )


def _turned_over(surface: SurfaceMesh) -> tuple[NDArray[np.integer], NDArray[np.integer]]:
    """Return the vertices and edges of all corners, with each face the other way around."""
    start = np.repeat(surface.face_offset[:-1], surface.face_sizes())
    end = np.repeat(surface.face_offset[1:], surface.face_sizes())
    mirrored = start + end - 1 - np.arange(surface.n_corners)
    # The edge of a corner leads to the next one, which was the one before.
    return surface.corner_vertex[mirrored], surface.corner_edge[surface.previous_corner()[mirrored]]
