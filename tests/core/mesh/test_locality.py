# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Renumbering for locality: the same mesh comes back, and only scattered meshes are renumbered."""

from dataclasses import fields

import numpy as np
import pytest
from checks import assert_same_bits, read_only, wild_mesh
from framelet.core import SurfaceMesh
from framelet.core.blocks import Blocks
from framelet.core.mesh.locality import is_scattered, reorder, spatial_order
from meshes import MESHES, faces_of, triangle_torus

EVERY = pytest.mark.parametrize("name", MESHES)


@EVERY
def test_a_renumbered_mesh_is_the_same_mesh(name, rng):
    mesh = read_only(MESHES[name]())
    for order in (rng.permutation(mesh.n_vertices), spatial_order(mesh.vertices)):
        found = reorder(mesh, order)
        new = found.surface
        assert_same_bits(new.vertices, mesh.vertices[order])
        assert_same_bits(found.vertices_back(new.vertices), mesh.vertices)
        assert sorted(found.face_order.tolist()) == list(range(mesh.n_faces))
        old_faces = faces_of(mesh)
        renamed = [[int(found.vertex_order[v]) for v in face] for face in faces_of(new)]
        assert renamed == [list(old_faces[face]) for face in found.face_order]
        # The edge of each corner still joins its ends, and loose edges are still there.
        ends = np.stack((new.corner_vertex, new.corner_vertex[new.next_corner()]), axis=1)
        assert (np.sort(ends) == np.sort(new.edges[new.corner_edge])).all()
        assert {frozenset(found.vertex_order[edge].tolist()) for edge in new.edges} == {
            frozenset(edge) for edge in mesh.edges.tolist()
        }
        for item in fields(SurfaceMesh):
            a, b = getattr(new, item.name), getattr(mesh, item.name)
            assert a.dtype == b.dtype
            assert a.shape == b.shape


def test_the_curve_visits_every_vertex_and_keeps_neighbors_close(rng):
    points = rng.random((5000, 3)).astype(np.float32)
    order = spatial_order(points)
    assert sorted(order.tolist()) == list(range(5000))
    steps = np.linalg.norm(np.diff(points[order], axis=0), axis=1)
    assert np.median(steps) < 0.15  # two random points of a cube are 0.66 apart
    assert len(spatial_order(points[:0])) == 0


def test_the_curve_is_the_z_order_of_its_cells(rng):
    """Against interleaving the bits one by one."""
    points = rng.random((300, 3)) * (1.0, 0.5, 0.25)
    cells = ((points - points.min(axis=0)) * (1023 / np.ptp(points, axis=0).max())).astype(int)
    keys = [
        sum(((int(cell[axis]) >> bit) & 1) << (3 * bit + axis) for bit in range(10) for axis in range(3))
        for cell in cells
    ]
    assert spatial_order(points).tolist() == sorted(range(300), key=lambda k: keys[k])


@pytest.mark.parametrize("scale", [0.0, 1e-30, 1e30, 1e308])
def test_the_curve_serves_meshes_of_any_size(scale, rng):
    points = rng.random((100, 3)) * scale - 0.5 * scale
    assert sorted(spatial_order(points).tolist()) == list(range(100))


def test_only_large_scattered_meshes_are_renumbered(rng):
    mesh = triangle_torus(120, 100)
    shuffled = reorder(mesh, rng.permutation(mesh.n_vertices)).surface
    faces = rng.permutation(np.array(faces_of(shuffled)))
    shuffled = wild_mesh(shuffled.vertices, faces)
    assert not is_scattered(shuffled)
    assert is_scattered(shuffled, 1000)
    assert not is_scattered(mesh, 1000)
    assert not is_scattered(reorder(shuffled, spatial_order(shuffled.vertices)).surface, 1000)
    assert not is_scattered(SurfaceMesh.from_faces(np.zeros((2000, 3)), [(0, 1, 2)]), 1000)


def test_threads_do_not_change_the_numbers(rng):
    mesh = triangle_torus(20, 30)
    order = rng.permutation(mesh.n_vertices)
    one = reorder(mesh, order)
    with Blocks(3, block_size=100) as blocks:
        many = reorder(mesh, order, blocks)
    for a, b in zip(vars(one.surface).values(), vars(many.surface).values(), strict=True):
        assert_same_bits(a, b)
    assert_same_bits(one.face_order, many.face_order)
