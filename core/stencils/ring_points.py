# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Points of a one-ring at some scale, which stencils are made of.

At level 0 they are the edge neighbors of a vertex and, between two of them, the far vertex of their face. At
level l they are the dilations of these on the 2^l-ring, in the same order (`dilation`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..mesh.connectivity import Connectivity
from ..mesh.half_edges import find_half_edges
from ..mesh.surface_mesh import SurfaceMesh


@dataclass(frozen=True, eq=False)
class RingPoints:
    """Points around each vertex, in the layout of the one-rings of `connectivity`.

    Attributes
    ----------
    connectivity : Connectivity
        The mesh; `ring_offset` and `valence` say which ring points belong to a vertex.
    near : ndarray, shape (R,), int32
        One point for each edge neighbor, in ring order; -1 where none was found.
    far : ndarray, shape (R,), int32, or None
        The point between this edge neighbor and the next one; -1 where there is none. None if a lattice
        needs no far points.
    """

    connectivity: Connectivity
    near: NDArray[np.int32]
    far: NDArray[np.int32] | None = None

    def near_rows(self, vertices: NDArray[np.intp], valence: int) -> NDArray[np.int32]:
        """Return the near ring points of vertices of one valence, shape (valence, n), int32."""
        return self.near[self.connectivity.ring_offset[vertices] + np.arange(valence)[:, None]]

    def far_rows(self, vertices: NDArray[np.intp], valence: int) -> NDArray[np.int32]:
        """Return the far ring points of vertices of one valence, shape (valence, n), int32."""
        assert self.far is not None
        return self.far[self.connectivity.ring_offset[vertices] + np.arange(valence)[:, None]]

    def is_found(self, blocks: Blocks | None = None) -> NDArray[np.bool_]:
        """Return a mask of the vertices that have near ring points, shape (N,), bool.

        A dilated ring is found for all ring points of a vertex or for none. `blocks` are threads to work on.
        """
        offset, valence = self.connectivity.ring_offset, self.connectivity.valence
        found = np.zeros(self.connectivity.n_vertices, bool)

        def kernel(start: int, stop: int) -> None:
            first = self.near.take(offset[start:stop], mode="clip")
            np.logical_and(valence[start:stop] > 0, first >= 0, out=found[start:stop])

        if len(self.near):
            (blocks or Blocks(1)).run(kernel, len(found))
        return found


def one_ring_points(connectivity: Connectivity) -> RingPoints:
    """Return the ring points of level 0 without far ones."""
    return RingPoints(connectivity, connectivity.ring)


def quad_points(surface: SurfaceMesh, connectivity: Connectivity) -> RingPoints:
    """Return the ring points of level 0 with the far corners of quads.

    Of a face with more corners the one half way around is taken; a triangle has none.
    """
    corner = connectivity.ring_corner
    face_of_corner = surface.face_of_corner()
    begin = surface.face_offset[:-1][face_of_corner]
    size = surface.face_sizes()[face_of_corner]
    opposite = begin + (np.arange(surface.n_corners) - begin + size // 2) % np.maximum(size, 1)
    far = np.where(size > 3, surface.corner_vertex[opposite], -1).astype(np.int32)
    return RingPoints(connectivity, connectivity.ring, np.where(corner >= 0, far[corner], np.int32(-1)))


def triangle_points(surface: SurfaceMesh, connectivity: Connectivity) -> RingPoints:
    """Return the ring points of level 0 with the vertices across the ring edges of triangles (Fig. 3)."""
    half_edges = find_half_edges(surface)
    following = half_edges.next_corner
    partner = half_edges.partner[following]  # across the edge opposite to each corner of a triangle
    tip = surface.corner_vertex[half_edges.previous_corner[partner]]
    sizes = np.repeat(surface.face_sizes(), surface.face_sizes())
    is_pair = (partner >= 0) & (sizes == 3) & (sizes[partner] == 3)
    far = np.where(is_pair, tip, np.int32(-1))
    corner = connectivity.ring_corner
    return RingPoints(connectivity, connectivity.ring, np.where(corner >= 0, far[corner], np.int32(-1)))
