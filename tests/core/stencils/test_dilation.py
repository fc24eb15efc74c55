# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Dilated ring points by the angle rule of section 3.2, against plain breadth-first searches and angles."""

import numpy as np
import pytest
from framelet.core import BANKS, SurfaceMesh, connect, make_stencil
from framelet.core.blocks import Blocks
from framelet.core.mesh.distance_rings import distance_rings, edge_adjacency, face_adjacency
from framelet.core.stencils.dilation import dilate
from framelet.core.stencils.ring_points import one_ring_points, quad_points, triangle_points
from meshes import MESHES, flipped, noisy, quad_grid, quad_torus, triangle_grid, triangle_torus, union
from stars import star
from stencil_twins import MeshTwin, dilated, distances, neighbors_by

TRIANGLES = {
    "irregular torus": lambda: flipped(triangle_torus(10, 12)),
    "irregular grid": lambda: flipped(triangle_grid(10, 9), seed=3),
    "mixed": lambda: union(MESHES["mixed sheet"](), MESHES["three pages"](), MESHES["soup"]()),
}
QUADS = {
    "torus": lambda: quad_torus(9, 10),
    "star": lambda: star(5, 4, 4)[0],
    "mixed": lambda: union(MESHES["mixed sheet"](), star(3, 3, 4)[0], MESHES["prism"]()),
}


def ring_points_at(mesh, level, size, blocks=None):
    """Return near and far ring points of a level, on quads (size 4) or triangles."""
    connectivity = connect(mesh)
    start = (quad_points if size == 4 else triangle_points)(mesh, connectivity)
    adjacency = face_adjacency(mesh, connectivity) if size == 4 else edge_adjacency(connectivity)
    return dilate(start, mesh.vertices, adjacency, level, 1 if size == 4 else 2, blocks or Blocks(1))


@pytest.mark.parametrize("level", [1, 2, 3])
@pytest.mark.parametrize(
    ("size", "name"), [*((3, name) for name in TRIANGLES), *((4, name) for name in QUADS)]
)
def test_matches_the_plain_search(size, name, level, rng):
    """Of every third vertex, so that it does not take long; the mixed meshes have every kind of vertex."""
    mesh = noisy((TRIANGLES if size == 3 else QUADS)[name](), rng)
    twin = MeshTwin(mesh)
    near = neighbors_by(twin, size)
    found, start = ring_points_at(mesh, level, size), ring_points_at(mesh, 0, size)
    offset = found.connectivity.ring_offset
    n_found = n_lost = 0
    for v in range(level % 3, mesh.n_vertices, 3):
        part = slice(offset[v], offset[v + 1])
        for own, first, apart in ((found.near, start.near, 1), (found.far, start.far, 1 if size == 4 else 2)):
            expected = dilated(twin, v, first[part].tolist(), near, level, apart)
            assert own[part].tolist() == expected, v
            n_found += sum(w >= 0 for w in expected)
            n_lost += sum(w < 0 <= f for w, f in zip(expected, first[part].tolist(), strict=True))
    assert n_found > 20 or (level == 3 and n_lost > 20)
    assert found.is_found().sum() == sum(
        (found.near[offset[v] : offset[v + 1]] >= 0).any() for v in range(mesh.n_vertices)
    )


@pytest.mark.parametrize("size", [3, 4])
@pytest.mark.parametrize("largest", [1, 200, 2**22])
def test_rings_are_those_of_a_breadth_first_search(size, largest, rng):
    """In one table, in several smaller ones, and with centers in any order."""
    mesh = union(MESHES["mixed sheet"](), MESHES["soup"](), star(5, 2, size)[0])
    connectivity = connect(mesh)
    adjacency = face_adjacency(mesh, connectivity) if size == 4 else edge_adjacency(connectivity)
    near = neighbors_by(MeshTwin(mesh), size)
    centers = rng.permutation(mesh.n_vertices)[5:]
    rings = distance_rings(adjacency, centers, {1, 3, 4}, centers_at_once=40, largest_table=largest)
    assert set(rings) == {1, 3, 4}
    for row, v in enumerate(centers.tolist()):
        steps = distances(near, v)
        for distance, ring in rings.items():
            expected = sorted(w for w, d in steps.items() if d == distance)
            assert ring.vertex[ring.row == row].tolist() == expected
    assert all(not len(ring.row) for ring in distance_rings(adjacency, centers[:0], {2}).values())


@pytest.mark.parametrize("level", [1, 2, 3])
@pytest.mark.parametrize("bank", ["BOX_SPLINE_111", "LINEAR_SPLINE"])
def test_flat_grids_give_the_lattice(bank, level):
    """Where the 2^l-ring lies inside, the taps are V + 2^l (row, column), at MEAN and STRAIGHT alike."""
    reach = 2**level
    mesh = (quad_grid if bank == "LINEAR_SPLINE" else triangle_grid)(2 * reach + 3, 2 * reach + 4)
    columns = 2 * reach + 4
    inside = [row * columns + column for row in range(reach, reach + 3) for column in range(reach, reach + 4)]
    first = make_stencil(mesh, connect(mesh), bank=BANKS[bank]).data_matrix(mesh.vertices)
    for rule in ("MEAN", "STRAIGHT"):
        taps = make_stencil(mesh, connect(mesh), rule, bank=BANKS[bank], level=level).data_matrix(
            mesh.vertices
        )
        assert np.array_equal(
            taps[:, inside] - taps[0, inside], reach * (first[:, inside] - first[0, inside])
        )


def test_far_members_of_triangles_are_dilated_on_twice_the_ring():
    mesh = triangle_grid(13, 13)
    center = 6 * 13 + 6
    ring_points, start = ring_points_at(mesh, 1, 3), ring_points_at(mesh, 0, 3)
    own = slice(*ring_points.connectivity.ring_offset[[center, center + 1]])
    for found, first in ((ring_points.near, start.near), (ring_points.far, start.far)):
        leap = mesh.vertices[found[own]] - mesh.vertices[center]
        assert np.array_equal(leap, 2 * (mesh.vertices[first[own]] - mesh.vertices[center]))


@pytest.mark.parametrize("names", [(4, 5), (5, 4)])
def test_of_ties_the_lowest_number_wins(names):
    """Two vertices go on from 1, a little to the left and to the right."""
    points = np.zeros((6, 3))
    points[[1, 2, 3]] = (1, 0, 0), (0, 1, 0), (0, -1, 0)
    points[list(names)] = (2, 1, 0), (2, -1, 0)
    left, right = names
    mesh = SurfaceMesh.from_faces(points, [(0, 1, 2), (0, 3, 1), (1, left, 2), (1, 3, right)])
    for turn in (0.0, 0.3, 1.1):  # rounding, which differs from turn to turn, does not decide
        rotation = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
        ring_points = ring_points_at(mesh.with_vertices(points @ rotation), 1, 3)
        ring = ring_points.connectivity.ring_of(0).tolist()
        assert ring_points.near[ring.index(1)] == 4  # vertex 0 owns the first entries


def test_what_is_too_small_for_a_ring_has_no_members():
    """All taps hold the vertex itself, so it carries no detail at this level; other parts do."""
    small, large = MESHES["octahedron"](), triangle_torus(9, 10)
    mesh = union(small, large)
    ring_points = dilate(
        one_ring_points(connect(mesh)), mesh.vertices, edge_adjacency(connect(mesh)), 2, 1, Blocks(1)
    )
    assert not ring_points.is_found()[:6].any()
    assert ring_points.is_found()[6:].all()
    slots = make_stencil(mesh, connect(mesh), level=2).slots
    assert (slots[:, :6] == np.arange(6)).all()
    assert (slots[1:, 6:] != np.arange(6, mesh.n_vertices)).any(axis=0).all()


def test_blocks_do_not_change_members(rng):
    mesh = noisy(union(flipped(triangle_torus()), MESHES["mixed sheet"]()), rng)
    plain = ring_points_at(mesh, 2, 3)
    with Blocks(3, block_size=7 * 64) as blocks:
        blocked = ring_points_at(mesh, 2, 3, blocks)
    assert np.array_equal(plain.near, blocked.near)
    assert np.array_equal(plain.far, blocked.far)


def test_points_in_one_place_but_for_rounding_lead_nowhere():
    """Means put vertices that have the same neighbors into one place; rounding chose a direction there."""
    mesh = triangle_grid(8, 9)
    rng = np.random.default_rng(0)
    points = noisy(mesh, rng).vertices
    near = (9 * 4 + 4, 9 * 4 + 5), (9 * 2 + 4, 9 * 2 + 6)
    for one, other in near:
        points[other] = points[one]
    chosen = []
    for _ in range(8):
        nudged = points.copy()
        for _, other in near:
            nudged[other] += 1e-15 * rng.normal(size=3)
        found = ring_points_at(mesh.with_vertices(nudged), 1, 3)
        chosen.append((found.near.tolist(), found.far.tolist()))
    assert all(choice == chosen[0] for choice in chosen)
