# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where noise is measured: where vertices may move, so that the rest of a mesh says nothing about it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .face_graph import FaceGraph, Polygons
from .islands import LEAST_ISLAND, faces_of_islands


class Measured(NamedTuple):
    """Where noise is measured.

    Attributes
    ----------
    movable : ndarray, shape (N,), bool
        Vertices that may move.
    vertices : ndarray, shape (N,), bool
        These, and those around them where they are few.
    faces : ndarray, shape (F,), bool
        Faces of the graph with such a vertex.
    """

    movable: NDArray[np.bool_]
    vertices: NDArray[np.bool_]
    faces: NDArray[np.bool_]

    def of(self, part: slice | NDArray[np.intp]) -> slice | NDArray[np.intp]:
        """Return those of some faces, shape (n,), that count; all of them where none of them does."""
        chosen = np.arange(len(self.faces))[part]
        chosen = chosen[self.faces[chosen]]
        return chosen if len(chosen) else part


def find_measured(
    movable: NDArray[np.bool_], graph: FaceGraph, island: NDArray[np.intp] | None
) -> Measured | None:
    """Return where noise is measured; None for everywhere.

    Parameters
    ----------
    movable : ndarray, shape (N,), bool
        Vertices that may move.
    graph : FaceGraph
        Faces.
    island : ndarray, shape (F,), intp, or None
        The island of each face, see `find_islands`; None if there is one.

    Returns
    -------
    Measured or None
        Where vertices of an island may move, at least as many of its faces as say something, `LEAST_ISLAND`,
        or all.
    """
    number = np.zeros(graph.n_faces, np.intp) if island is None else island
    enough = np.minimum(np.bincount(number), LEAST_ISLAND)
    vertices, counted = movable.copy(), 0
    while True:
        faces = np.zeros(graph.n_faces, bool)
        for group in graph.groups:
            faces[group.begin : group.end] = vertices[group.corners].any(axis=0)
        n_counted = np.bincount(number[faces], minlength=len(enough))
        is_short = (n_counted > 0) & (n_counted < enough)
        if not is_short.any() or n_counted.sum() == counted:
            return Measured(movable, vertices, faces) if faces.any() else None
        counted = n_counted.sum()
        grows = faces & is_short[number]
        for group in graph.groups:
            vertices[group.corners[:, grows[group.begin : group.end]]] = True


def counted_faces(
    island: NDArray[np.intp] | None, measured: Measured | None
) -> list[slice | NDArray[np.intp]]:
    """Return which faces of each island say something about its noise; all of them without `measured`."""
    parts: list[slice | NDArray[np.intp]] = [slice(None)]
    if island is not None:
        parts = [*faces_of_islands(island)]
    return parts if measured is None else [measured.of(part) for part in parts]


def at_faces(fields: NDArray[np.float32], graph: FaceGraph) -> NDArray[np.float32]:
    """Return means over the corners of faces, shape (n, F), of fields at vertices, shape (n, N)."""
    means = np.empty((len(fields), graph.n_faces), np.float32)

    def collect(faces: slice, polygons: Polygons) -> None:
        means[:, faces] = fields.take(polygons.corners, axis=1).mean(axis=1)

    graph.for_faces(collect)
    return means


def ramp(values: NDArray[np.float64], middle: float, unsure: float) -> NDArray[np.float32]:
    """Return 0 well below the middle, 1 well above, and what lies between."""
    return np.clip((values - middle) / (2 * unsure) + 0.5, 0, 1).astype(np.float32)
