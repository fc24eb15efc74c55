# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Guided normal filtering (Zhang, Deng, Zhang, Bouaziz and Liu, Computer Graphics Forum 34(7), 2015)."""

import numpy as np

from .bilateral_normals import spatial_weights, weighted_means
from .face_graph import Rows
from .surface_arrays import (
    centroids_of,
    mean_centroid_distance,
    normals_and_areas,
    squares,
    take,
    unit,
    update_vertices,
)

SIGMA_R = 0.35
NORMAL_ITERATIONS = 20
VERTEX_ITERATIONS = 10
RADIUS = 2.0
"""Radius of the neighborhoods, in mean distances of the centroids of adjacent faces."""

EPSILON = 1e-9


def filtered_positions(points, graph, sigma_r, iterations, vertex_iterations=VERTEX_ITERATIONS):
    """Yield the positions after each of some numbers of iterations.

    An iteration finds guidance normals, takes the joint bilateral means of the normals of the surface as it
    is, n_f <- normalize(sum over g of a_g Wc(|c_f - c_g|) Ws(|guide_f - guide_g|) n_g), and moves the
    vertices.

    Parameters
    ----------
    points : ndarray, shape (3, N)
        Noisy positions; not modified.
    graph : FaceGraph
        The faces.
    sigma_r : float
        Width of Ws, on differences of guidance normals.
    iterations : sequence of int
        Ascending numbers of iterations at which the positions are wanted.
    vertex_iterations : int
        Steps of the vertex update in each iteration.

    Yields
    ------
    ndarray, shape (3, N)
    """
    near = faces_within(points, graph)
    scale = points.dtype.type(-0.5 / sigma_r**2)
    done = 0
    for wanted in iterations:
        for _ in range(done, wanted):
            normals, areas = normals_and_areas(points, graph)
            guides = guidance(normals, areas, graph)
            fixed = spatial_weights(centroids_of(points, graph), areas, near, graph)
            normals = weighted_means(normals, guides, fixed, scale, near)
            points = update_vertices(points, normals, graph, vertex_iterations)
        done = wanted
        yield points


def faces_within(points, graph):
    """Return the faces of two rings whose centroids lie within the radius around each face, itself included.

    The paper goes on along the surface as far as the radius reaches. Where faces are much smaller than the
    mean that is more than two rings; the limit keeps the cost within bounds.
    """
    centroids = centroids_of(points, graph)
    radius = RADIUS * mean_centroid_distance(centroids, graph)
    rings = graph.two_rings
    row = np.repeat(np.arange(graph.n_faces), rings.counts)
    is_near = squares(take(centroids, rings.items) - take(centroids, row)) <= radius**2
    is_near |= rings.items == row
    counts = np.bincount(row[is_near], minlength=graph.n_faces)
    return Rows(np.concatenate(([0], np.cumsum(counts))), rings.items[is_near])


def guidance(normals, areas, graph):
    """Return, for each face, the mean normal of the most consistent patch that contains it, shape (3, F)."""
    patches = graph.touching
    order = np.argsort(consistency(normals, graph), kind="stable")
    rank = np.empty(graph.n_faces, np.int32)
    rank[order] = np.arange(graph.n_faces, dtype=np.int32)
    # A patch contains a face if its central face touches that face.
    best = order[patches.reduce(np.minimum, rank[patches.items])]
    means = unit(patches.reduce(np.add, take(normals * areas, patches.items)), normals)
    return take(means, best)


def consistency(normals, graph):
    """Return H = D R of each patch, shape (F,); low where the normals of a patch agree.

    D is the largest difference of two normals of the patch, R the largest difference across an inner edge of
    the patch over the sum of all such differences.
    """
    pairs, of_patch = graph.patch_pairs
    first, second = take(normals, pairs[0]), take(normals, pairs[1])
    first -= second
    apart = squares(first)
    spread = np.sqrt(of_patch.reduce(np.maximum, np.take(apart, of_patch.items)))
    first, second = (take(normals, faces) for faces in graph.adjacent)
    jump = np.append(np.sqrt(squares(first - second)), normals.dtype.type(0))
    at_edges = np.take(jump, graph.patch_edges.items)
    largest = graph.patch_edges.reduce(np.maximum, at_edges)
    return spread * largest / (normals.dtype.type(EPSILON) + graph.patch_edges.reduce(np.add, at_edges))
