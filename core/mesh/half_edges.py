# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Half-edges of a polygon mesh: which corner lies across an edge.

Corner c of a face is also the half-edge from its vertex to the vertex of the next corner. Nothing is sorted:
all corners write their number to their edge, upwards and downwards, and the two corners of an edge stay.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from .surface_mesh import SurfaceMesh


@dataclass(frozen=True, eq=False)
class HalfEdges:
    """Half-edges and their partners.

    Attributes
    ----------
    surface : SurfaceMesh
        The mesh.
    target : ndarray, shape (C,), int32
        The vertex at the end of each half-edge.
    partner : ndarray, shape (C,), int32
        The other half-edge of an edge with exactly two faces, whatever its direction; -1 elsewhere.
    is_inconsistent : ndarray, shape (C,), bool
        True if the partner runs in the same direction, so that the two faces disagree in orientation.
    edge_face_count : ndarray, shape (E,), int32
        Number of faces at each edge; 0 for loose edges.
    inconsistent : ndarray, shape (t,), intp
        The half-edges for which `is_inconsistent` is true.
    """

    surface: SurfaceMesh
    target: NDArray[np.int32]
    partner: NDArray[np.int32]
    is_inconsistent: NDArray[np.bool_]
    edge_face_count: NDArray[np.int32]
    inconsistent: NDArray[np.intp]

    @cached_property
    def next_corner(self) -> NDArray[np.int32]:
        """The next corner of the face of each corner, shape (C,), int32."""
        return self.surface.next_corner()

    @cached_property
    def previous_corner(self) -> NDArray[np.int32]:
        """The previous corner of the face of each corner, shape (C,), int32."""
        return self.surface.previous_corner()


def find_half_edges(surface: SurfaceMesh, blocks: Blocks | None = None) -> HalfEdges:
    """Pair the half-edges of a mesh.

    Parameters
    ----------
    surface : SurfaceMesh
        Any polygon mesh; not modified.
    """
    blocks = blocks or Blocks(1)
    n_corners = surface.n_corners
    edge, vertex = surface.corner_edge, surface.corner_vertex
    first, last = blocks.together(
        lambda: last_corners(edge, surface.n_edges, is_descending=True),
        lambda: last_corners(edge, surface.n_edges),
    )
    target = shifted(vertex, surface, 1, blocks)
    partner = np.empty(n_corners, np.int32)
    is_inconsistent = np.empty(n_corners, bool)

    def kernel(start: int, stop: int) -> tuple[bool, bool]:
        part, own = slice(start, stop), np.arange(start, stop, dtype=np.int32)
        at, found = edge[part].astype(np.intp), partner[part]
        low, high = first.take(at, mode="clip"), last.take(at, mode="clip")
        has_others = bool(((low != own) & (high != own)).any())
        np.copyto(found, np.where(low == own, high, low))
        found[low == high] = -1
        np.equal(vertex.take(found, mode="clip"), vertex[part], out=is_inconsistent[part])
        is_inconsistent[part] &= found >= 0
        return has_others, bool((target[part] == vertex[part]).any())

    found = blocks.run(kernel, n_corners)
    if any(has_others for has_others, _ in found):
        count = np.bincount(edge, minlength=surface.n_edges).astype(np.int32)
        is_many = count[edge] > 2
        partner[is_many] = -1
        is_inconsistent[is_many] = False
    else:
        count = np.empty(surface.n_edges, np.int32)

        def count_faces(start: int, stop: int) -> None:
            part = slice(start, stop)
            np.add(first[part] >= 0, first[part] != last[part], out=count[part], dtype=np.int32)

        blocks.run(count_faces, surface.n_edges)
    if any(has_loops for _, has_loops in found):
        # A face that names a vertex twice in a row has an edge from it to itself: no partner can be told.
        loops = target == vertex
        partner[loops] = -1
        is_inconsistent[loops] = False
    inconsistent = blocks.indices(lambda start, stop: is_inconsistent[start:stop], n_corners)
    return HalfEdges(surface, target, partner, is_inconsistent, count, inconsistent)


def last_corners(
    owner: NDArray[np.int32], n_owners: int, *, is_descending: bool = False
) -> NDArray[np.int32]:
    """Return the last corner of each owner, or the first one, shape (n_owners,), int32; -1 if there is none.

    `owner`, shape (C,), is what each corner belongs to.
    """
    result = np.full(n_owners, -1, np.int32)
    size = 2**16  # indices are converted in the cache
    starts = range(0, len(owner), size)
    for start in reversed(starts) if is_descending else starts:
        part = owner[start : start + size].astype(np.intp)
        corner = np.arange(start, start + len(part), dtype=np.int32)
        # Of all that is written to one place the last one stays.
        if is_descending:
            result[part[::-1]] = corner[::-1]
        else:
            result[part] = corner
    return result


def shifted(values: NDArray[np.int32], surface: SurfaceMesh, step: int, blocks: Blocks) -> NDArray[np.int32]:
    """Return what is at the next or the previous corner of the face of each corner, shape (C,), int32.

    Parameters
    ----------
    values : ndarray, shape (C,), int32
        A number for each corner.
    surface : SurfaceMesh
        The mesh.
    step : {1, -1}
        Next or previous.
    """
    size = surface.common_face_size()
    if size:
        result = np.empty_like(values)
        source, target = values.reshape(-1, size), result.reshape(-1, size)

        def turn(start: int, stop: int) -> None:
            for place in range(size):
                target[start:stop, place] = source[start:stop, (place + step) % size]

        blocks.run(turn, surface.n_faces)
        return result
    return blocks.take(values, surface.next_corner() if step > 0 else surface.previous_corner())
