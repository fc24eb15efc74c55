# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bilateral normal filtering, local scheme (Zheng, Fu, Au and Tai, IEEE TVCG 17, 2011)."""

import numpy as np

from .face_graph import Rows
from .surface_arrays import centroids_of, mean_centroid_distance, normals_and_areas, squares, take, unit

SIGMA_S = 0.35
NORMAL_ITERATIONS = 20
VERTEX_ITERATIONS = 10


def filtered_normals(points, graph, sigma_s, iterations):
    """Yield the normals after each of some numbers of iterations.

    n_f <- normalize(sum over g of a_g Wc(|c_f - c_g|) Ws(|n_f - n_g|) n_g), over the faces that share a
    vertex with f and f itself. Areas and centroids are those of the noisy mesh; Wc and Ws are Gaussians, Wc
    as wide as the mean distance of the centroids of adjacent faces.

    Parameters
    ----------
    points : ndarray, shape (3, N)
        Noisy positions; not modified.
    graph : FaceGraph
        The faces.
    sigma_s : float
        Width of Ws, on differences of unit normals.
    iterations : sequence of int
        Ascending numbers of iterations at which the normals are wanted.

    Yields
    ------
    ndarray, shape (3, F)
    """
    normals, areas = normals_and_areas(points, graph)
    near = graph.touching
    fixed = spatial_weights(centroids_of(points, graph), areas, near, graph)
    scale = points.dtype.type(-0.5 / sigma_s**2)
    done = 0
    for wanted in iterations:
        for _ in range(done, wanted):
            normals = weighted_means(normals, normals, fixed, scale, near)
        done = wanted
        yield normals


def spatial_weights(centroids, areas, near: Rows, graph):
    """Return a_g exp(-|c_f - c_g|^2 / 2 sigma^2), one for each item of the rows."""
    sigma = mean_centroid_distance(centroids, graph)
    apart = take(centroids, near.items)
    apart -= near.spread(centroids)
    return np.exp(squares(apart) * centroids.dtype.type(-0.5 / sigma**2)) * np.take(areas, near.items)


def weighted_means(normals, guides, fixed, scale, near: Rows):
    """Return the normalized means of normals with the weights fixed * exp(scale |guide_f - guide_g|^2)."""
    there = take(guides, near.items)
    apart = there - near.spread(guides)
    weight = squares(apart)
    weight *= scale
    np.exp(weight, out=weight)
    weight *= fixed
    if normals is not guides:
        there = take(normals, near.items)
    there *= weight
    return unit(near.reduce(np.add, there), normals)
