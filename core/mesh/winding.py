# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces that walk around their corners in the same direction as their neighbors.

Normals, folds and the order of one-rings are told by the direction in which faces are wound. Programs write
meshes in which some faces are turned over; on these all three would point anywhere.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .half_edges import HalfEdges, find_half_edges
from .surface_mesh import SurfaceMesh


class Wound(NamedTuple):
    """A mesh whose faces agree, as far as they can, and how it came about.

    Attributes
    ----------
    surface : SurfaceMesh
        The mesh with some faces reversed; each begins at the corner at which it began.
    is_reversed : ndarray, shape (F,), bool
        Those faces.
    corner : ndarray, shape (C,), int32
        The corner of the given mesh that each corner is.
    side : ndarray, shape (C,), int32
        The corner of the given mesh whose edge is that of each corner.
    """

    surface: SurfaceMesh
    is_reversed: NDArray[np.bool_]
    corner: NDArray[np.int32]
    side: NDArray[np.int32]


def wound_alike(surface: SurfaceMesh, half_edges: HalfEdges | None = None) -> Wound | None:
    """Reverse faces so that neighbors run along their common edge in opposite directions.

    In each part that hangs together by edges with two faces, most faces stay as they are. On a surface of one
    side, as a Moebius strip, some neighbors disagree whatever is done; there all faces stay if not fewer
    would.

    Parameters
    ----------
    surface : SurfaceMesh
        Any polygon mesh; not modified.
    half_edges : HalfEdges, optional
        Those of the mesh, if they are known.

    Returns
    -------
    Wound or None
        None if no face has to be reversed.

    Examples
    --------
    >>> mesh = SurfaceMesh.from_faces(np.eye(5, 3), [[0, 1, 2], [1, 2, 3], [2, 4, 3]])
    >>> wound_alike(mesh).surface.corner_vertex.reshape(-1, 3).tolist()
    [[0, 2, 1], [1, 2, 3], [2, 4, 3]]
    """
    half_edges = half_edges or find_half_edges(surface)
    if not len(half_edges.inconsistent):
        return None
    is_reversed = _reversed_faces(surface, half_edges)
    return _reversed(surface, is_reversed) if is_reversed.any() else None


def with_reversed(surface: SurfaceMesh, faces: NDArray[np.integer]) -> SurfaceMesh:
    """Return a mesh with some faces reversed; each begins at the corner at which it began."""
    is_reversed = np.zeros(surface.n_faces, bool)
    is_reversed[faces] = True
    return _reversed(surface, is_reversed).surface


def _reversed(surface: SurfaceMesh, is_reversed: NDArray[np.bool_]) -> Wound:
    """Reverse some faces of a mesh."""
    sizes = surface.face_sizes()
    begin = np.repeat(surface.face_offset[:-1], sizes)
    place = np.arange(surface.n_corners, dtype=np.int32)
    size, turns = np.repeat(sizes, sizes), np.repeat(is_reversed, sizes)
    inside = place - begin
    corner = np.where(turns, begin + (size - inside) % size, place).astype(np.int32)
    side = np.where(turns, begin + size - 1 - inside, place).astype(np.int32)
    wound = SurfaceMesh.trusted(
        vertices=surface.vertices,
        corner_vertex=surface.corner_vertex[corner],
        corner_edge=surface.corner_edge[side],
        face_offset=surface.face_offset,
        edges=surface.edges,
    )
    return Wound(wound, is_reversed, corner, side)


def _reversed_faces(surface: SurfaceMesh, half_edges: HalfEdges) -> NDArray[np.bool_]:
    """Return which faces have to be reversed, shape (F,), bool: the fewer ones of each part.

    Faces are joined to parts as in `connected_components`. With the label of a face goes whether it has to be
    reversed if the face that the label names stays.
    """
    corner = np.flatnonzero(half_edges.partner > np.arange(surface.n_corners))
    face = surface.face_of_corner()
    pairs = face[corner], face[half_edges.partner[corner]], half_edges.is_inconsistent[corner]
    first, second, differs = pairs
    label = np.arange(surface.n_faces)
    turned = np.zeros(surface.n_faces, bool)
    while True:
        one, two = label[first], label[second]
        apart = np.flatnonzero(one != two)
        if not len(apart):
            break
        first, second, differs = first[apart], second[apart], differs[apart]
        low, high = np.minimum(one[apart], two[apart]), np.maximum(one[apart], two[apart])
        chosen = np.full(surface.n_faces, -1)
        falling = np.argsort(-low, kind="stable")
        chosen[high[falling]] = falling  # of those that ask for the same label the lowest one, which is last
        chosen = chosen[chosen >= 0]
        label[high[chosen]] = low[chosen]
        turned[high[chosen]] = (turned[first] ^ turned[second] ^ differs)[chosen]
        while True:
            above = label[label]
            if np.array_equal(above, label):
                break
            turned ^= turned[label]
            label = above
    n_faces = np.bincount(label, minlength=surface.n_faces)
    n_turned = np.bincount(label, turned, surface.n_faces)
    turned ^= (2 * n_turned > n_faces)[label]
    first, second, before = pairs
    after = before ^ turned[first] ^ turned[second]
    n_before, n_after = (np.bincount(label[first], count, surface.n_faces) for count in (before, after))
    return turned & (n_after < n_before)[label]
