# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Who is whose neighbor: ordered one-rings, boundaries, defects, and faces around faces."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..errors import MeshError
from ..value_checks import check_kind
from .half_edges import HalfEdges, find_half_edges, last_corners
from .ragged import stretches
from .ring_filling import Rings, fill_rings
from .surface_mesh import SurfaceMesh
from .winding import Wound, wound_alike


@dataclass(frozen=True, eq=False)
class Connectivity:
    """The neighborhoods of a polygon mesh; depends on its topology alone.

    Attributes
    ----------
    ring_offset : ndarray, shape (N + 1,), int64
        The one-ring of vertex k is `ring[ring_offset[k]:ring_offset[k + 1]]`.
    ring : ndarray, shape (R,), int32
        Edge neighbors, in face orientation (counterclockwise seen from outside); where faces disagree about
        it, in that of most of them, see `winding`. A closed ring starts at its lowest-numbered vertex, an
        open one at the boundary. At non-manifold vertices: ascending, no order.
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
    disagreeing : ndarray, shape (t,), intp
        Corners whose edge two faces walk along in the same direction.
    is_one_sided : bool
        Whether some do so however faces are turned over, as on a Moebius strip.
    has_quads, has_triangle_pairs : bool
        Whether there is a quad, and whether two triangles share an edge.
    labels : ndarray, shape (N,), int32, or None
        Numbers that tell equals apart in place of the vertices' own; "lowest-numbered" goes by them.
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
    disagreeing: NDArray[np.intp]
    is_one_sided: bool
    has_quads: bool
    has_triangle_pairs: bool
    labels: NDArray[np.int32] | None = None

    @property
    def n_vertices(self) -> int:
        """Number of vertices."""
        return len(self.valence)

    @property
    def is_oriented(self) -> bool:
        """Whether no two faces disagree about the direction of a common edge."""
        return not len(self.disagreeing)

    @property
    def is_closed(self) -> bool:
        """True if the surface is oriented, manifold and without a border, so that it encloses a volume."""
        if not self.is_oriented or self.is_non_manifold.any():
            return False
        n_pairs = np.count_nonzero(self.edge_face_count == 2)
        return bool(0 < n_pairs == np.count_nonzero(self.edge_face_count))

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

    def ring_of(self, vertex: int) -> NDArray[np.int32]:
        """Return the one-ring of a vertex."""
        return self.ring[self.ring_offset[vertex] : self.ring_offset[vertex + 1]]


def connect(
    surface: SurfaceMesh, blocks: Blocks | None = None, labels: NDArray[np.int32] | None = None
) -> Connectivity:
    """Find the neighborhoods of a mesh.

    Parameters
    ----------
    surface : SurfaceMesh
        Any polygon mesh; not modified. Positions are not looked at.
    labels : ndarray, shape (N,), int32, optional
        Different numbers of the vertices by which equals are told apart, instead of their own numbers: those
        of a mesh before it was renumbered.
    """
    blocks = blocks or Blocks(1)
    half_edges = find_half_edges(surface, blocks)
    wound = wound_alike(surface, half_edges)
    if wound is None:
        return _connected(surface, half_edges, blocks, labels)
    found = _connected(wound.surface, find_half_edges(wound.surface, blocks), blocks, labels)
    return _as_given(found, wound, half_edges)


def connect_agreeing(
    surface: SurfaceMesh, blocks: Blocks | None = None, labels: NDArray[np.int32] | None = None
) -> tuple[SurfaceMesh, Connectivity, NDArray[np.bool_] | None]:
    """Turn faces back where they disagree about their orientation, and find the neighborhoods then.

    Returns
    -------
    SurfaceMesh
        The mesh, with reversed faces where `wound_alike` says so.
    Connectivity
        Its neighborhoods.
    ndarray, shape (F,), bool, or None
        Which faces are reversed; None for none.
    """
    blocks = blocks or Blocks(1)
    half_edges, is_reversed = find_half_edges(surface, blocks), None
    wound = wound_alike(surface, half_edges)
    if wound is not None:
        surface, is_reversed = wound.surface, wound.is_reversed
        half_edges = find_half_edges(surface, blocks)
    return surface, _connected(surface, half_edges, blocks, labels), is_reversed


def _connected(
    surface: SurfaceMesh, half_edges: HalfEdges, blocks: Blocks, labels: NDArray[np.int32] | None
) -> Connectivity:
    """Find the neighborhoods of a mesh whose faces agree as far as they can."""
    n_vertices = surface.n_vertices
    corner_vertex = surface.corner_vertex
    count, edges = half_edges.edge_face_count, surface.edges
    n_corners, some_corner = blocks.together(
        lambda: _counted(corner_vertex, n_vertices), lambda: last_corners(corner_vertex, n_vertices)
    )
    # Only edges that do not lie between two faces have to be looked at one by one, and those are few.
    odd = blocks.indices(lambda start, stop: count[start:stop] != 2, len(edges))
    loops = blocks.indices(lambda start, stop: edges[start:stop, 0] == edges[start:stop, 1], len(edges))
    loops = loops[count[loops] > 0]
    valence = _valences(edges, count, odd, loops, n_corners)

    is_boundary = _marked(n_vertices, edges[odd[count[odd] == 1]])
    non_manifold = _marked(n_vertices, edges[odd[count[odd] > 2]])
    non_manifold[edges[loops]] = True
    is_inconsistent = _marked(n_vertices, corner_vertex[half_edges.inconsistent])
    is_inconsistent[half_edges.target[half_edges.inconsistent]] = True

    ring_offset = np.zeros(n_vertices + 1, np.int64)
    np.cumsum(valence, out=ring_offset[1:])
    rings = Rings(
        ring_offset,
        np.empty(ring_offset[-1], np.int32),
        np.empty(ring_offset[-1], np.int32),
        np.empty((n_vertices, 2), np.int32),
    )
    fill_rings(
        rings, surface, half_edges, n_corners, some_corner, non_manifold, is_inconsistent, labels, blocks
    )
    if non_manifold.any():
        is_real = count > 0
        is_real[loops] = False
        _fill_unordered(edges[is_real], non_manifold, rings, labels)

    size = surface.common_face_size()
    has_face = n_corners > 0
    if size:
        face_across = half_edges.partner  # which nothing needs any more

        def divide(start: int, stop: int) -> bool:
            part = face_across[start:stop]
            part //= np.int32(size)  # the floor of -1 is -1
            return bool((part >= 0).any())

        has_pairs = any(blocks.run(divide, surface.n_corners))
        all_triangles, all_quads = has_face & (size == 3), has_face & (size == 4)
        has_triangle_pairs = size == 3 and has_pairs
        has_quads = size == 4
    else:
        sizes = surface.face_sizes()
        face_of_corner = surface.face_of_corner()
        face_across = np.where(half_edges.partner >= 0, face_of_corner[half_edges.partner], np.int32(-1))
        size_of_corner = sizes[face_of_corner]
        all_triangles = has_face & ~_marked(n_vertices, corner_vertex[size_of_corner != 3])
        all_quads = has_face & ~_marked(n_vertices, corner_vertex[size_of_corner != 4])
        is_pair = (size_of_corner == 3) & (face_across >= 0) & (sizes[face_across] == 3)
        has_triangle_pairs = bool(is_pair.any())
        has_quads = bool((sizes == 4).any())
    return Connectivity(
        ring_offset=ring_offset,
        ring=rings.ring,
        ring_corner=rings.corner,
        valence=valence,
        is_boundary=is_boundary,
        boundary_neighbors=rings.rim,
        is_non_manifold=non_manifold,
        is_loose=~has_face,
        all_triangles=all_triangles,
        all_quads=all_quads,
        edge_face_count=count,
        face_across=face_across,
        disagreeing=half_edges.inconsistent,
        is_one_sided=bool(len(half_edges.inconsistent)),
        has_quads=has_quads,
        has_triangle_pairs=has_triangle_pairs,
        labels=labels,
    )


def _as_given(found: Connectivity, wound: Wound, half_edges: HalfEdges) -> Connectivity:
    """Return the neighborhoods of a mesh, from those of the same mesh with some faces reversed."""
    corner, across = found.ring_corner, np.empty_like(found.face_across)
    across[wound.side] = found.face_across
    corner = np.where(corner >= 0, wound.corner.take(corner, mode="clip"), np.int32(-1))
    return replace(found, ring_corner=corner, face_across=across, disagreeing=half_edges.inconsistent)


def check_connectivity(connectivity: Connectivity | None, surface: SurfaceMesh) -> None:
    """Raise MeshError, in one sentence, if these are no neighborhoods, or those of a mesh with other numbers.

    That the mesh has the same faces is not looked at; that would take as long as to find the neighborhoods.
    """
    check_kind("The connectivity", connectivity, Connectivity, "what `connect` returns", MeshError)
    if connectivity is None:
        return
    known = (connectivity.n_vertices, len(connectivity.face_across), len(connectivity.edge_face_count))
    own = (surface.n_vertices, surface.n_faces and surface.n_corners, surface.n_edges)
    if known != own:
        raise MeshError(
            "The connectivity is of a mesh with {} vertices, {} corners and {} edges, but this one has "
            "{}, {} and {}; connect it again.".format(*known, *own)
        )


def _counted(owner: NDArray[np.int32], n_owners: int) -> NDArray[np.intp]:
    """Return how many entries name each owner, shape (n_owners,)."""
    counts = np.zeros(n_owners, np.intp)
    size = max(2**18, n_owners)  # a part at a time, so that few indices are converted at once
    for start in range(0, len(owner), size):
        counts += np.bincount(owner[start : start + size], minlength=n_owners)
    return counts


def _valences(
    edges: NDArray[np.int32],
    count: NDArray[np.int32],
    odd: NDArray[np.intp],
    loops: NDArray[np.intp],
    n_corners: NDArray[np.intp],
) -> NDArray[np.int32]:
    """Return the number of edges with faces, loops left out, at each vertex.

    Each corner lies between two half-edges of its vertex. So where all edges have two faces there are as many
    edges as corners, and only those with another number of faces, `odd`, and `loops` have to be looked at.
    """
    if not len(odd) and not len(loops):
        return n_corners.astype(np.int32)
    half_edges = 2 * n_corners
    plain = odd[(count[odd] > 0) & (edges[odd, 0] != edges[odd, 1])]
    extra = np.repeat(count[plain] - 2, 2)
    half_edges -= np.bincount(edges[plain].ravel(), extra, len(n_corners)).astype(np.intp)
    half_edges -= np.bincount(edges[loops, 0], 2 * count[loops], len(n_corners)).astype(np.intp)
    return (half_edges // 2).astype(np.int32)


def _marked(n: int, indices: NDArray[np.integer]) -> NDArray[np.bool_]:
    """Return a mask of length n that is True at the indices."""
    mask = np.zeros(n, bool)
    mask[indices.ravel()] = True
    return mask


def _fill_unordered(
    edges: NDArray[np.int32],
    non_manifold: NDArray[np.bool_],
    rings: Rings,
    labels: NDArray[np.int32] | None,
) -> None:
    """Give non-manifold vertices their edge neighbors in ascending order."""
    pairs = np.concatenate((edges, edges[:, ::-1]))
    pairs = pairs[non_manifold[pairs[:, 0]]]
    rank = pairs[:, 1] if labels is None else labels[pairs[:, 1]]
    order = np.lexsort((rank, pairs[:, 0]))
    vertices = np.flatnonzero(non_manifold)
    counts = np.diff(rings.offset)[vertices]
    rings.ring[stretches(rings.offset[vertices], counts)] = pairs[order, 1]
