# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What holds for any polygons: edges and corners, neighborhoods, welding."""

import numpy as np
from framelet.core import SurfaceMesh, connect
from framelet.core.mesh.weld import make_weld
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from meshes import faces_of

settings.register_profile("framelet", deadline=None, max_examples=80, derandomize=True, database=None)
settings.load_profile("framelet")

N_VERTICES = 9


def polygons(n_vertices=N_VERTICES, sizes=(3, 5)):
    """Return a strategy for lists of faces, whose corners are different."""
    corner = st.integers(0, n_vertices - 1)
    face = st.lists(corner, min_size=sizes[0], max_size=sizes[1], unique=True)
    return st.lists(face, min_size=1, max_size=8)


def places(n_vertices=N_VERTICES):
    """Return a strategy for positions of which many are the same, multiples of 1/8."""
    step = st.integers(0, 3).map(lambda number: number / 8)
    return st.lists(st.tuples(step, step, step), min_size=n_vertices, max_size=n_vertices)


def points(n_vertices=N_VERTICES):
    return np.random.default_rng(n_vertices).normal(size=(n_vertices, 3))


def edges_of(face):
    return [frozenset(pair) for pair in zip(face, face[1:] + face[:1], strict=True)]


@given(polygons())
def test_faces_come_back_and_corners_name_their_edges(faces):
    mesh = SurfaceMesh.from_faces(points(), faces)
    assert faces_of(mesh) == faces
    edges = [frozenset(edge) for edge in mesh.edges.tolist()]
    assert len(set(edges)) == len(edges)
    assert [edges[k] for k in mesh.corner_edge] == [edge for face in faces for edge in edges_of(face)]


@given(polygons(sizes=(4, 4)))
def test_an_array_of_faces_is_the_same_mesh_as_lists(faces):
    from_lists = SurfaceMesh.from_faces(points(), faces)
    from_array = SurfaceMesh.from_faces(points(), np.array(faces))
    for name in ("corner_vertex", "corner_edge", "face_offset", "edges"):
        assert np.array_equal(getattr(from_lists, name), getattr(from_array, name)), name


@given(polygons())
def test_neighborhoods_are_those_of_the_faces(faces):
    mesh = SurfaceMesh.from_faces(points(), faces)
    connectivity = connect(mesh)
    named = [edge for face in faces for edge in edges_of(face)]
    for v in range(N_VERTICES):
        ring = connectivity.ring_of(v).tolist()
        assert sorted(ring) == sorted(set().union(*(edge for edge in named if v in edge)) - {v})
        assert connectivity.valence[v] == len(ring)
        if connectivity.is_non_manifold[v] or connectivity.is_loose[v]:
            continue
        # Neighbors in turn lie in one face with the vertex, all around unless the ring is open.
        pairs = list(zip(ring, ring[1:] + ring[:1], strict=True))
        for a, b in pairs[:-1] if connectivity.is_boundary[v] else pairs:
            assert any({frozenset((v, a)), frozenset((v, b))} <= set(edges_of(face)) for face in faces)
    assert connectivity.edge_face_count.tolist() == [named.count(frozenset(e)) for e in mesh.edges.tolist()]


@given(polygons(), places(), st.sampled_from([0.0, 0.125, 0.2]), st.sampled_from([0.0, 2.0**20]))
def test_welding_joins_what_is_close_wherever_the_mesh_is(faces, positions, distance, offset):
    positions = np.array(positions) + offset
    try:
        weld = make_weld(SurfaceMesh.from_faces(positions, faces), distance)
    except ValueError:
        assume(False)  # no face is left
    linked = np.linalg.norm(positions[:, None] - positions[None], axis=2) <= distance
    for _ in range(N_VERTICES):
        linked = linked @ linked
    first = linked.argmax(axis=1)  # the first vertex that each one is linked with
    assert np.array_equal(weld.vertex, np.unique(first, return_inverse=True)[1].reshape(-1))
    kept = [k for k, face in enumerate(faces) if len(set(first[face])) >= 3]
    assert set(weld.face.tolist()) <= set(kept)
    for k in set(kept) - set(weld.face.tolist()):
        # Only quads and larger faces that are folded to lines are left out as well.
        assert len(faces[k]) > len(set(first[faces[k]])), faces[k]
