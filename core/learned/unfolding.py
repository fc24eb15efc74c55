# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Unfolding faces that lean far from the normals that they should have."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..averages.ring_means import RingMeans
from ..mesh.geometry import fan_areas, row_lengths
from .face_graph import FaceGraph, Polygons

LEAN = 0.5
"""Cosine to its wanted normal below which a face is folded: 60 degrees."""

COLLAPSED = 1e-4
"""Doubled area, in squared lengths of its edges, below which a face is a line."""

ROUNDS = 12


def unfolded_points(
    points: NDArray[np.float32],
    normals: NDArray[np.float32],
    graph: FaceGraph,
    rings: RingMeans,
    is_free: NDArray[np.bool_] | None = None,
    rounds: int = ROUNDS,
) -> NDArray[np.float32] | None:
    """Move the vertices of folded faces half-way to their rings until nothing is folded.

    Parameters
    ----------
    points : ndarray, shape (3, N), float32
        Positions; not modified.
    normals : ndarray, shape (3, F), float32
        Wanted unit normals.
    graph : FaceGraph
        Faces and their corners.
    rings : RingMeans
        Neighbors of vertices.
    is_free : ndarray, shape (N,), bool, optional
        Vertices that may move; all by default.
    rounds : int
        Rounds at most.

    Returns
    -------
    ndarray, shape (3, N), float32, or None
        Positions; None if nothing is folded.
    """
    suspects: list[NDArray[np.intp]] | None = None
    moved: NDArray[np.float32] | None = None
    for _ in range(rounds):
        folded = _folded(points if moved is None else moved, normals, graph, suspects)
        vertices = np.unique(
            np.concatenate(
                [group.corners[:, own].ravel() for group, own in zip(graph.groups, folded, strict=True)]
            )
        )
        if is_free is not None:
            vertices = vertices[is_free[vertices]]
        if not len(vertices):
            break
        if moved is None:
            moved = points.copy()
        goal = rings.mean_at(moved, vertices)
        moved[:, vertices] += np.float32(0.5) * (goal - moved[:, vertices])
        is_moved = np.zeros(points.shape[1], bool)
        is_moved[vertices] = True
        suspects = [np.flatnonzero(is_moved[group.corners].any(axis=0)) for group in graph.groups]
    return moved


def _folded(
    points: NDArray[np.float32],
    normals: NDArray[np.float32],
    graph: FaceGraph,
    suspects: list[NDArray[np.intp]] | None,
) -> list[NDArray[np.intp]]:
    """Return the folded faces of each group, numbered inside it, among all or some."""
    found = []
    for number, group in enumerate(graph.groups):
        chosen = None if suspects is None else suspects[number]

        def is_folded(
            start: int, stop: int, group: Polygons = group, chosen: NDArray[np.intp] | None = chosen
        ) -> NDArray[np.bool_]:
            own = np.arange(start, stop) if chosen is None else chosen[start:stop]
            corners = [points.take(corner[own], axis=1) for corner in group.corners]
            arms = [corner - corners[0] for corner in corners[1:]]
            area = np.stack(fan_areas(arms))
            spans = sum((arm**2).sum(axis=0) for arm in arms)
            along = (area * normals[:, group.begin + own]).sum(axis=0)
            size = np.sqrt((area * area).sum(axis=0))
            # A face that has collapsed to a line leans nowhere.
            return (along < np.float32(LEAN) * size) & (size > COLLAPSED * spans)

        n_items = group.end - group.begin if chosen is None else len(chosen)
        places = graph.blocks.indices(is_folded, n_items)
        found.append(places if chosen is None else chosen[places])
    return found


def doubled_areas(corners: list[NDArray[np.float32]]) -> NDArray[np.float32]:
    """Return twice the areas of faces, shape (n,), from their corners, each of shape (3, n)."""
    return row_lengths(fan_areas([corner - corners[0] for corner in corners[1:]]))
