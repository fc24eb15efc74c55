# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Slow twins of the vectorized kernels: the definitions, written as loops over faces, vertices and bands."""

from collections import defaultdict
from itertools import combinations

import numpy as np
from meshes import faces_of

PAIRS = ((1, 4), (2, 5), (3, 6))


def fans(mesh):
    """Walk around every vertex.

    Return the ring of each vertex with a single fan as (ring, is_open, is_twisted), and None for others.
    """
    faces = faces_of(mesh)
    named = defaultdict(list)  # (face, place) of each edge; an edge between one vertex and itself has one end
    for f, face in enumerate(faces):
        for place, v in enumerate(face):
            named[frozenset((v, face[(place + 1) % len(face)]))].append((f, place))
    corners = defaultdict(list)
    for f, face in enumerate(faces):
        for place, v in enumerate(face):
            corners[v].append((f, place))
    return [_fan(v, faces, corners[v], named) for v in range(mesh.n_vertices)]


def _fan(v, faces, corners, named):
    neighbors = {}  # the two ends of each corner: (neighbor, edge) clockwise first, as the face runs
    links = defaultdict(list)
    is_twisted = False
    for f, place in corners:
        face = faces[f]
        size = len(face)
        ends = []
        for other, edge_place in ((face[(place + 1) % size], place), (face[place - 1], (place - 1) % size)):
            here = named[frozenset((v, other))]
            if other == v or len(here) > 2:
                return None
            if len(here) == 2:
                (f1, p1), (f2, p2) = here
                is_twisted |= faces[f1][p1] == faces[f2][p2]
            # An edge is told apart by its places, since one face may name it twice.
            ends.append((other, frozenset(here)))
            links[frozenset(here)].append((f, place, edge_place))
        neighbors[f, place] = ends
    if not corners:
        return None
    rims = [(c, side) for c in corners for side in (0, 1) if len(neighbors[c][side][1]) == 1]
    is_open = bool(rims)
    if is_open:
        oriented = [rim for rim in rims if rim[1] == 0]
        start = (
            oriented[0] if not is_twisted and oriented else min(rims, key=lambda r: neighbors[r[0]][r[1]][0])
        )
    else:
        start = (corners[0], 0)
    ring, visited, (corner, side) = [], [], start
    while True:
        visited.append(corner)
        ring.append(neighbors[corner][side][0])
        leaving = neighbors[corner][1 - side]
        following = _across(corner, 1 - side, neighbors, corners)
        if following is None:
            ring.append(leaving[0])
            break
        if following == start:
            break
        corner, side = following
        if len(visited) > len(corners):
            return None
    distinct = {other for ends in neighbors.values() for other, _ in ends}
    if sorted(visited) != sorted(corners) or len(ring) != len(distinct):
        return None
    return ring, is_open, is_twisted


def _across(corner, side, neighbors, corners):
    """Return the other corner of this vertex at an edge, and on which side it has that edge."""
    edge = neighbors[corner][side][1]
    for c in corners:
        for s in (0, 1):
            if (c, s) != (corner, side) and neighbors[c][s][1] == edge:
                return c, s
    return None


def angle_cosine(points, center, a, b):
    """Return the cosine of the angle between two spokes; a spoke of length zero makes right angles."""
    spokes = [points[k] - points[center] for k in (a, b)]
    sizes = [np.linalg.norm(spoke) for spoke in spokes]
    return float(spokes[0] @ spokes[1] / np.prod([size or 1.0 for size in sizes]))


def straight_pairs(points, center, ring):
    """Return the pairs of (4.2) as sets: three for five neighbors and more, two for four."""
    cosine = {pair: angle_cosine(points, center, *pair) for pair in combinations(ring, 2)}
    left, pairs = list(ring), []
    while len(pairs) < 3 and len(left) > 1:
        best = min(combinations(left, 2), key=cosine.get)
        pairs.append(best)
        left = [v for v in left if v not in best]
    if left and len(pairs) < 3:
        (last,) = left
        pairs.append(min((pair for pair in cosine if last in pair), key=cosine.get))
    return {frozenset(pair) for pair in pairs}


def completed_ring(points, ring):
    """Return the six points around a vertex of valence three or four: its ring and midpoints, in order."""
    edges = [(ring[k], ring[(k + 1) % len(ring)]) for k in range(len(ring))]
    by_length = sorted(edges, key=lambda e: -np.linalg.norm(points[e[0]] - points[e[1]]))
    chosen = by_length[: 6 - len(ring)]
    six = []
    for edge in edges:
        six.append(points[edge[0]])
        if edge in chosen:
            six.append(0.5 * (points[edge[0]] + points[edge[1]]))
    return six


def shrunk(coefficients, nu, kind):
    """Return T_nu of coefficients (B, N, 3) by loops; band 0 is the low-pass."""
    result = coefficients.copy()
    n_bands, n, _ = coefficients.shape

    def shorten(*place):
        norm = np.sqrt(np.sum(coefficients[place] ** 2))
        result[place] = coefficients[place] * (max(norm - nu, 0.0) / norm if norm > 0 else 0.0)

    for k in range(n):
        if kind == "BANDS":
            for axis in range(3):
                shorten(slice(1, None), k, axis)
        for band in range(1, n_bands):
            if kind == "VECTOR":
                shorten(band, k)
            if kind == "SCALAR":
                for axis in range(3):
                    shorten(band, k, axis)
    return result


def split_bregman(noisy, data_matrix, bank, settings, hold=()):
    """Return S after (4.10), word by word: d, b and c, the full mask-matrix and all bands.

    `data_matrix` maps positions (N, 3) to points (T, N, 3); vertices of `hold` stay.
    """

    def analyze(positions):
        return np.einsum("bt,tnc->bnc", bank.masks, data_matrix(positions))

    v = bank.masks[:, 0] / bank.masks[0, 0]
    nu = settings.lambda_ / settings.mu
    s, d = noisy.copy(), analyze(noisy)
    b, c = np.zeros_like(d), np.zeros_like(noisy)
    for iteration in range(settings.iterations):
        s = (noisy - c + settings.mu * np.einsum("b,bnc->nc", v, d - b)) / (1.0 + settings.mu)
        s[list(hold)] = noisy[list(hold)]
        assert iteration or np.allclose(s, noisy, rtol=0, atol=1e-12), "the first step must change nothing"
        coefficients = analyze(s)
        d = shrunk(coefficients + b, nu, settings.shrinkage)
        b = b + coefficients - d
        c = c + settings.delta * (s - noisy)
    return s


def vertices_within(mesh, vertex, n_edges):
    """Return the vertices up to a number of face edges away, without the vertex itself, sorted."""
    around = defaultdict(set)
    for face in faces_of(mesh):
        for a, b in zip(face, face[1:] + face[:1], strict=True):
            around[a].add(b)
            around[b].add(a)
    reached = {vertex}
    for _ in range(n_edges):
        reached |= {b for a in reached for b in around[a]}
    return sorted(reached - {vertex})


def newell(points):
    """Return the vector area of a polygon."""
    total = np.zeros(3)
    for k in range(len(points)):
        total += 0.5 * np.cross(points[k - 1] - points[0], points[k] - points[0])
    return total


def faces_across(mesh):
    """Return the faces across the edges of each face, where a face stands in for none and for several."""
    named = defaultdict(list)
    for f, face in enumerate(faces_of(mesh)):
        for place, v in enumerate(face):
            named[frozenset((face[place - 1], v))].append((f, place))
    table = []
    for f, face in enumerate(faces_of(mesh)):
        ends = [frozenset((v, face[(place + 1) % len(face)])) for place, v in enumerate(face)]
        places = [(f, (place + 1) % len(face)) for place in range(len(face))]
        is_pair = [len(edge) == len(named[edge]) == 2 for edge in ends]
        table.append(
            [
                next(g for g, p in named[edge] if (g, p) != place) if good else f
                for edge, place, good in zip(ends, places, is_pair, strict=True)
            ]
        )
    return table


def faces_touching(mesh):
    """Return, for each face, the faces that share a vertex with it, itself included, ascending."""
    named = defaultdict(set)
    for f, face in enumerate(faces_of(mesh)):
        for v in face:
            named[v].add(f)
    return [sorted(set().union(*(named[v] for v in face))) for face in faces_of(mesh)]


def signed_volume(mesh):
    """Return the volume of a closed and oriented mesh; faces are fans around the means of their corners."""
    if not mesh.n_faces:
        return 0.0
    sizes = np.diff(mesh.face_offset)[:, None]
    corners = (mesh.vertices - mesh.vertices.mean(axis=0, dtype=float))[mesh.corner_vertex]
    middle = np.add.reduceat(corners, mesh.face_offset[:-1]) / sizes
    crossed = np.cross(corners, corners[mesh.next_corner()])
    return float((np.repeat(middle, sizes[:, 0], axis=0) * crossed).sum()) / 6.0
