# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Connected parts of a surface."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .face_graph import FaceGraph

LEAST_ISLAND = 500
"""Islands with fewer faces are taken together: alone they say too little."""


def find_islands(graph: FaceGraph) -> NDArray[np.int32] | None:
    """Return the number of the connected part of each face, shape (F,), int32; None if there is only one.

    Parts are connected across edges and are numbered by their lowest faces. Each face points to a lower one
    of its part; in a round faces point where the face that they point to points, and a part that touches a
    lower one is hooked onto it.
    """
    label = np.arange(graph.n_faces, dtype=np.int32)
    one, two = graph.first[:-1], graph.second[:-1]
    while len(one):
        low, high = label.take(one), label.take(two)
        apart = np.flatnonzero(low != high)
        if not len(apart):
            break
        one, two, low, high = one[apart], two[apart], low[apart], high[apart]
        label[np.maximum(low, high)] = np.minimum(low, high)
        while True:
            above = label.take(label)
            if np.array_equal(above, label):
                break
            label = above
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
