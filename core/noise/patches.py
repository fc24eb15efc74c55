# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Patches: a vertex with the vertices up to two steps around it, for many vertices at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..mesh.connectivity import Connectivity
from ..mesh.distance_rings import edge_adjacency, face_adjacency, sorted_unique
from ..mesh.ragged import Ragged
from ..mesh.surface_mesh import SurfaceMesh

MOST_STEPS = 256
"""A patch does not grow where its next ring would be found over more steps than this."""


def spread_sample(positions: NDArray[np.float64], candidates: NDArray[np.intp], n: int) -> NDArray[np.intp]:
    """Return at most n of the candidates: every k-th by distance from their mean position.

    Order by distance, and not by number, makes the sample independent of the numbering of the vertices and
    of where the mesh is and how it is turned, except for rounding where distances are equal.
    """
    if len(candidates) <= n:
        return candidates
    offset = positions[candidates] - positions[candidates].mean(axis=0)
    order = np.argsort(np.einsum("vi,vi->v", offset, offset), kind="stable")
    return candidates[order[(np.arange(n) * len(candidates)) // n]]


def local_adjacency(surface: SurfaceMesh, connectivity: Connectivity, centers: NDArray[np.intp]) -> Ragged:
    """Return adjacency by a common face, known at the centers and at what is adjacent to them.

    At other vertices of a mesh with larger faces than triangles the lists are empty, which saves most of the
    time of `face_adjacency` on large meshes.
    """
    if surface.n_corners == 3 * surface.n_faces and bool((surface.face_sizes() == 3).all()):
        return edge_adjacency(connectivity)
    near = np.zeros(surface.n_vertices, bool)
    near[centers] = True
    face = surface.face_of_corner()
    for _ in range(2):
        touched = np.zeros(surface.n_faces, bool)
        touched[face[near[surface.corner_vertex]]] = True
        near[surface.corner_vertex[touched[face]]] = True
    return face_adjacency(surface, connectivity, touched)


def find_patches(adjacency: Ragged, centers: NDArray[np.intp]) -> Ragged:
    """Return the patch of each center: itself, then the vertices that are one or two steps away.

    Parameters
    ----------
    adjacency : Ragged
        Who is one step away.
    centers : ndarray, shape (n,), intp
        Vertices in the middle of the patches.
    """
    n_vertices = len(adjacency.offset) - 1
    center = np.arange(len(centers)) * n_vertices + centers
    first = _next_ring(adjacency, center, center, len(centers))
    known = np.concatenate((center, first))
    known.sort()
    second = _next_ring(adjacency, first, known, len(centers))
    keys = np.concatenate((center, first, second))
    order = np.argsort(keys // n_vertices, kind="stable")  # the center stays first
    row, vertex = np.divmod(keys[order], n_vertices)
    return Ragged(np.searchsorted(row, np.arange(len(centers) + 1)), vertex)


def _next_ring(
    adjacency: Ragged, front: NDArray[np.int64], known: NDArray[np.int64], n_patches: int
) -> NDArray[np.int64]:
    """Return the keys, patch times number of vertices plus vertex, that are one step beyond the front."""
    n_vertices = len(adjacency.offset) - 1
    row, vertex = np.divmod(front, n_vertices)
    counts = adjacency.offset[vertex + 1] - adjacency.offset[vertex]
    grows = np.bincount(row, counts, minlength=n_patches)[row] <= MOST_STEPS
    row, vertex, counts = row[grows], vertex[grows], counts[grows]
    reached = adjacency.taken(vertex)[0] + np.repeat(row * n_vertices, counts)
    reached = sorted_unique(reached.astype(np.int64))
    place = np.minimum(np.searchsorted(known, reached), len(known) - 1)
    return reached[known[place] != reached]
