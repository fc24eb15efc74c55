# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pairs of faces and connected parts against loops over faces."""

from collections import Counter

import numpy as np
import pytest
from checks import wild_mesh
from framelet.core import SurfaceMesh, connect
from framelet.core.learned.face_graph import FaceGraph
from framelet.core.learned.islands import find_islands
from kinds import ALONE, BLOCKS, KINDS
from learned_twins import face_order, face_pairs_of, pairs_of, parts_of
from meshes import MESHES, faces_of, noisy, pyramid, quad_torus, soup, triangle_torus, union

GRAPHS = {
    **MESHES,
    **KINDS,
    "soups": lambda: union(*(soup(seed, shortest=1 + seed % 3) for seed in range(8))),
    "three islands": lambda: union(triangle_torus(5, 6), quad_torus(5, 6), pyramid(9)),
    "two triangles": lambda: SurfaceMesh.from_faces(np.eye(4, 3), [(0, 1, 2), (2, 1, 3)]),
    "the same triangle twice": lambda: SurfaceMesh.from_faces(np.eye(3), [(0, 1, 2), (2, 1, 0)]),
}
GRAPH = pytest.mark.parametrize("name", GRAPHS)


def graph_of(mesh, blocks=ALONE, **sizes):
    return FaceGraph(mesh, connect(mesh), blocks, **sizes)


@GRAPH
def test_pairs_of_faces(name):
    mesh = GRAPHS[name]()
    graph, pairs = graph_of(mesh), pairs_of(mesh)
    found = list(zip(graph.first.tolist(), graph.second.tolist(), strict=True))
    assert Counter(found[:-1]) == Counter((f, g) for f, g, _ in pairs)
    assert found[-1] == (0, 0) and graph.n_pairs == len(pairs)
    assert graph.n_faces == len(face_order(mesh))


@GRAPH
def test_tables_of_faces(name):
    """Corners, the faces across their edges, and the pairs there; for none, itself and the last."""
    mesh = GRAPHS[name]()
    graph, pairs, order, faces = graph_of(mesh), pairs_of(mesh), face_order(mesh), faces_of(mesh)
    assert graph.order is None or graph.order.tolist() == order
    assert graph.order is not None or order == list(range(mesh.n_faces))
    expected = face_pairs_of(mesh, pairs)
    number = {}  # of the graph's pairs by the twin's
    for group in graph.groups:
        for f in range(group.begin, group.end):
            own = f - group.begin
            assert group.corners[:, own].tolist() == faces[order[f]]
            for pair, neighbor, wanted in zip(
                group.pairs[:, own], group.neighbors[:, own], expected[f], strict=True
            ):
                if wanted is None:
                    assert (pair, neighbor) == (graph.n_pairs, f)
                    continue
                assert number.setdefault(wanted, pair) == pair < graph.n_pairs
                assert sorted((f, neighbor)) == [graph.first[pair], graph.second[pair]]
    assert len(set(number.values())) == len(number) == graph.n_pairs
    assert [group.end for group in graph.groups] == [g.begin for g in graph.groups[1:]] + [graph.n_faces]


@GRAPH
def test_fields_of_faces_are_renumbered(name, rng):
    mesh = GRAPHS[name]()
    field = rng.normal(size=(2, mesh.n_faces))
    assert np.array_equal(graph_of(mesh).in_graph_order(field), field[:, face_order(mesh)])


@BLOCKS
def test_blocks_see_each_face_and_each_pair_once(blocks):
    graph = graph_of(MESHES["mixed sheet"](), blocks, faces_at_once=7)
    faces, pairs = np.zeros(graph.n_faces, int), np.zeros(graph.n_pairs, int)

    def see(own, polygons):
        faces[own] += 1
        assert polygons.end - polygons.begin == own.stop - own.start == polygons.corners.shape[1]

    graph.for_faces(see)
    graph.for_pairs(lambda start, stop: np.add.at(pairs, np.arange(start, stop), 1))
    assert (faces == 1).all() and (pairs == 1).all()


@GRAPH
def test_islands_match_a_flood(name, rng):
    mesh = GRAPHS[name]()
    shuffled = rng.permutation(mesh.n_faces)
    for faces in (faces_of(mesh), [faces_of(mesh)[f] for f in shuffled]):
        other = wild_mesh(mesh.vertices, faces)
        expected = parts_of(len(face_order(other)), pairs_of(other))
        found = find_islands(graph_of(other), 1)
        assert (found is None) == (max(expected, default=0) == 0)
        assert found is None or found.tolist() == expected


def test_long_strips_are_one_island(rng):
    """A snake of triangles in a random order, the longest way that labels can have to go."""
    n = 3000
    faces = np.stack((np.arange(n), np.arange(n) + 1, np.arange(n) + 2), axis=1)
    points = noisy(SurfaceMesh.from_faces(np.arange(3 * n + 6).reshape(-1, 3), faces), rng).vertices
    assert find_islands(graph_of(SurfaceMesh.from_faces(points, faces[rng.permutation(n)]))) is None
    cut = find_islands(graph_of(SurfaceMesh.from_faces(points, np.delete(faces, [1000, 1001], axis=0))), 1)
    assert np.bincount(cut).tolist() == [1000, n - 1002]
