# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Connected parts of a surface."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..mesh.connected_components import connected_components
from .face_graph import FaceGraph

LEAST_ISLAND = 500
"""Islands with fewer faces count as one: alone they say too little."""


def find_islands(graph: FaceGraph, least_faces: int = LEAST_ISLAND) -> NDArray[np.intp] | None:
    """Return the number of the island of each face, shape (F,), from 0 up; None if there is only one.

    Islands are connected across edges and numbered by their lowest faces; all those with fewer than
    `least_faces` are one, the first.
    """
    root = connected_components(graph.n_faces, graph.first[:-1], graph.second[:-1])
    is_small = np.bincount(root, minlength=graph.n_faces)[root] < least_faces
    roots, island = np.unique(np.where(is_small, -1, root), return_inverse=True)
    return island.reshape(-1) if len(roots) > 1 else None


def faces_of_islands(island: NDArray[np.intp]) -> list[NDArray[np.intp]]:
    """Return the faces of each island; `island`, shape (F,), is the number of the island of each face."""
    by_island = np.argsort(island, kind="stable")
    return np.split(by_island, np.flatnonzero(np.diff(island[by_island])) + 1)
