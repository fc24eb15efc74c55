# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Slow twins of learned shrinkage: its definitions, written as loops over faces and pairs."""

from collections import defaultdict
from itertools import pairwise, permutations, product

import numpy as np
from meshes import faces_of
from twins import newell

AVERAGES = (2, 10, 48)
FLOOR = 1e-4
SHRUNK = 1e-3
LEAST_LENGTH = 0.05
SPREAD = 64


def face_order(mesh):
    """Return the faces of the mesh as the face graph numbers them: by their number of corners."""
    sizes = [len(face) for face in faces_of(mesh)]
    return sorted((f for f, size in enumerate(sizes) if size >= 3), key=lambda f: (sizes[f], f))


def polygons_of(mesh):
    """Return the corners of the faces of the graph."""
    faces = faces_of(mesh)
    return [faces[f] for f in face_order(mesh)]


def pairs_of(mesh):
    """Return the pairs (f, g, edge) of faces of the graph across an edge of two vertices, f < g."""
    faces, named = faces_of(mesh), defaultdict(list)
    for f, face in enumerate(faces):
        for place, v in enumerate(face):
            named[frozenset((v, face[(place + 1) % len(face)]))].append(f)
    number = {f: k for k, f in enumerate(face_order(mesh))}
    return [
        (*sorted((number[own[0]], number[own[1]])), edge)
        for edge, own in named.items()
        if len(edge) == len(own) == 2 and own[0] != own[1] and own[0] in number and own[1] in number
    ]


def parts_of(n_faces, pairs):
    """Return the number of the connected part of each face, by filling one after the other."""
    around = defaultdict(list)
    for f, g, _ in pairs:
        around[f].append(g)
        around[g].append(f)
    part = [-1] * n_faces
    for first in range(n_faces):
        if part[first] >= 0:
            continue
        waiting, number = [first], max(part) + 1
        while waiting:
            face = waiting.pop()
            if part[face] < 0:
                part[face] = number
                waiting += around[face]
    return part


def ring_matrix(mesh, left_out=()):
    """Return the mean P over neighbors, on a border over those along it, as a dense matrix.

    Edges that are left out make no neighbors; a vertex without others takes its neighbors that have some.
    """
    around, rim, whole, count = (defaultdict(set) for _ in range(4))
    left_out = {frozenset(edge) for edge in left_out}
    for f, face in enumerate(faces_of(mesh)):
        for place, (v, w) in enumerate(pairwise([*face, *face[:1]])):
            count[frozenset((v, w))].add((f, place))
    for edge, places in count.items():
        if len(edge) == 2:
            for v, w in permutations(edge):
                whole[v].add(w)
                if len(places) == 1:
                    rim[v]  # is on a border, whether or not anything is left of it
                if edge not in left_out:
                    around[v].add(w)
                    if len(places) == 1:
                        rim[v].add(w)
    near = [rim[v] if v in rim else around[v] for v in range(mesh.n_vertices)]
    if left_out:
        is_far = [not own for own in near]
        near = [{w for w in own if not is_far[w]} for own in near]
    result = np.zeros((mesh.n_vertices, mesh.n_vertices))
    for v, own in enumerate(near):
        if left_out and is_far[v]:
            own = {w for w in whole[v] if not is_far[w]}
        own = sorted(own or {v})
        result[v, own] = 1 / len(own)
    return result


def averaging(means, power):
    """Return A^k, A = (1 + P) / 2, as a dense matrix."""
    return np.linalg.matrix_power((np.eye(len(means)) + means) / 2, power)


def low_pass(means, k):
    """Return L_k = 2 A^k - A^2k as a dense matrix."""
    return 2 * averaging(means, k) - averaging(means, 2 * k)


def slow_scales(mesh, means):
    """Return normals and centroids (F, S, 3), areas (F, S) and lengths (F,) of the faces of the graph."""
    surfaces = [mesh.vertices, *(low_pass(means, k) @ mesh.vertices for k in AVERAGES)]
    faces = polygons_of(mesh)
    vectors = np.array([[newell(points[face]) for points in surfaces] for face in faces])
    centroids = np.array([[points[face].mean(axis=0) for points in surfaces] for face in faces])
    areas = np.linalg.norm(vectors, axis=2)
    normals = vectors / np.maximum(areas, 1e-30)[:, :, None]
    for f, scale in product(range(len(faces)), range(1, len(surfaces))):
        if areas[f, scale] < SHRUNK * areas[f, 0]:
            normals[f, scale] = normals[f, scale - 1]
    edge = np.ones(mesh.n_vertices)
    for v, row in enumerate(means):
        near = np.flatnonzero(row)
        noisy, smooth = (np.linalg.norm(x[near] - x[v], axis=1).mean() for x in (surfaces[0], surfaces[2]))
        if noisy > 0:
            edge[v] = max(smooth, LEAST_LENGTH * noisy)
    edge = np.exp(averaging(means, 12) @ np.log(edge))
    return normals, centroids, areas, np.array([edge[face].mean() for face in faces])


def energy(value):
    """Return log(x^2 + floor) of numbers, or of vectors in the last axis of length 3."""
    return np.log(np.sum(np.square(value), axis=-1) + FLOOR) if np.ndim(value) else np.log(value**2 + FLOOR)


def face_pairs_of(mesh, pairs):
    """Return, for each face of the graph, the pair of each of its edges, None where there is none."""
    by_edge = {edge: number for number, (_, _, edge) in enumerate(pairs)}
    faces = polygons_of(mesh)
    return [
        [by_edge.get(frozenset((v, face[(k + 1) % len(face)]))) for k, v in enumerate(face)] for face in faces
    ]


def slow_features(mesh, means, scales, residual=None, log_strength=0.0, least_island=500):
    """Return the inputs of the net.

    Those of the faces of the graph, of pairs in the order of `pairs_of`, and of the island of each face.
    """
    normals, centroids, areas, length = scales
    pairs = pairs_of(mesh)
    faces = polygons_of(mesh)
    jump = np.array([[energy(normals[g, k] - normals[f, k]) for k in range(3)] for f, g, _ in pairs])
    of_pairs = np.zeros((len(pairs), 7))
    for number, (f, g, _) in enumerate(pairs):
        unit, arms = (length[f] + length[g]) / 2, centroids[g] - centroids[f]
        far = np.maximum(np.sqrt((arms**2).sum(axis=1)), 1e-3 * unit)
        of_pairs[number, 0] = np.log(far[0] / unit + 0.01)
        of_pairs[number, 1] = abs(np.log((areas[f, 0] + FLOOR) / (areas[g, 0] + FLOOR)))
        for k in range(3):
            of_pairs[number, 2 + k] = (normals[g, k] - normals[f, k]) @ arms[k] / far[k]
        for k in range(2):
            of_pairs[number, 5 + k] = energy((normals[g, k] + normals[f, k]) @ arms[k] / unit)
    result = np.zeros((len(faces), 39))
    spread, is_flat = np.zeros((len(faces), 8)), np.zeros(len(faces), bool)
    quiet = np.log(FLOOR)
    for f, own_pairs in enumerate(face_pairs_of(mesh, pairs)):
        steps = centroids[f, :-1] - centroids[f, 1:]
        height = (normals[f, 1:] * steps).sum(axis=1) / length[f]
        heights = [energy(h) for h in height]
        between = [energy(normals[f, a] - normals[f, b]) for a, b in ((0, 1), (1, 2), (2, 3), (0, 2), (1, 3))]
        between.append(energy(normals[f, 0] - normals[f, 3]))
        jumps = np.array([[quiet] * 3 if p is None else jump[p] for p in own_pairs])
        mean = jumps.mean(axis=0)
        area = np.log(areas[f, 0] / length[f] ** 2 + 0.01)
        result[f, :13] = [*height, *heights, *between, area]
        spread[f] = [*mean, *heights, mean[0] ** 2, heights[0] ** 2]
        is_flat[f] = jumps[:, 0].max() < np.log(2 * FLOOR) and abs(height[0]) < 1e-3
    result[:, 13:21] = spread_around(means, faces, spread, log_strength)
    part = np.array(parts_of(len(faces), pairs))
    sizes = np.bincount(part)
    part[sizes[part] < least_island] = -1 if (sizes > 0).sum() > 1 else 0
    for number in np.unique(part):
        own = part == number
        result[own, 21:37] = quantiles(spread[own], is_flat[own], log_strength)
    if residual is not None:
        for f, face in enumerate(faces):
            result[f, 37] = energy(np.mean([residual[0][v] for v in face]) / length[f]) / 4 + 1
            result[f, 38] = 2 * np.mean([residual[1][v] for v in face])
    context = result[:, 21:].copy()
    for number in np.unique(part):
        context[part == number, -2:] = result[part == number, -2:].mean(axis=0)
    return result, of_pairs, context


def slow_offsets(mesh, after):
    """Return what was taken away along the normals of the positions after, (N,): weighted by areas."""
    normals = np.zeros((mesh.n_vertices, 3))
    for face in polygons_of(mesh):
        for v in face:
            normals[v] += newell(after[face])
    normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-30)[:, None]
    return ((mesh.vertices - after) * normals).sum(axis=1)


def slow_residual(means, offsets):
    """Return the strength of offsets around vertices and their correlation with the ring, each (N,)."""
    wide = averaging(means, SPREAD)
    square = wide @ offsets**2
    correlation = wide @ (offsets * (means @ offsets)) / np.maximum(square, 1e-20)
    return np.sqrt(square), np.clip(correlation, -1, 1)


def spread_around(means, faces, spread, log_strength):
    """Return energies averaged over vertices, A^64 and corners; second moments become deviations."""
    at_vertex = np.zeros((len(means), 8))
    for v in range(len(means)):
        own = [f for f, face in enumerate(faces) for w in face if w == v]
        if own:
            at_vertex[v] = spread[own].mean(axis=0)
    wide = averaging(means, SPREAD) @ at_vertex
    result = np.array([wide[face].mean(axis=0) for face in faces])
    for moment, mean in ((6, 0), (7, 3)):
        result[:, moment] = np.sqrt(np.maximum(result[:, moment] - result[:, mean] ** 2, 0))
    result[:, :2] += 2 * log_strength
    result[:, 3:6] += log_strength
    return result


def quantiles(energies, is_flat, log_strength):
    """Return quantiles over the faces that are not flat; all faces count if there are few."""
    counted = energies[~is_flat] if not is_flat.all() else energies[:1]
    values = []
    for band in range(3):
        ordered = np.sort(counted[:, band])
        shift = 2 * log_strength if band < 2 else 0
        values += [ordered[round(q * (len(ordered) - 1))] + shift for q in (0.25, 0.5, 0.75)]
    for band in range(3, 6):
        ordered = np.sort(counted[:, band])
        values += [ordered[round(q * (len(ordered) - 1))] + log_strength for q in (0.5, 0.9)]
    return [*values, np.log((~is_flat).mean() + 0.01)]


def slow_net(arrays, mesh, scales, features, pair_features, context, clip=6.0):
    """Return clean unit normals of the faces of the graph, (F, 3), face by face and pair by pair.

    `context`, (F, 18), is what is known of the island of each face.
    """
    normals, _, areas, length = scales
    pairs = pairs_of(mesh)
    own_pairs = face_pairs_of(mesh, pairs)
    weight = np.maximum(areas[:, 0] / length**2, 1e-4)
    n_corners = [len(own) for own in own_pairs]

    def linear(name, x):
        return arrays[f"{name}.weight"] @ x + arrays.get(f"{name}.bias", 0.0)

    def standard(x, kind):
        return np.clip((x - arrays[f"{kind}_mean"]) / arrays[f"{kind}_scale"], -clip, clip)

    def shift(row):
        known = (row - arrays["face_mean"][-18:]) / arrays["face_scale"][-18:]
        return linear("shift", np.maximum(linear("context", np.clip(known, -clip, clip)), 0))

    vectors = normals.copy()
    shifts = [shift(row) for row in context]
    state = [
        linear("begin", np.maximum(linear("enter", standard(row, "face")), 0)) + own[:16]
        for row, own in zip(features, shifts, strict=True)
    ]
    for number, n_steps in enumerate(arrays["repeats"]):
        name = f"layers.{number}"
        biases = [np.split(own[16 + 24 * number : 40 + 24 * number], (16, 20)) for own in shifts]
        hidden, gains = [], []
        for (f, g, _), row in zip(pairs, pair_features, strict=True):
            energies = energy(vectors[g] - vectors[f]) / 4
            own = linear(f"{name}.from_faces", state[f]) + linear(f"{name}.from_faces", state[g])
            own += linear(f"{name}.from_pairs", np.concatenate((energies, standard(row, "edge"))))
            own += biases[f][0]
            hidden.append(np.maximum(own, 0))
            share = (
                2 * weight[f] * weight[g] / (weight[f] + weight[g]) / (max(n_corners[f], n_corners[g]) + 1)
            )
            gains.append(share / (1 + np.exp(-linear(f"{name}.gains", hidden[-1]) - biases[f][1])))
        for _ in range(n_steps):
            following = vectors.copy()
            for (f, g, _), gain in zip(pairs, gains, strict=True):
                flow = gain[:, None] * (vectors[g] - vectors[f])
                following[f] += flow / weight[f]
                following[g] -= flow / weight[g]
            vectors = following
        for f, pair in enumerate(own_pairs):
            mixing = np.tanh(linear(f"{name}.mixing", state[f]) + biases[f][2])
            vectors[f] += mixing[:, None] * (arrays[f"{name}.channels"] @ vectors[f])
            lengths = [energy(vectors[f, k + 1] - vectors[f, k]) for k in range(3)]
            lengths.append(energy(vectors[f, 0]))
            around = sum((hidden[p] for p in pair if p is not None), np.zeros(len(state[f]))) / len(pair)
            collected = np.maximum(linear(f"{name}.collect", np.concatenate((state[f], around, lengths))), 0)
            state[f] = state[f] + linear(f"{name}.update", collected)
    result = np.array([linear("leave", s) @ v for s, v in zip(state, vectors, strict=True)])
    return result / (np.linalg.norm(result, axis=1) + 1e-6)[:, None]


def fit_problem(mesh, normals, weights, normal_pull=0.006, tangent_pull=0.1):
    """Return the quadratic form H of a screened fit and its gradient at the noisy positions.

    The energy of displacements d, shape (3 N,), vertex by vertex, is d H d / 2 + g d + const.
    """
    n = mesh.n_vertices
    form, gradient = np.zeros((3 * n, 3 * n)), np.zeros(3 * n)
    valence, mean = np.zeros(n), np.zeros((n, 3))
    faces = faces_of(mesh)
    for f, normal, weight in zip(face_order(mesh), normals, weights, strict=True):
        face = faces[f]
        for v in face:
            row = np.zeros(3 * n)  # <n_f, v - c_f> as a linear form
            row[3 * v : 3 * v + 3] += normal
            for w in face:
                row[3 * w : 3 * w + 3] -= normal / len(face)
            own = np.flatnonzero(row)
            form[np.ix_(own, own)] += 2 * weight * np.outer(row[own], row[own])
            gradient += 2 * weight * (row @ mesh.vertices.ravel()) * row
            valence[v] += 1
            mean[v] += normal
    for v in range(n):
        unit = mean[v] / max(np.linalg.norm(mean[v]), 1e-6)
        along = np.outer(unit, unit)
        pull = normal_pull * along + tangent_pull * (np.eye(3) - along)
        form[3 * v : 3 * v + 3, 3 * v : 3 * v + 3] += 2 * valence[v] * pull
    return form, gradient, valence


def chebyshev_steps(form, gradient, preconditioner, n_steps, lowest, highest):
    """Return what Chebyshev steps from 0 reach, by its polynomial in the eigenvectors of the problem."""
    root = np.sqrt(preconditioner)
    values, vectors = np.linalg.eigh(form / np.outer(root, root))
    middle, half = (highest + lowest) / 2, (highest - lowest) / 2
    top = np.polynomial.chebyshev.Chebyshev.basis(n_steps)
    left = top((middle - values) / half) / top(middle / half)
    share = np.where(values > 1e-12, (1 - left) / np.where(values > 1e-12, values, 1), 0)
    return -(vectors @ (share * (vectors.T @ (gradient / root)))) / root, values


def slow_flat_vertices(mesh, scales):
    """Return which vertices belong to faces of a flat part, bool (N,)."""
    normals, centroids, areas, length = scales
    points, faces = mesh.vertices, polygons_of(mesh)
    rounding = 4 * np.spacing(np.float32(max(1, np.abs(points).max())))
    height = areas[:, 0] / length
    coplanar = []
    for f, g, edge in pairs_of(mesh):
        low = min(height[f], height[g])
        if low > 16 * rounding and np.linalg.norm(normals[f, 0] - normals[g, 0]) * low < rounding:
            coplanar.append((f, g, edge))
    part = parts_of(len(faces), coplanar)
    triangles = [
        1 + sum(abs((points[v] - centroids[f, 0]) @ normals[f, 0]) < rounding for v in face[3:])
        for f, face in enumerate(faces)
    ]
    size = defaultdict(int)
    for own, number in zip(part, triangles, strict=True):
        size[own] += number
    total = sum(triangles)
    needed = min(30, max(2, 0.02 * total))
    if sum(number for number in size.values() if number >= needed) > 0.5 * total:
        needed = 2
    result = np.zeros(mesh.n_vertices, bool)
    for own, face in zip(part, faces, strict=True):
        if size[own] >= needed:
            result[face] = True
    return result


def slow_hardly_moved(offsets, is_clean, is_free, means):
    """Return which vertices a pass hardly moved, bool (N,); all that move little where there is no noise."""
    near = averaging(means, 4)
    still = []
    for v, row in enumerate(near):
        around = sum(weight * min(u**2, 0.01) for weight, u in zip(row, offsets, strict=True) if weight)
        still.append(bool(is_clean[v] and around < 0.03**2 and abs(offsets[v]) < 0.3))
    rest = [u for u, s, free in zip(offsets, still, is_free, strict=True) if free and not s]
    if rest:
        noise = np.mean([u**2 for u in rest]) < 0.01**2
        weak = np.mean([min(u**2, 0.01) for u in rest]) < 0.03**2
        if noise or (weak and np.mean(is_clean) > 0.25):
            still = [s or abs(u) < 0.3 for s, u in zip(still, offsets, strict=True)]
    return np.array(still)


def slow_start(points, fitted, is_free, means, outlier=5.0, n_averages=32, least=5e-4, least_usual=0.01):
    """Return where a second fit holds vertices: outliers at the height of those in their rings, or None.

    Also by which factor the displacements miss being outliers, for tests to be sure.
    """
    step = fitted - points
    distance = np.linalg.norm(step, axis=1)
    wide = averaging(means, n_averages)
    usual = wide @ np.minimum(distance, 2 * (wide @ distance))
    usual = np.maximum(usual, least_usual)
    is_out = is_free & (distance > outlier * usual)
    result = points.copy()
    for v in np.flatnonzero(is_out):
        own = [w for w in np.flatnonzero(means[v]) if not is_out[w]]
        if own:
            direction = step[v] / distance[v]
            result[v] += direction * (direction @ (points[own].mean(axis=0) - points[v]))
    sure = np.abs(np.log(np.maximum(distance, 1e-30) / np.maximum(outlier * usual, 1e-30)))[is_free]
    return (result if is_out.sum() >= least * len(points) else None), sure.min(initial=np.inf)
