# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Half-edges of a polygon mesh: which corner lies across an edge.

Corner c of a face is also the half-edge from its vertex to the vertex of the next corner.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from .surface_mesh import SurfaceMesh


@dataclass(frozen=True, eq=False)
class HalfEdges:
    """Half-edges and their partners.

    Attributes
    ----------
    next_corner, previous_corner : ndarray, shape (C,), int32
        Neighboring corners within the face.
    target : ndarray, shape (C,), int32
        The vertex at the end of each half-edge.
    partner : ndarray, shape (C,), int32
        The other half-edge of an edge with exactly two faces, whatever its direction; -1 elsewhere.
    is_twisted : ndarray, shape (C,), bool
        True if the partner runs in the same direction, so that the two faces disagree in orientation.
    edge_face_count : ndarray, shape (E,), int32
        Number of faces at each edge; 0 for loose edges.
    """

    next_corner: NDArray[np.int32]
    previous_corner: NDArray[np.int32]
    target: NDArray[np.int32]
    partner: NDArray[np.int32]
    is_twisted: NDArray[np.bool_]
    edge_face_count: NDArray[np.int32]


def find_half_edges(surface: SurfaceMesh, blocks: Blocks | None = None) -> HalfEdges:
    """Pair the half-edges of a mesh.

    Sums do it without sorting: of the two corners that name an edge, each is what is left of their sum when
    the other is taken away.

    Parameters
    ----------
    surface : SurfaceMesh
        Any polygon mesh; not modified.
    blocks : Blocks, optional
        Threads to work on.

    Returns
    -------
    HalfEdges
    """
    n_corners = surface.n_corners
    edge, vertex = surface.corner_edge, surface.corner_vertex
    following = surface.next_corner()
    index = edge.astype(np.intp)  # converted once, not by each call
    count = np.bincount(index, minlength=surface.n_edges).astype(np.int32)
    corner = np.arange(n_corners, dtype=np.int32)
    both = np.bincount(index, corner, minlength=surface.n_edges)  # exact in float64
    del index
    both[count != 2] = -1.0
    both = both.astype(np.int64)
    partner = np.empty(n_corners, np.int32)
    target = np.empty(n_corners, np.int32)
    is_twisted = np.empty(n_corners, bool)

    def kernel(start: int, stop: int) -> bool:
        part = slice(start, stop)
        own, sums = corner[part], both.take(edge[part])
        np.subtract(sums, own, out=partner[part], casting="unsafe")
        partner[part][sums < 0] = -1
        np.take(vertex, following[part], out=target[part], mode="clip")
        np.equal(vertex.take(partner[part], mode="clip"), vertex[part], out=is_twisted[part])
        is_twisted[part] &= partner[part] >= 0
        return bool((target[part] == vertex[part]).any())

    if any((blocks or Blocks(1)).run(kernel, n_corners)):
        # A face that names a vertex twice in a row has an edge from it to itself: no partner can be told.
        loops = target == vertex
        partner[loops] = -1
        is_twisted[loops] = False
    return HalfEdges(following, surface.previous_corner(), target, partner, is_twisted, count)
