# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Connected parts of a surface."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..mesh.linking import linked_groups
from .face_graph import FaceGraph

LEAST_ISLAND = 500
"""Islands with fewer faces are taken together: alone they say too little."""


def find_islands(graph: FaceGraph) -> NDArray[np.int32] | None:
    """Return the number of the connected part of each face, shape (F,), int32; None if there is only one.

    Parts are connected across edges and are numbered by their lowest faces.
    """
    label = linked_groups(graph.n_faces, graph.first[:-1], graph.second[:-1])
    roots, island = np.unique(label, return_inverse=True)
    return island.reshape(-1).astype(np.int32) if len(roots) > 1 else None


def faces_of_islands(island: NDArray[np.int32]) -> list[NDArray[np.intp]]:
    """Return the faces of each island that is large enough, and those of all others together.

    `island`, shape (F,), is the number of the island of each face.
    """
    sizes = np.bincount(island)
    number = np.where(sizes >= LEAST_ISLAND, np.arange(len(sizes)), -1)[island]
    by_island = np.argsort(number, kind="stable")
    parts = np.split(by_island, np.flatnonzero(np.diff(number[by_island])) + 1)
    return [part for part in parts if len(part)]
