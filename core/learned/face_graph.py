# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces as the nodes of a graph: which faces are pairs across an edge, for any mixture of polygons."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..mesh.connectivity import Connectivity
from ..mesh.ragged import stretches
from ..mesh.surface_mesh import SurfaceMesh

FEWEST_AT_ONCE, FACES_AT_ONCE = 4096, 16384
"""Faces or pairs in a block of small and of large meshes. What a kernel holds of few stays in the cache; with
many, threads wait less often for one another's turn in the interpreter."""


class Polygons(NamedTuple):
    """Faces with K corners each, which stand together.

    Attributes
    ----------
    begin, end : int
        They are the faces `begin` to `end` of the graph.
    corners : ndarray, shape (K, n), int32
        Their vertices.
    neighbors : ndarray, shape (K, n), int32
        The faces across their edges; the face itself where there is none.
    pairs : ndarray, shape (K, n), int32
        The pairs that these edges make; the last pair, which has no faces, where there is none.
    """

    begin: int
    end: int
    corners: NDArray[np.int32]
    neighbors: NDArray[np.int32]
    pairs: NDArray[np.int32]


class FaceGraph:
    """Pairs of faces across edges. Faces are numbered by their number of corners, then as in the mesh.

    Edges with one face, with more than two, and edges between a face and itself make no pair. Faces with
    fewer than three corners are left out.

    Parameters
    ----------
    surface : SurfaceMesh
        The mesh, for its faces.
    connectivity : Connectivity
        Its neighborhoods.
    faces_at_once : int, optional
        Faces or pairs in a block, at most `FACES_AT_ONCE`; by default about a 16th of the mesh.

    Attributes
    ----------
    order : ndarray, shape (F,), int32, or None
        The face of the mesh that each face of the graph is; None if they are numbered alike.
    groups : list of Polygons
        All faces, by their number of corners.
    first, second : ndarray, shape (P + 1,), int32
        The faces of each pair, first < second; the last pair is face 0 with itself.
    """

    def __init__(
        self,
        surface: SurfaceMesh,
        connectivity: Connectivity,
        blocks: Blocks,
        faces_at_once: int = 0,
    ) -> None:
        self.blocks = blocks.with_block_size(
            min(faces_at_once or _faces_at_once(surface.n_faces), FACES_AT_ONCE, blocks.block_size)
        )
        size = surface.common_face_size()
        offset, corner_vertex, corner_edge = surface.face_offset, surface.corner_vertex, surface.corner_edge
        across = connectivity.face_across
        self.order: NDArray[np.integer] | None = None
        if size >= 3:
            sizes = np.array([size])
            counts = np.array([surface.n_faces])
        else:
            all_sizes = surface.face_sizes()
            order = np.argsort(all_sizes, kind="stable")
            order = order[all_sizes[order] >= 3].astype(np.int32)
            number = np.full(surface.n_faces, -1, np.int32)
            number[order] = np.arange(len(order), dtype=np.int32)
            self.order = order
            ordered = all_sizes[order]
            corner = stretches(offset[order], ordered)
            corner_vertex, corner_edge, across = corner_vertex[corner], corner_edge[corner], across[corner]
            across = np.where(across >= 0, number[across], np.int32(-1))
            sizes, counts = np.unique(ordered, return_counts=True)
        own = np.repeat(np.arange(counts.sum(), dtype=np.int32), np.repeat(sizes, counts))
        is_first = across > own
        chosen = np.flatnonzero(is_first)
        self.n_faces, self.n_pairs = int(counts.sum()), len(chosen)
        of_edge = np.full(surface.n_edges, self.n_pairs, np.int32)
        of_edge[corner_edge[chosen]] = np.arange(self.n_pairs, dtype=np.int32)
        pair = of_edge[corner_edge]
        is_alone = (across < 0) | (across == own)
        pair[is_alone] = self.n_pairs
        neighbor = np.where(is_alone, own, across)
        self.first = np.append(own[chosen], np.int32(0)).astype(np.int32)
        self.second = np.append(across[chosen], np.int32(0)).astype(np.int32)
        self.groups: list[Polygons] = []
        begin = corner_begin = 0
        for n_corners, count in zip(sizes.tolist(), counts.tolist(), strict=True):
            part = slice(corner_begin, corner_begin + n_corners * count)
            tables = (
                np.ascontiguousarray(values[part].reshape(count, n_corners).T)
                for values in (corner_vertex, neighbor, pair)
            )
            self.groups.append(Polygons(begin, begin + count, *tables))
            begin, corner_begin = begin + count, part.stop

    def for_faces(self, kernel: Callable[[slice, Polygons], None]) -> None:
        """Call `kernel(faces, polygons)` on threads, for blocks of faces with as many corners."""
        at_once = self.blocks.block_size
        parts = [
            (slice(start, min(start + at_once, group.end)), group)
            for group in self.groups
            for start in range(group.begin, group.end, at_once)
        ]

        def run(start: int, _: int) -> None:
            faces, group = parts[start]
            own = slice(faces.start - group.begin, faces.stop - group.begin)
            kernel(
                faces,
                Polygons(
                    faces.start,
                    faces.stop,
                    group.corners[:, own],
                    group.neighbors[:, own],
                    group.pairs[:, own],
                ),
            )

        self.blocks.with_block_size(1).run(run, len(parts))

    def for_pairs(self, kernel: Callable[[int, int], None]) -> None:
        """Call `kernel(start, stop)` on threads, for blocks of pairs, without the last."""
        self.blocks.run(kernel, self.n_pairs)

    def in_graph_order(self, field: NDArray[Any]) -> NDArray[Any]:
        """Return a field of the mesh's faces, last axis F, for the faces of the graph."""
        return field if self.order is None else field[..., self.order]


def _faces_at_once(n_faces: int) -> int:
    """Return the size of a block by the size of the mesh alone, so that threads never change a bit."""
    sixteenth = 2 ** max(n_faces // 16, 1).bit_length() // 2
    return min(max(sixteenth, FEWEST_AT_ONCE), FACES_AT_ONCE)
