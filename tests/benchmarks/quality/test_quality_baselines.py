# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The baselines of the quality benchmark against loops and against known figures."""

import sys
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
from framelet.core import connect
from mesh_files import read_mesh
from meshes import MESHES, faces_of, flipped, noisy, soup, triangle_grid, triangle_torus, union
from twins import faces_touching, newell

FOLDER = Path(__file__).resolve().parent
sys.path.insert(0, str(FOLDER))

from baselines import guided_normals, taubin  # noqa: E402
from baselines.bilateral_normals import filtered_normals  # noqa: E402
from baselines.face_graph import FaceGraph  # noqa: E402
from baselines.surface_arrays import normals_and_areas, update_vertices  # noqa: E402
from cases import Case, CaseName, Model  # noqa: E402
from methods import BASELINES  # noqa: E402

ROUNDING = 1e-11
KINDS = {
    "triangles": lambda: flipped(triangle_torus(6, 8)),
    "quads": MESHES["quad torus"],
    "mixed": MESHES["mixed sheet"],
    "polygons": lambda: union(MESHES["prism"](), MESHES["tetrahedron"]()),
    "boundary": lambda: flipped(triangle_grid(5, 6), seed=1),
    "non-manifold": lambda: union(MESHES["three pages"](), MESHES["bow tie"]()),
    "soup": lambda: soup(0),
    "single triangle": MESHES["single triangle"],
}
KIND = pytest.mark.parametrize("kind", KINDS)


@pytest.fixture
def rough(kind, rng):
    """A noisy mesh, its positions in rows, and its graph."""
    mesh = noisy(KINDS[kind](), rng)
    return mesh, np.ascontiguousarray(mesh.vertices.T), FaceGraph(mesh)


def rows_of(rows):
    return [part.tolist() for part in np.split(rows.items, rows.offset[1:-1])]


def adjacent_faces(mesh):
    """Return the pairs of faces that alone share an edge, by a loop."""
    at_edge = {}
    for f, face in enumerate(faces_of(mesh)):
        for k, v in enumerate(face):
            at_edge.setdefault(frozenset((v, face[k - 1])), []).append(f)
    return [tuple(pair) for pair in at_edge.values() if len(pair) == 2 and pair[0] != pair[1]]


def geometry(mesh):
    """Return unit normals, areas and centroids by loops."""
    vectors = np.array([newell(mesh.vertices[face]) for face in faces_of(mesh)])
    size = np.linalg.norm(vectors, axis=1)
    normals = vectors / np.where(size > 0, size, 1)[:, None]
    return normals, size, np.array([mesh.vertices[face].mean(axis=0) for face in faces_of(mesh)])


def sigma_of(mesh, centroids):
    pairs = adjacent_faces(mesh)
    return np.mean([np.linalg.norm(centroids[f] - centroids[g]) for f, g in pairs]) if pairs else 1.0


def slow_means(normals, guides, areas, centroids, near, sigma_c, sigma_s):
    """Return joint bilateral means of normals."""
    result = normals.copy()
    for f, faces in enumerate(near):
        total = np.zeros(3)
        for g in faces:
            space = np.exp(-np.sum((centroids[f] - centroids[g]) ** 2) / (2 * sigma_c**2))
            likeness = np.exp(-np.sum((guides[f] - guides[g]) ** 2) / (2 * sigma_s**2))
            total += areas[g] * space * likeness * normals[g]
        if np.linalg.norm(total) > 0:
            result[f] = total / np.linalg.norm(total)
    return result


def slow_update(mesh, normals, steps):
    """Return positions after steps of the vertex update."""
    points = mesh.vertices.copy()
    for _ in range(steps):
        centroids = geometry(mesh.with_vertices(points))[2]
        sums, counts = np.zeros_like(points), np.zeros(len(points))
        for f, face in enumerate(faces_of(mesh)):
            for v in face:
                sums[v] += normals[f] * np.dot(normals[f], centroids[f] - points[v])
                counts[v] += 1
        points = points + sums / np.maximum(counts, 1)[:, None]
    return points


def slow_guidance(mesh, normals, areas):
    """Return guidance normals by loops over patches, pairs and inner edges."""
    patches = faces_touching(mesh)
    scores, means = [], []
    for f, patch in enumerate(patches):
        spread = max((np.linalg.norm(normals[g] - normals[h]) for g, h in combinations(patch, 2)), default=0)
        jumps = [
            np.linalg.norm(normals[g] - normals[h])
            for g, h in adjacent_faces(mesh)
            if g in patch and h in patch
        ]
        scores.append(spread * max(jumps, default=0) / (1e-9 + sum(jumps)))
        total = sum(normals[g] * areas[g] for g in patch)
        size = np.linalg.norm(total)
        means.append(total / size if size > 0 else normals[f])
    return np.array([means[min(patch, key=lambda g: (scores[g], g))] for patch in patches]), scores


def slow_guided(mesh, sigma_r, iterations, vertex_steps):
    """Return positions after guided normal filtering."""
    patches = faces_touching(mesh)
    rings = [sorted({h for g in patch for h in patches[g]}) for patch in patches]
    centroids = geometry(mesh)[2]
    radius = 2 * sigma_of(mesh, centroids)
    near = [
        [g for g in ring if g == f or np.linalg.norm(centroids[f] - centroids[g]) <= radius]
        for f, ring in enumerate(rings)
    ]
    for _ in range(iterations):
        normals, areas, centroids = geometry(mesh)
        guides, _ = slow_guidance(mesh, normals, areas)
        normals = slow_means(normals, guides, areas, centroids, near, sigma_of(mesh, centroids), sigma_r)
        mesh = mesh.with_vertices(slow_update(mesh, normals, vertex_steps))
    return mesh.vertices


@KIND
def test_neighborhoods(rough):
    mesh, _, graph = rough
    patches = faces_touching(mesh)
    assert rows_of(graph.touching) == patches
    assert rows_of(graph.two_rings) == [sorted({h for g in patch for h in patches[g]}) for patch in patches]
    edges = [tuple(sorted(pair)) for pair in graph.adjacent.T.tolist()]
    assert sorted(edges) == sorted(tuple(sorted(pair)) for pair in adjacent_faces(mesh))
    pairs, of_patch = graph.patch_pairs
    for patch, numbers, inner in zip(patches, rows_of(of_patch), rows_of(graph.patch_edges), strict=True):
        found = [tuple(pair) for pair in pairs[:, numbers].T.tolist()]
        assert found == (list(combinations(patch, 2)) or [(0, 0)])
        expected = [k for k, (g, h) in enumerate(edges) if g in patch and h in patch]
        assert sorted(inner) == (expected or [len(edges)])


@KIND
def test_bilateral_normals_twin(rough):
    mesh, points, graph = rough
    normals, areas, centroids = geometry(mesh)
    near, sigma_c = faces_touching(mesh), sigma_of(mesh, centroids)
    expected = {}
    for n in range(1, 4):
        normals = slow_means(normals, normals, areas, centroids, near, sigma_c, 0.4)
        expected[n] = normals
    for n, found in zip((1, 3), filtered_normals(points, graph, 0.4, (1, 3)), strict=True):
        assert np.abs(found.T - expected[n]).max() < ROUNDING


@KIND
def test_vertex_update_twin(rough):
    mesh, points, graph = rough
    normals = normals_and_areas(points, graph)[0]
    assert np.abs(normals.T - geometry(mesh)[0]).max() < ROUNDING
    before = points.copy()
    found = update_vertices(points, normals, graph, 3)
    assert np.array_equal(points, before)
    assert np.abs(found.T - slow_update(mesh, normals.T, 3)).max() < ROUNDING


@KIND
def test_guided_normals_twin(kind, rough):
    mesh, points, graph = rough
    normals, areas = normals_and_areas(points, graph)
    guides, scores = slow_guidance(mesh, normals.T, areas)
    assert np.abs(guided_normals.consistency(normals, graph) - scores).max() < ROUNDING
    assert np.abs(guided_normals.guidance(normals, areas, graph).T - guides).max() < ROUNDING
    # In a soup a face and its reverse cancel out, so that rounding decides what comes after.
    n = 1 if kind == "soup" else 2
    *_, found = guided_normals.filtered_positions(points, graph, 0.35, range(1, n + 1), 3)
    assert np.abs(found.T - slow_guided(mesh, 0.35, n, 3)).max() < 1e-9


def test_filters_of_normals_reach_known_figures(shared_meshes):
    # Other implementations of the two filters, tuned, reached 2.22 and 2.10 degrees.
    clean = read_mesh(shared_meshes / "tri" / "fandisk.ply")
    case = Case(CaseName("tri/fandisk", "normal 0.2", 0), Model("tri/fandisk", clean))
    bilateral = {"sigma_s": 0.35, "normal_iterations": 20, "vertex_iterations": 10}
    guided = {"sigma_r": 0.2, "normal_iterations": 20}
    assert case.measure(BASELINES["LBNF"].run(case, bilateral).positions).angle < 2.3
    assert case.measure(BASELINES["GNF"].run(case, guided).positions).angle < 2.2


@pytest.mark.skipif(not taubin.is_installed(), reason="trimesh is installed for benchmarks only")
@pytest.mark.parametrize("kind", ["triangles", "quads", "mixed"])
def test_taubin_is_the_formula(rough):
    mesh, _, _ = rough
    connectivity = connect(mesh)
    ring = [[] for _ in range(mesh.n_vertices)]
    for a, b in mesh.edges.tolist():
        ring[a].append(b)
        ring[b].append(a)
    assert len(connectivity.valence) == len(ring)
    points = mesh.vertices.astype(float)
    for factor in (0.5, -0.53, 0.5, -0.53):
        means = np.array([points[near].mean(axis=0) if near else points[v] for v, near in enumerate(ring)])
        points = points + factor * (means - points)
    smoother = taubin.Smoother(mesh)
    halfway = smoother.run(mesh.vertices, 0.5, 0.53, 2)
    assert np.abs(smoother.run(halfway, 0.5, 0.53, 2) - points).max() < ROUNDING
