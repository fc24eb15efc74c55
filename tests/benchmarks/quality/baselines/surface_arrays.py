# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Normals, areas and centroids of faces, and the vertex update, on coordinates in rows."""

from itertools import pairwise

import numpy as np


def squares(vectors):
    """Return the squared lengths, shape (n,), of vectors (3, n)."""
    return vectors[0] * vectors[0] + vectors[1] * vectors[1] + vectors[2] * vectors[2]


def unit(vectors, fallback):
    """Return vectors (3, n) scaled to length one; where there is no direction, the fallback."""
    length = np.sqrt(squares(vectors))
    good = length > np.finfo(vectors.dtype).tiny ** 0.5
    return np.where(good, vectors / np.where(good, length, 1), fallback)


def take(values, index):
    """Return columns of values (3, n)."""
    return np.take(values, index, axis=1)


def centroids_of(points, graph):
    """Return the mean of the corners of each face, shape (3, F)."""
    if graph.table is None:
        sums = graph.corners.reduce(np.add, take(points, graph.corners.items))
        return sums / graph.sizes.astype(points.dtype)
    sums = take(points, graph.table[0])
    for column in graph.table[1:]:
        sums += take(points, column)
    sums *= points.dtype.type(1.0 / len(graph.table))
    return sums


def normals_and_areas(points, graph):
    """Return unit normals (3, F), zero where a face has no area, and areas (F,), by Newell's formula."""
    sizes = graph.sizes
    begin = graph.corners.offset[:-1]
    vectors = np.zeros((3, graph.n_faces), points.dtype)
    for size in np.unique(sizes):
        faces = np.flatnonzero(sizes == size)
        corners = [take(points, graph.corners.items[begin[faces] + k]) for k in range(size)]
        arms = [corner - corners[0] for corner in corners[1:]]
        for first, second in pairwise(arms):
            vectors[:, faces] += _cross(first, second)
    return unit(vectors, np.zeros_like(vectors)), np.sqrt(squares(vectors)) / points.dtype.type(2)


def _cross(first, second):
    (a, b, c), (x, y, z) = first, second
    return np.stack((b * z - c * y, c * x - a * z, a * y - b * x))


def mean_centroid_distance(centroids, graph):
    """Return the mean distance of the centroids of adjacent faces, the unit of the spatial weights."""
    first, second = graph.adjacent
    if not len(first):
        return 1.0
    return float(np.sqrt(squares(take(centroids, first) - take(centroids, second))).mean())


def update_vertices(points, normals, graph, steps):
    """Move vertices until faces fit their normals (Sun, Rosin, Martin and Langbein 2007).

    In each step v <- v + mean over its faces of n_f <n_f, c_f - v>, with the centroids c_f of that step.

    Parameters
    ----------
    points : ndarray, shape (3, N)
        Positions; not modified.
    normals : ndarray, shape (3, F)
        Wanted unit normals.
    graph : FaceGraph
        The faces.
    steps : int
        Number of steps.

    Returns
    -------
    ndarray, shape (3, N)
    """
    used, faces = graph.at_vertex
    normal = take(normals, faces.items)
    share = (1.0 / faces.counts).astype(points.dtype)
    points = points.copy()
    owner = np.repeat(used, faces.counts)
    is_all_used = len(used) == points.shape[1]
    for _ in range(steps):
        arm = take(centroids_of(points, graph), faces.items)
        arm -= take(points, owner)
        arm *= normal
        height = arm[0] + arm[1] + arm[2]
        np.multiply(normal, height, out=arm)
        step = faces.reduce(np.add, arm)
        step *= share
        if is_all_used:
            points += step
        else:
            points[:, used] += step
    return points
