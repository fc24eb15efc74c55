# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Who is whose neighbor: ordered one-rings, boundaries, defects, and faces around faces."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from .half_edges import HalfEdges, find_half_edges
from .rings import Walks, walk
from .surface_mesh import SurfaceMesh


@dataclass(frozen=True, eq=False)
class Connectivity:
    """The neighborhoods of a polygon mesh; depends on its topology alone.

    Attributes
    ----------
    ring_offset : ndarray, shape (N + 1,), int64
        The one-ring of vertex k is `ring[ring_offset[k]:ring_offset[k + 1]]`.
    ring : ndarray, shape (R,), int32
        Edge neighbors, in face orientation (counterclockwise seen from outside). A closed ring starts at its
        lowest-numbered vertex, an open one at the boundary. At non-manifold vertices: ascending, no order.
    ring_corner : ndarray, shape (R,), int32
        The corner (of vertex k) whose face lies between this ring vertex and the next one; -1 behind the
        last vertex of an open ring and at non-manifold vertices.
    valence : ndarray, shape (N,), int32
        Number of edge neighbors, loose edges not counted.
    is_boundary : ndarray, shape (N,), bool
        Vertices at an edge with one face.
    boundary_neighbors : ndarray, shape (N, 2), int32
        First and last ring vertex of manifold boundary vertices, else -1.
    is_non_manifold : ndarray, shape (N,), bool
        Vertices whose faces do not form a single fan.
    is_loose : ndarray, shape (N,), bool
        Vertices without a face.
    all_triangles, all_quads : ndarray, shape (N,), bool
        Vertices with faces of that one kind only.
    edge_face_count : ndarray, shape (E,), int32
        Faces at each edge: 0 loose, 1 boundary, 2 regular, more non-manifold.
    face_across : ndarray, shape (C,), int32
        The face on the other side of each corner's edge; -1 at edges with one face or more than two. The
        faces around face f are `face_across[face_offset[f]:face_offset[f + 1]]`.
    is_oriented : bool
        Whether no two faces disagree about the direction of a common edge.
    has_quads, has_triangle_pairs : bool
        Whether there is a quad, and whether two triangles share an edge.
    """

    ring_offset: NDArray[np.int64]
    ring: NDArray[np.int32]
    ring_corner: NDArray[np.int32]
    valence: NDArray[np.int32]
    is_boundary: NDArray[np.bool_]
    boundary_neighbors: NDArray[np.int32]
    is_non_manifold: NDArray[np.bool_]
    is_loose: NDArray[np.bool_]
    all_triangles: NDArray[np.bool_]
    all_quads: NDArray[np.bool_]
    edge_face_count: NDArray[np.int32]
    face_across: NDArray[np.int32]
    is_oriented: bool
    has_quads: bool
    has_triangle_pairs: bool

    @property
    def n_vertices(self) -> int:
        """Number of vertices."""
        return len(self.valence)

    @property
    def is_closed(self) -> bool:
        """True if the surface is oriented, manifold and without a border, so that it encloses a volume."""
        used = self.edge_face_count > 0
        if not used.any() or not self.is_oriented or self.is_non_manifold.any():
            return False
        return bool((self.edge_face_count[used] == 2).all())

    def is_regular_triangle(self) -> NDArray[np.bool_]:
        """Return which vertices have a closed fan of six triangles, shape (N,), bool."""
        return self.all_triangles & (self.valence == 6) & ~self.is_boundary & ~self.is_non_manifold

    def is_regular_quad(self) -> NDArray[np.bool_]:
        """Return which vertices have a closed fan of four quads, shape (N,), bool."""
        return self.all_quads & (self.valence == 4) & ~self.is_boundary & ~self.is_non_manifold

    def is_irregular(self) -> NDArray[np.bool_]:
        """Return which vertices with faces are regular on neither lattice, shape (N,), bool."""
        return ~self.is_loose & ~self.is_regular_triangle() & ~self.is_regular_quad()

    def loose_edges(self) -> NDArray[np.intp]:
        """Return the indices of edges without a face."""
        return np.flatnonzero(self.edge_face_count == 0)

    def non_manifold_edges(self) -> NDArray[np.intp]:
        """Return the indices of edges with three or more faces."""
        return np.flatnonzero(self.edge_face_count > 2)

    def ring_of(self, vertex: int) -> NDArray[np.int32]:
        """Return the one-ring of a vertex."""
        return self.ring[self.ring_offset[vertex] : self.ring_offset[vertex + 1]]


def connect(surface: SurfaceMesh, blocks: Blocks | None = None) -> Connectivity:
    """Find the neighborhoods of a mesh.

    Parameters
    ----------
    surface : SurfaceMesh
        Any polygon mesh; not modified. Positions are not looked at.
    blocks : Blocks, optional
        Threads to work on.

    Returns
    -------
    Connectivity
    """
    blocks = blocks or Blocks(1)
    half_edges = find_half_edges(surface)
    n_vertices = surface.n_vertices
    corner_vertex = surface.corner_vertex
    count = half_edges.edge_face_count
    edges = surface.edges
    is_loop = edges[:, 0] == edges[:, 1]
    used = (count > 0) & ~is_loop
    valence = np.bincount(edges[used].ravel(), minlength=n_vertices).astype(np.int32)
    n_corners = np.bincount(corner_vertex, minlength=n_vertices)

    is_boundary = _marked(n_vertices, edges[count == 1])
    broken = _marked(n_vertices, edges[(count > 2) | (is_loop & (count > 0))])
    is_twisted = _marked(n_vertices, corner_vertex[half_edges.is_twisted])
    is_twisted |= _marked(n_vertices, corner_vertex[half_edges.next_corner[half_edges.is_twisted]])

    ring_offset = np.concatenate(([0], np.cumsum(valence, dtype=np.int64)))
    ring = np.empty(ring_offset[-1], np.int32)
    ring_corner = np.full(ring_offset[-1], -1, np.int32)
    boundary_neighbors = np.full((n_vertices, 2), -1, np.int32)
    has_ring = (n_corners > 0) & ~broken
    for fans in (
        _walk_corners(surface, half_edges, has_ring & ~is_twisted, blocks),
        _walk_darts(surface, half_edges, has_ring & is_twisted, blocks),
    ):
        lengths = np.diff(fans.walks.offset)
        is_fan = lengths == n_corners[fans.vertices]
        is_fan &= lengths + fans.walks.is_open == valence[fans.vertices]
        broken[fans.vertices[~is_fan]] = True
        _store(fans, is_fan, ring, ring_corner, ring_offset)
        rim = fans.vertices[is_fan & fans.walks.is_open]
        boundary_neighbors[rim, 0] = ring[ring_offset[rim]]
        boundary_neighbors[rim, 1] = ring[ring_offset[rim + 1] - 1]
    _fill_unordered(edges[used], broken, ring, ring_offset)

    sizes = surface.face_sizes()
    face_of_corner = np.repeat(np.arange(surface.n_faces, dtype=np.int32), sizes)
    face_across = np.where(half_edges.partner >= 0, face_of_corner[half_edges.partner], np.int32(-1))
    size_of_corner = sizes[face_of_corner]
    has_face = n_corners > 0
    return Connectivity(
        ring_offset=ring_offset,
        ring=ring,
        ring_corner=ring_corner,
        valence=valence,
        is_boundary=is_boundary,
        boundary_neighbors=boundary_neighbors,
        is_non_manifold=broken,
        is_loose=~has_face,
        all_triangles=has_face & ~_marked(n_vertices, corner_vertex[size_of_corner != 3]),
        all_quads=has_face & ~_marked(n_vertices, corner_vertex[size_of_corner != 4]),
        edge_face_count=count,
        face_across=face_across,
        is_oriented=not half_edges.is_twisted.any(),
        has_quads=bool((sizes == 4).any()),
        has_triangle_pairs=bool(
            ((size_of_corner == 3) & (face_across >= 0) & (sizes[face_across] == 3)).any()
        ),
    )


def _marked(n: int, indices: NDArray[np.integer]) -> NDArray[np.bool_]:
    """Return a mask of length n that is True at the indices."""
    mask = np.zeros(n, bool)
    mask[indices.ravel()] = True
    return mask


class _Fans(NamedTuple):
    """Walks around vertices, and what the walked items mean."""

    walks: Walks
    vertices: NDArray[np.intp]
    pointed: NDArray[np.int32]
    """The vertex that an item points to."""
    beyond: NDArray[np.int32]
    """The vertex behind an item's face, which ends the ring after the last item of an open walk."""
    items_per_corner: int


def _walk_corners(
    surface: SurfaceMesh, half_edges: HalfEdges, wanted: NDArray[np.bool_], blocks: Blocks
) -> _Fans:
    """Walk around vertices whose faces agree in orientation."""
    vertex = surface.corner_vertex
    pointed, source = vertex[half_edges.next_corner], vertex[half_edges.previous_corner]
    # The partner of the incoming half-edge leaves the same vertex, in the next face counterclockwise.
    following = half_edges.partner[half_edges.previous_corner]
    start = np.full(surface.n_vertices, -1, np.int32)
    start[vertex] = np.arange(surface.n_corners, dtype=np.int32)
    rim = np.flatnonzero(half_edges.partner < 0).astype(np.int32)
    start[vertex[rim]] = rim  # an open fan begins where no face lies on the other side of the outgoing edge
    vertices = np.flatnonzero(wanted)
    return _Fans(walk(following, start[vertices], vertex, pointed, blocks), vertices, pointed, source, 1)


def _walk_darts(
    surface: SurfaceMesh, half_edges: HalfEdges, wanted: NDArray[np.bool_], blocks: Blocks
) -> _Fans:
    """Walk around vertices where neighboring faces disagree in orientation, dart by dart (see `rings`)."""
    vertices = np.flatnonzero(wanted)
    if not len(vertices):
        none = np.zeros(0, np.int32)
        return _Fans(Walks(none, np.zeros(1, np.int64), np.zeros(0, bool)), vertices, none, none, 2)
    vertex = surface.corner_vertex
    n_darts = 2 * surface.n_corners
    half_edge = np.empty(n_darts, np.int32)
    half_edge[0::2] = np.arange(surface.n_corners)
    half_edge[1::2] = half_edges.previous_corner
    owner = np.repeat(vertex, 2)
    pointed = np.empty(n_darts, np.int32)
    pointed[0::2], pointed[1::2] = vertex[half_edges.next_corner], vertex[half_edges.previous_corner]
    partner = half_edges.partner[half_edge]
    leaves = vertex[partner] == owner  # the partner half-edge starts at this vertex, or ends at it
    across = np.where(leaves, 2 * partner, 2 * half_edges.next_corner[partner] + 1)
    across = np.where(partner >= 0, across, -1).astype(np.int32)
    turned = np.arange(n_darts) ^ 1
    following = across[turned]
    start = np.full(surface.n_vertices, -1, np.int32)
    start[owner] = np.arange(n_darts, dtype=np.int32)
    rim = np.flatnonzero(across < 0).astype(np.int32)
    rim = rim[np.argsort(-pointed[rim], kind="stable")]  # the lower-numbered end is written last and wins
    start[owner[rim]] = rim
    return _Fans(
        walk(following, start[vertices], owner, pointed, blocks), vertices, pointed, pointed[turned], 2
    )


def _store(
    fans: _Fans,
    is_fan: NDArray[np.bool_],
    ring: NDArray[np.int32],
    ring_corner: NDArray[np.int32],
    ring_offset: NDArray[np.int64],
) -> None:
    """Copy the walks that are whole fans into the ring arrays."""
    walks, vertices = fans.walks, fans.vertices
    lengths = np.diff(walks.offset)
    place = np.arange(len(walks.items)) + np.repeat(ring_offset[vertices] - walks.offset[:-1], lengths)
    good = np.repeat(is_fan, lengths)
    ring[place[good]] = fans.pointed[walks.items[good]]
    ring_corner[place[good]] = walks.items[good] // fans.items_per_corner
    is_rim = is_fan & walks.is_open
    ring[ring_offset[vertices[is_rim] + 1] - 1] = fans.beyond[walks.items[walks.offset[1:][is_rim] - 1]]


def _fill_unordered(
    edges: NDArray[np.int32],
    broken: NDArray[np.bool_],
    ring: NDArray[np.int32],
    ring_offset: NDArray[np.int64],
) -> None:
    """Give non-manifold vertices their edge neighbors in ascending order."""
    pairs = np.concatenate((edges, edges[:, ::-1]))
    pairs = pairs[broken[pairs[:, 0]]]
    order = np.lexsort((pairs[:, 1], pairs[:, 0]))
    vertices = np.flatnonzero(broken)
    counts = np.diff(ring_offset)[vertices]
    begin = np.repeat(ring_offset[vertices] - (np.cumsum(counts) - counts), counts)
    ring[begin + np.arange(len(begin))] = pairs[order, 1]
