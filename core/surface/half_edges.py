# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Half-edges of a polygon mesh: which corner lies across an edge.

Corner c of a face is also the half-edge from its vertex to the vertex of the next corner.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .surface_mesh import SurfaceMesh


@dataclass(frozen=True, eq=False)
class HalfEdges:
    """Half-edges and their partners.

    Attributes
    ----------
    next_corner, previous_corner : ndarray, shape (C,), int32
        Neighboring corners within the face.
    partner : ndarray, shape (C,), int32
        The other half-edge of an edge with exactly two faces, whatever its direction; -1 elsewhere.
    is_twisted : ndarray, shape (C,), bool
        True if the partner runs in the same direction, so that the two faces disagree in orientation.
    edge_face_count : ndarray, shape (E,), int32
        Number of faces at each edge; 0 for loose edges.
    """

    next_corner: NDArray[np.int32]
    previous_corner: NDArray[np.int32]
    partner: NDArray[np.int32]
    is_twisted: NDArray[np.bool_]
    edge_face_count: NDArray[np.int32]


def find_half_edges(surface: SurfaceMesh) -> HalfEdges:
    """Pair the half-edges of a mesh.

    Two scatters do it without sorting: of the corners that name an edge, one scatter leaves the last and one,
    in reverse order, the first; each is the other's partner.

    Returns
    -------
    HalfEdges
    """
    n_corners = surface.n_corners
    edge = surface.corner_edge
    count = np.bincount(edge, minlength=surface.n_edges).astype(np.int32)
    corner = np.arange(n_corners, dtype=np.int32)
    last = np.zeros(surface.n_edges, np.int32)
    first = np.zeros(surface.n_edges, np.int32)
    last[edge] = corner
    first[edge[::-1]] = corner[::-1]
    partner = (first + last)[edge] - corner
    partner[count[edge] != 2] = -1
    following = surface.next_corner()
    vertex = surface.corner_vertex
    is_twisted = (partner >= 0) & (vertex[partner] == vertex)
    # A face that names a vertex twice in a row has an edge from a vertex to itself: no partner can be told.
    loops = vertex[following] == vertex
    if loops.any():
        partner[loops] = -1
        is_twisted[loops] = False
    return HalfEdges(following, surface.previous_corner(), partner, is_twisted, count)
