# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertices at the same place taken as one, as triangle soups and split seams need."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import RegionError
from .connected_components import connected_components
from .edge_list import find_edges
from .ragged import stretches
from .surface_mesh import SurfaceMesh

MOST_PAIRS = 2**19
"""Pairs of vertices whose distance is looked at together; they take 100 bytes each."""


@dataclass(frozen=True, eq=False)
class Weld:
    """A mesh whose vertices are welded by position.

    Attributes
    ----------
    surface : SurfaceMesh
        The welded mesh. Faces that were left with less than three different vertices are not in it.
    vertex : ndarray, shape (N,), int64
        Vertex of the welded mesh that each vertex of the original is part of.
    face : ndarray, shape (F,), int64
        Face of the original that each face of the welded mesh is, ascending.
    """

    surface: SurfaceMesh
    vertex: NDArray[np.int64]
    face: NDArray[np.int64]

    @property
    def n_merged(self) -> int:
        """Vertices that went up in others."""
        return len(self.vertex) - self.surface.n_vertices

    def least(self, values: NDArray[Any]) -> NDArray[Any]:
        """Return the least value of the vertices that became each welded vertex, shape (n,)."""
        order = np.argsort(self.vertex, kind="stable")
        begin = np.searchsorted(self.vertex[order], np.arange(self.surface.n_vertices))
        return np.minimum.reduceat(values[order], begin)


def make_weld(surface: SurfaceMesh, distance: float, weldable: NDArray[np.bool_] | None = None) -> Weld:
    """Weld the vertices of a mesh by position.

    Parameters
    ----------
    surface : SurfaceMesh
        A mesh with finite positions; not modified.
    distance : float
        Vertices at most so far apart are welded, and whoever is welded to one of them; 0 for the same place.
    weldable : ndarray, shape (N,), bool, optional
        Vertices that may be welded; all by default.

    Returns
    -------
    Weld
        Welded vertices are numbered by the first of each, and lie at the mean of all.

    Raises
    ------
    RegionError
        In one sentence, if no face is left.
    """
    groups = _groups(surface.vertices, distance, weldable)
    n_welded = int(groups.max()) + 1 if len(groups) else 0
    counts = np.bincount(groups, minlength=n_welded)
    first = np.full(n_welded, surface.n_vertices, np.int64)
    np.minimum.at(first, groups, np.arange(surface.n_vertices))
    vertices = surface.vertices[first]
    if distance > 0.0 and n_welded:
        offset = surface.vertices.astype(np.float64) - vertices[groups]
        mean = [np.bincount(groups, offset[:, axis], n_welded) / counts for axis in range(3)]
        vertices = (vertices + np.stack(mean, axis=1)).astype(vertices.dtype)
    faces, kept = _welded_faces(surface, groups)
    if surface.n_faces and not len(kept):
        if not distance:
            raise RegionError("The corners of each face are at the same place, so that there is no surface.")
        raise RegionError(
            f"Welding vertices up to {distance:g} apart leaves no face; take a smaller merge distance."
        )
    is_loose = np.bincount(surface.corner_edge, minlength=surface.n_edges) == 0
    loose = groups[surface.edges[is_loose]]
    loose = loose[loose[:, 0] != loose[:, 1]]
    return Weld(_with_edges(vertices, *faces, loose), groups, kept)


def _groups(
    vertices: NDArray[np.floating], distance: float, weldable: NDArray[np.bool_] | None
) -> NDArray[np.int64]:
    """Return of which welded vertex each vertex becomes a part, shape (N,), numbered by the first ones."""
    if weldable is not None:
        some = np.flatnonzero(weldable)
        own = _groups(vertices[some], distance, None)
        groups = np.arange(len(vertices))
        if len(own) == 0 or own.max() + 1 == len(own):
            return groups
        groups[some] = some[np.unique(own, return_index=True)[1]][own]
        return _first_numbers(groups)
    groups = same_places(vertices)
    if distance > 0.0:
        groups = _first_numbers(_linked(vertices, groups, distance))
    return groups


def same_places(vertices: NDArray[np.floating]) -> NDArray[np.int64]:
    """Return a number for each vertex, shape (N,), the same for vertices at the same place.

    Numbers count from 0 in the order of the first vertex of each place; -0.0 is the same place as 0.0.
    """
    x, y, z = (vertices[:, axis] + 0.0 for axis in range(3))
    order = np.lexsort((z, y, x))
    is_new = np.zeros(len(order), bool)
    for row in (x, y, z):
        is_new[1:] |= row[order[1:]] != row[order[:-1]]
    number = np.empty(len(order), np.int64)
    number[order] = np.cumsum(is_new)
    return _first_numbers(number)


def _first_numbers(number: NDArray[np.integer]) -> NDArray[np.int64]:
    """Return group numbers, shape (N,), changed to the order of the first member of each group."""
    _, first, group = np.unique(number, return_index=True, return_inverse=True)
    rank = np.empty(len(first), np.int64)
    rank[np.argsort(first)] = np.arange(len(first))
    return rank[group.reshape(-1)]


def _linked(vertices: NDArray[np.floating], groups: NDArray[np.int64], distance: float) -> NDArray[np.int32]:
    """Return the group of each vertex, shape (N,), with groups joined that are at most `distance` apart."""
    n = int(groups.max()) + 1 if len(groups) else 0
    points = np.empty((n, 3))
    points[groups] = vertices
    return components_within(points, distance)[groups]


def components_within(
    points: NDArray[np.float64], distance: float, most_pairs: int = MOST_PAIRS
) -> NDArray[np.int32]:
    """Return the component of each point, shape (n,), where points at most `distance` apart are linked.

    The points are sorted into cells as wide as the distance; partners are in the same or an adjacent cell.
    Memory stays small where a distance is so wide that pairs are many: they are looked at some at a time, not
    at all once their points are in one component.
    """
    n = len(points)
    component = np.arange(n, dtype=np.int32)
    if not n:
        return component
    low = points.min(axis=0)
    extent = float((points.max(axis=0) - low).max())
    # Few enough cells that their numbers fit into 63 bits; larger cells only hold more points.
    width = max(distance, extent / 2**20) or 1.0
    cell = np.floor((points - low) / width).astype(np.int64) + 1
    key = (cell[:, 0] * 2**21 + cell[:, 1]) * 2**21 + cell[:, 2]
    order = np.argsort(key, kind="stable")
    sorted_key = key[order]
    found: list[tuple[NDArray[np.intp], NDArray[np.intp]]] = []
    n_found = 0
    for x, y in ((0, 0), (0, 1), (1, -1), (1, 0), (1, 1)):
        # Three cells in a row are one stretch of sorted keys.
        wanted = key + (x * 2**21 + y) * 2**21
        begin = np.searchsorted(sorted_key, wanted - (1 if (x, y) != (0, 0) else 0))
        end = np.searchsorted(sorted_key, wanted + 1, side="right")
        counts = end - begin
        total = np.concatenate(([0], np.cumsum(counts)))
        start = 0
        while start < n:
            stop = max(int(np.searchsorted(total, total[start] + most_pairs, side="right")) - 1, start + 1)
            one = np.repeat(np.arange(start, stop), counts[start:stop])
            other = order[stretches(begin[start:stop], counts[start:stop])]
            start = stop
            is_new = component[one] != component[other]
            one, other = one[is_new], other[is_new]
            step = points[one] - points[other]
            is_close = np.einsum("pi,pi->p", step, step) <= distance * distance
            found.append((one[is_close], other[is_close]))
            n_found += len(found[-1][0])
            if n_found > most_pairs // 4:
                component = _joined_by(component, found)
                found, n_found = [], 0
                if not component.any():
                    return component
    return _joined_by(component, found)


def _joined_by(
    component: NDArray[np.int32], links: list[tuple[NDArray[np.intp], NDArray[np.intp]]]
) -> NDArray[np.int32]:
    """Return components, shape (n,), numbered from 0, that are joined by links of their members."""
    if not links:
        return component
    first, second = (component[np.concatenate(ends)] for ends in zip(*links, strict=True))
    return connected_components(int(component.max()) + 1, first, second)[component]


def _welded_faces(
    surface: SurfaceMesh, groups: NDArray[np.int64]
) -> tuple[tuple[NDArray[np.int64], NDArray[np.int64]], NDArray[np.int64]]:
    """Return corner vertices and sizes of the welded faces, and the faces of the original that they are.

    A face with less than three corners is gone, and so is a quad that was folded to a line: its neighbors on
    both sides then share the edge that it became.
    """
    corner = groups[surface.corner_vertex]
    face_of_corner = surface.face_of_corner()
    stays = corner != corner[surface.next_corner()]  # of equal neighbors the last one stays
    sizes = np.bincount(face_of_corner[stays], minlength=surface.n_faces)
    is_kept = sizes >= 3
    quads = np.flatnonzero(sizes == 4)
    four = corner[stays & (sizes[face_of_corner] == 4)].reshape(-1, 4)
    is_kept[quads[(four[:, 0] == four[:, 2]) | (four[:, 1] == four[:, 3])]] = False
    stays &= is_kept[face_of_corner]
    kept = np.flatnonzero(is_kept)
    return (corner[stays], sizes[kept]), kept


def _with_edges(
    vertices: NDArray[np.floating],
    corner_vertex: NDArray[np.int64],
    sizes: NDArray[np.int64],
    loose_edges: NDArray[np.int64],
) -> SurfaceMesh:
    """Return a mesh from the vertices of all corners and the sizes of the faces."""
    offset = np.concatenate(([0], np.cumsum(sizes))).astype(np.int32)
    corner = corner_vertex.astype(np.int32)
    bare = SurfaceMesh.trusted(vertices, corner, corner, offset, np.zeros((0, 2), np.int32))
    edges, edge = find_edges(corner, corner[bare.next_corner()], loose_edges, len(vertices))
    return SurfaceMesh.trusted(vertices, corner, edge, offset, edges)
