# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Spikes: single vertices or small clusters that are far off their surroundings; and small islands.

All edges from a spike to the surface around it are long. So edges are cut that are many times as long as
those around, and what then hangs together in small pieces beside a large one is a spike.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..errors import RegionError
from ..settings.outliers import SPIKE_LENGTH, SPIKE_VERTICES
from .connected_components import connected_components
from .ragged import starts
from .surface_mesh import SurfaceMesh

ROUNDS = 4
"""Rounds of means that a spike's vertices take for each vertex it may have."""


def find_spikes(
    surface: SurfaceMesh, length: float = SPIKE_LENGTH, most: int = SPIKE_VERTICES
) -> NDArray[np.bool_]:
    """Find the vertices of spikes.

    Parameters
    ----------
    surface : SurfaceMesh
        A mesh; not modified.
    length : float
        How many times as long as those around the edges of a spike are at least.
    most : int
        Vertices that a spike has at most.

    Returns
    -------
    ndarray, shape (N,), bool

    Raises
    ------
    RegionError
        In one sentence, if a number is out of range.

    Examples
    --------
    >>> flat = SurfaceMesh.from_faces(
    ...     [(x, y, 9.0 * (x == y == 3)) for x in range(7) for y in range(7)],
    ...     [(k, k + 7, k + 8, k + 1) for k in range(41) if k % 7 < 6],
    ... )
    >>> np.flatnonzero(find_spikes(flat)).tolist()
    [24]
    """
    if not length > 1.0:
        raise RegionError(f"The length of spikes is {length:g}; it must be larger than 1.")
    if most < 1:
        raise RegionError(f"The largest spike has {most} vertices; allow at least one.")
    n_vertices, edges = surface.n_vertices, surface.edges
    first, second = edges.T
    points = surface.vertices.astype(np.float64)
    lengths = np.linalg.norm(points[second] - points[first], axis=1)
    owner = np.concatenate((first, second))
    own = _medians(owner, np.concatenate((lengths, lengths)), n_vertices)
    # Of a vertex and its neighbors the median, which a spike alone among them does not change.
    everyone = np.arange(n_vertices)
    around = _medians(
        np.concatenate((owner, everyone)), np.concatenate((own[second], own[first], own)), n_vertices
    )
    is_long = lengths > length * np.maximum(around[first], around[second])
    label = connected_components(n_vertices, first[~is_long], second[~is_long])
    size = np.bincount(label, minlength=n_vertices)[label]
    spiked = np.zeros(n_vertices, bool)
    for here, there in ((first, second), (second, first)):
        beside_large = is_long & (size[here] <= most) & (size[there] > most)
        spiked[label[here[beside_large]]] = True
    return spiked[label]


def flattened(surface: SurfaceMesh, spikes: NDArray[np.bool_]) -> NDArray[np.floating]:
    """Return the positions with spikes brought down to the surface around them.

    Parameters
    ----------
    surface : SurfaceMesh
        A mesh; not modified.
    spikes : ndarray, shape (N,), bool
        Vertices to bring down, as from `find_spikes`. Each becomes the mean of its neighbors, those that are
        brought down themselves included.

    Returns
    -------
    ndarray, shape (N, 3)
        In the dtype of the surface; all others keep their bits.

    Examples
    --------
    >>> flat = SurfaceMesh.from_faces(
    ...     [(x, y, 9.0 * (x == y == 3)) for x in range(7) for y in range(7)],
    ...     [(k, k + 7, k + 8, k + 1) for k in range(41) if k % 7 < 6],
    ... )
    >>> flattened(flat, find_spikes(flat))[24].tolist()
    [3.0, 3.0, 0.0]
    """
    first, second = surface.edges.T
    here, there = np.concatenate((first, second)), np.concatenate((second, first))
    wanted = spikes[here]
    here, there = here[wanted], there[wanted]
    rows = np.flatnonzero(spikes)
    row = np.zeros(surface.n_vertices, np.intp)
    row[rows] = np.arange(len(rows))
    count = np.bincount(row[here], minlength=len(rows))
    rows, has_neighbors = rows[count > 0], count > 0
    center = surface.vertices.mean(axis=0, dtype=np.float64)
    points = surface.vertices - center
    # From the surroundings inwards: first those of the ring, so that the height itself is forgotten at once.
    known = ~spikes
    label = connected_components(surface.n_vertices, here[spikes[there]], there[spikes[there]])
    largest = int(np.bincount(label[rows]).max(initial=1))
    for _ in range(ROUNDS * max(largest, SPIKE_VERTICES)):
        counts = known[there].astype(np.float64)
        total = np.bincount(row[here], counts, len(count))[has_neighbors]
        sums = np.stack(
            [
                np.bincount(row[here], counts * points[there, axis], len(count))[has_neighbors]
                for axis in range(3)
            ],
            axis=1,
        )
        ready = total > 0.0
        points[rows[ready]] = sums[ready] / total[ready, None]
        known[rows[ready]] = True
    vertices = surface.vertices.copy()
    moved = rows[known[rows]]
    vertices[moved] = points[moved] + center
    return vertices


def without_spikes(surface: SurfaceMesh, pinned: NDArray[np.integer]) -> SurfaceMesh:
    """Return a mesh with its spikes brought down, except those among `pinned` vertices, shape (p,).

    Examples
    --------
    >>> flat = SurfaceMesh.from_faces(
    ...     [(x, y, 9.0 * (x == y == 3)) for x in range(7) for y in range(7)],
    ...     [(k, k + 7, k + 8, k + 1) for k in range(41) if k % 7 < 6],
    ... )
    >>> [without_spikes(flat, np.array(pinned, int)).vertices.max().item() for pinned in ([], [24])]
    [6.0, 9.0]
    """
    spikes = find_spikes(surface)
    spikes[pinned] = False
    return surface.with_vertices(flattened(surface, spikes))


def small_islands(surface: SurfaceMesh, most: int) -> NDArray[np.bool_]:
    """Find the vertices of connected parts with at most so many vertices; the largest part is none of them.

    Parameters
    ----------
    surface : SurfaceMesh
        A mesh; not modified.
    most : int
        Vertices that an island has at most. Loose vertices are islands of one.

    Returns
    -------
    ndarray, shape (N,), bool

    Examples
    --------
    >>> two = SurfaceMesh.from_faces(np.eye(7, 3), [(0, 1, 2, 3), (4, 5, 6)])
    >>> np.flatnonzero(small_islands(two, 3)).tolist()
    [4, 5, 6]
    """
    label = connected_components(surface.n_vertices, *surface.edges.T)
    size = np.bincount(label, minlength=surface.n_vertices)
    is_small = size <= most
    if surface.n_vertices:
        is_small[np.argmax(size)] = False
    return is_small[label]


def _medians(owner: NDArray[np.integer], values: NDArray[np.float64], n_owners: int) -> NDArray[np.float64]:
    """Return the median, of two in the middle the lower, of the values of each owner; 0 where it has none."""
    order = np.lexsort((values, owner))
    counts = np.bincount(owner, minlength=n_owners)
    begin = starts(counts)
    medians = np.zeros(n_owners)
    some = counts > 0
    medians[some] = values[order][begin[some] + (counts[some] - 1) // 2]
    return medians
