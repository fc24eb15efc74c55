# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The mesh arrays and their geometry, against loops over the faces."""

from dataclasses import fields
from itertools import pairwise
from time import process_time

import numpy as np
import pytest
from checks import edge_length, lengths, random_rotation, read_only, wild_mesh
from framelet.core import SurfaceMesh
from framelet.core.mesh.connectivity import connect
from framelet.core.mesh.edge_list import find_edges
from framelet.core.mesh.geometry import (
    area_rows,
    face_area_vectors,
    face_normals,
    face_tips,
    mean_edge_length,
    unit_vectors,
    vertex_normals,
)
from meshes import MESHES, faces_of, flipped, noisy, prism, quad_torus, soup, triangle_torus
from twins import newell

EVERY = pytest.mark.parametrize("name", MESHES)


@EVERY
def test_arrays_from_lists_of_faces(name):
    mesh = MESHES[name]()
    faces = faces_of(mesh)
    assert [len(face) for face in faces] == mesh.face_sizes().tolist()
    assert (mesh.n_faces, mesh.n_corners) == (len(faces), sum(map(len, faces)))
    following, previous = mesh.next_corner(), mesh.previous_corner()
    for begin, end in pairwise(mesh.face_offset.tolist()):
        for corner in range(begin, end):
            after = begin + (corner - begin + 1) % (end - begin)
            assert following[corner] == after
            assert previous[after] == corner
            ends = mesh.corner_vertex[[corner, after]]
            assert sorted(ends) == sorted(mesh.edges[mesh.corner_edge[corner]])
    assert len({tuple(sorted(edge)) for edge in mesh.edges.tolist()}) == mesh.n_edges
    assert (
        mesh.corner_vertex.dtype
        == mesh.corner_edge.dtype
        == mesh.face_offset.dtype
        == mesh.edges.dtype
        == np.int32
    )


def test_loose_edges_that_a_face_has_too_are_one_edge():
    mesh = SurfaceMesh.from_faces(np.eye(3), [(0, 1, 2)], [(1, 0), (2, 2)])
    assert sorted(mesh.edges.tolist()) == [[0, 1], [0, 2], [1, 2], [2, 2]]


def test_dtype_of_positions():
    for given, kept in (
        (np.float32, np.float32),
        (np.float64, np.float64),
        (np.float16, np.float64),
        (int, np.float64),
    ):
        assert SurfaceMesh.from_faces(np.eye(3, dtype=given), [(0, 1, 2)]).vertices.dtype == kept
    assert SurfaceMesh.from_faces([(0, 0, 0), (1, 0, 0), (0, 1, 0)], np.array([[0, 1, 2]])).n_faces == 1


@pytest.mark.parametrize(
    ("vertices", "faces", "loose", "message"),
    [
        (np.zeros((4, 2)), [(0, 1, 2)], (), r"The positions have shape \(4, 2\); expected \(N, 3\)"),
        (np.zeros(3), [], (), r"The positions have shape \(3,\); expected \(N, 3\)"),
        (np.eye(3), [(0, 1, 3)], (), "Face 0 names vertex 3, but there are 3 vertices"),
        (np.eye(3), [(0, 1, 2), (0, -1, 2)], (), "Face 1 names vertex -1, but there are 3 vertices"),
        (np.eye(3), [], [(0, 7)], "A loose edge names vertex 7, but there are 3 vertices"),
        (np.zeros((0, 3)), [(0, 1, 2)], (), "Face 0 names vertex 0, but there are 0 vertices"),
        (np.eye(3), [[0.5, 1.7, 2.2]], (), "The faces are float64; vertices are given by whole numbers"),
        (np.eye(3), np.eye(3), (), "The faces are float64; vertices are given by whole numbers"),
        (np.eye(3), [[True, False, 2]], (), "The faces contain True or False"),
        (np.eye(3), np.ones((1, 3), bool), (), "The faces are bool; vertices are given by whole numbers"),
        (np.eye(3), [(0, 1, 2), (0, 1)], (), "Face 1 has 2 corners; a face needs three or more"),
        (np.eye(3), np.array([[0, 1]]), (), "Face 0 has 2 corners; a face needs three or more"),
        (np.eye(3), [(0, 0, 0)], (), "Face 0 names vertex 0 twice"),
        (np.eye(4, 3), [(0, 1, 2), (0, 1, 0, 2)], (), "Face 1 names vertex 0 twice"),
        (np.eye(3), [0, 1, 2], (), "The faces are no lists of vertices"),
        (np.eye(3), 3, (), "The faces are 3; expected an array"),
        (np.eye(3), [(0, 1, 2)], [(0.0, 1.0)], "The loose edges are float64"),
        (np.eye(3) > 0, [(0, 1, 2)], (), "The positions are bool; expected real numbers"),
        (np.eye(3), [(0, 1, 2)], [(0, 1), (2,)], r"The loose edges are .*; give an array"),
        (np.eye(3), [(0, 1, (2,))], (), r"The faces are \(0, 1, \(2,\)\); give an array"),
        (np.eye(3), [(0, 1, 2), (0, 1, (2,))], (), r"The faces are \[0, 1, .*\]; give an array"),
    ],
)
def test_wrong_meshes_are_refused(vertices, faces, loose, message):
    with pytest.raises(ValueError, match=message):
        SurfaceMesh.from_faces(vertices, faces, loose)


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("vertices", np.zeros((4, 2)), r"The positions have shape \(4, 2\)"),
        ("vertices", np.zeros((4, 3), int), "The positions are int64; expected float32 or float64"),
        ("corner_vertex", np.array([0, 1, 2, 3.0]), "corner_vertex is float64 of shape"),
        ("corner_vertex", [0, 1, 2, 3], "corner_vertex is <class 'list'>; expected int32"),
        ("corner_vertex", np.array([0, 1, 2, 9], np.int32), "Face 0 names vertex 9"),
        ("corner_vertex", np.array([0, 1, 0, 3], np.int32), "Face 0 names vertex 0 twice"),
        ("corner_edge", np.array([0, 1, 2, 9], np.int32), "A corner names edge 9, but there are 4 edges"),
        ("corner_edge", np.array([0, 1, 2], np.int32), "There are 4 corner vertices, but 3 corner edges"),
        (
            "corner_edge",
            np.zeros(4, np.int32),
            "Corner 1 runs from vertex 1 to 2, but its edge 0 joins 0 and 1",
        ),
        ("face_offset", np.array([0, 2, 4], np.int32), "Face 0 has 2 corners"),
        (
            "face_offset",
            np.array([0, 9], np.int32),
            "face_offset must ascend from 0 to the number of corners, 4",
        ),
        ("face_offset", np.zeros(0, np.int32), "face_offset must ascend"),
        ("edges", np.zeros((4, 3), np.int32), r"edges has shape \(4, 3\); expected \(E, 2\)"),
        ("edges", np.array([[0, 1], [0, 3], [1, 2], [2, 7]], np.int32), "An edge names vertex 7"),
    ],
)
def test_arrays_that_do_not_fit_each_other_are_refused(name, value, message):
    mesh = SurfaceMesh.from_faces(np.eye(4, 3), [(0, 1, 2, 3)])
    arrays = {item.name: getattr(mesh, item.name) for item in fields(SurfaceMesh)}
    assert SurfaceMesh(**arrays).n_faces == 1
    with pytest.raises(ValueError, match=message):
        SurfaceMesh(**(arrays | {name: value}))


def test_faces_as_an_array_are_the_same_mesh_as_lists(rng):
    for mesh in (triangle_torus(), quad_torus()):
        faces = faces_of(mesh)
        for given in (
            faces,
            np.array(faces),
            np.array(faces, np.uint16),
            [np.array(f) for f in faces],
            iter(faces),
        ):
            other = SurfaceMesh.from_faces(mesh.vertices, given)
            for item in fields(SurfaceMesh):
                assert np.array_equal(getattr(other, item.name), getattr(mesh, item.name))


@pytest.mark.parametrize("n_vertices", [40, 2**31 - 1])
def test_edges_match_a_set(n_vertices, rng):
    """The second size is too large for the numbers that are sorted at once."""
    start, end = rng.integers(0, 40, (2, 300)) + n_vertices - 40
    edges, corner_edge = find_edges(start, end, np.array([[n_vertices - 1, n_vertices - 40]]), n_vertices)
    pairs = {(min(a, b), max(a, b)) for a, b in zip(start.tolist(), end.tolist(), strict=True)}
    assert edges.tolist() == sorted(map(list, pairs | {(n_vertices - 40, n_vertices - 1)}))
    assert np.array_equal(edges[corner_edge], np.sort(np.stack((start, end), axis=1), axis=1))


def test_faces_as_an_array_are_read_faster_than_their_neighborhoods():
    n = 708
    corner = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).reshape(-1, 1)
    faces = corner[:, None] + np.array([[0, n, n + 1], [0, n + 1, 1]])
    faces = faces.reshape(-1, 3)
    points = np.zeros((n * n, 3), np.float32)

    def seconds(work):
        best = np.inf
        for _ in range(3):
            began = process_time()
            work()
            best = min(best, process_time() - began)
        return best

    mesh = SurfaceMesh.from_faces(points, faces)
    # It takes 0.8 times as long; what is above 1 is for busy machines.
    assert seconds(lambda: SurfaceMesh.from_faces(points, faces)) < 1.5 * seconds(lambda: connect(mesh))


def test_other_positions_for_the_same_faces():
    mesh = read_only(triangle_torus())
    other = mesh.with_vertices(mesh.vertices + 1)
    assert other.corner_vertex is mesh.corner_vertex
    assert np.array_equal(other.vertices, mesh.vertices + 1)
    with pytest.raises(ValueError, match=r"The positions have shape \(5, 3\); expected \(192, 3\)"):
        mesh.with_vertices(np.zeros((5, 3)))


@EVERY
@pytest.mark.parametrize("shift", [0.0, 1e7])
def test_areas_and_lengths(name, shift, rng):
    mesh = noisy(MESHES[name](), rng)
    mesh = read_only(mesh.with_vertices(mesh.vertices + shift))
    tolerance = 1e-13 if not shift else 1e-7
    areas, normals = face_area_vectors(mesh), face_normals(mesh)
    sums = np.zeros((mesh.n_vertices, 3))
    for f, face in enumerate(faces_of(mesh)):
        points = mesh.vertices[face]
        area = newell(points)
        assert np.abs(areas[f] - area).max() < tolerance
        size = np.linalg.norm(area)
        if size > 1e-6:
            assert np.abs(normals[f] - area / size).max() < tolerance / size
        for v in face:
            sums[v] += area
    found = vertex_normals(mesh)
    size = lengths(sums)
    for v in np.flatnonzero(size > 1e-3):
        assert np.abs(found[v] - sums[v] / size[v]).max() < 10 * tolerance / size[v]
    assert (found[size == 0] == 0).all()
    assert mean_edge_length(mesh) == pytest.approx(edge_length(mesh), rel=1e-12)


def test_area_vectors_of_triangles_and_quads(rng):
    """Half the cross product of two edges, and half that of the diagonals, also of a bent quad."""
    points = rng.normal(size=(7, 3))
    area = face_area_vectors(SurfaceMesh.from_faces(points, [(0, 1, 2), (3, 4, 5, 6)]))
    assert np.abs(area[0] - 0.5 * np.cross(points[1] - points[0], points[2] - points[0])).max() < 1e-14
    assert np.abs(area[1] - 0.5 * np.cross(points[5] - points[3], points[6] - points[4])).max() < 1e-14


def test_a_closed_surface_has_no_total_area_vector(rng):
    for mesh in (flipped(triangle_torus()), quad_torus(), prism()):
        assert np.abs(face_area_vectors(noisy(mesh, rng)).sum(axis=0)).max() < 1e-12


def slow_volume(mesh):
    """Return the sum of signed tetrahedra over fans around the centers of the faces."""
    total = 0.0
    for face in faces_of(mesh):
        points = mesh.vertices[face]
        center = points.mean(axis=0)
        for k in range(len(face)):
            total += np.linalg.det([center, points[k - 1], points[k]]) / 6
    return total


def volume_of(mesh):
    """Return the volume as `FaceFlips` finds it, relative to the first corner."""
    points = (mesh.vertices - mesh.vertices[:1]).T.astype(float)
    areas = area_rows(points, mesh, 0, mesh.n_faces)
    return float((face_tips(points, mesh, 0, mesh.n_faces) * areas).sum()) / 3


@pytest.mark.parametrize("make", [lambda: flipped(triangle_torus()), quad_torus, prism])
def test_volume(make, rng):
    mesh = noisy(make(), rng)
    expected = slow_volume(mesh)
    assert volume_of(mesh) == pytest.approx(expected, rel=1e-12)
    assert volume_of(mesh.with_vertices(-mesh.vertices)) == pytest.approx(-expected, rel=1e-12)
    assert volume_of(mesh.with_vertices(mesh.vertices + 1e6)) == pytest.approx(expected, rel=1e-6)
    assert volume_of(mesh.with_vertices(mesh.vertices @ random_rotation(rng))) == pytest.approx(expected)


def test_volume_of_known_bodies():
    cube = prism(4)
    assert abs(volume_of(cube)) == pytest.approx(2.0, rel=1e-14)  # its base is a square of diagonal 2
    assert abs(volume_of(MESHES["octahedron"]())) == pytest.approx(4 / 3, rel=1e-14)
    assert volume_of(SurfaceMesh.from_faces(np.eye(3), [])) == 0.0


def test_meshes_without_faces_and_faces_without_area():
    bare = SurfaceMesh.from_faces(np.eye(3), [])
    assert mean_edge_length(bare) == 0.0
    assert face_area_vectors(bare).shape == (0, 3)
    assert (vertex_normals(bare) == 0).all()
    odd = wild_mesh(np.eye(3), [(0, 1), (2,), (), (0, 0, 0), (0, 1, 2), ()])
    assert (face_normals(odd)[[0, 1, 2, 3, 5]] == 0).all()
    assert lengths(face_normals(odd)[4]) == pytest.approx(1.0)
    assert np.isfinite(face_area_vectors(odd)).all()
    assert np.isfinite(vertex_normals(soup(1, shortest=1))).all()


@pytest.mark.parametrize("shift", [0.0, 0.3, 100.0])
def test_a_face_there_and_back_again_has_no_area(shift, rng):
    """Each of its steps is taken back; what was left of their sum was rounding, which pointed anywhere."""
    points = rng.normal(size=(80, 3)) + shift
    mesh = wild_mesh(points, [(k, k + 1, k + 2, k + 3, k + 2, k + 1) for k in range(0, 80, 4)])
    assert not face_area_vectors(mesh).any()
    assert not vertex_normals(mesh).any()


def test_zero_vectors_stay_zero():
    vectors = np.array([[0.0, 0.0, 0.0], [0.0, 3.0, 4.0]])
    assert unit_vectors(vectors).tolist() == [[0.0, 0.0, 0.0], [0.0, 0.6, 0.8]]
