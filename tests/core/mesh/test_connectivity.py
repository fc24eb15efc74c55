# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""One-rings, boundaries and defects against a walk around every vertex by loops."""

import numpy as np
import pytest
from checks import read_only
from framelet.core.blocks import Blocks
from framelet.core.mesh.connectivity import connect
from framelet.core.mesh.surface_mesh import SurfaceMesh
from framelet.core.mesh.winding import wound_alike
from meshes import MESHES, bow_tie, clean_soup, faces_of, pyramid, soup, triangle_torus, turned_over, union
from twins import fans


def assert_matches_twin(mesh):
    """Fail unless the connectivity of a mesh is what walking around every vertex finds."""
    connectivity = connect(mesh)
    faces = faces_of(mesh)
    neighbors = [set() for _ in range(mesh.n_vertices)]
    count = {tuple(sorted(edge)): 0 for edge in mesh.edges.tolist()}
    sizes = [set() for _ in range(mesh.n_vertices)]
    for face in faces:
        for a, b in zip(face, face[1:] + face[:1], strict=True):
            count[tuple(sorted((a, b)))] += 1
            sizes[a].add(len(face))
            neighbors[a] |= {b} - {a}
            neighbors[b] |= {a} - {b}
    assert connectivity.edge_face_count.tolist() == [count[tuple(sorted(e))] for e in mesh.edges.tolist()]
    rim = {v for edge, n in count.items() if n == 1 for v in edge}
    assert set(np.flatnonzero(connectivity.is_boundary)) == rim
    wound = wound_alike(mesh)  # see test_winding.py
    for v, fan in enumerate(fans(mesh if wound is None else wound.surface)):
        ring = connectivity.ring_of(v).tolist()
        ends = connectivity.boundary_neighbors[v].tolist()
        assert connectivity.valence[v] == len(ring) == len(neighbors[v])
        assert bool(connectivity.is_loose[v]) == (not sizes[v])
        assert bool(connectivity.all_triangles[v]) == (sizes[v] == {3})
        assert bool(connectivity.all_quads[v]) == (sizes[v] == {4})
        assert bool(connectivity.is_non_manifold[v]) == (fan is None and bool(sizes[v])), v
        corners = connectivity.ring_corner[
            connectivity.ring_offset[v] : connectivity.ring_offset[v + 1]
        ].tolist()
        if fan is None:
            assert ring == sorted(neighbors[v])
            assert set(corners) <= {-1}
            assert ends == [-1, -1]
            continue
        expected, is_open, is_twisted = fan
        assert same_ring(ring, expected, is_open, is_twisted), (v, ring, expected)
        assert ends == ([ring[0], ring[-1]] if is_open else [-1, -1])
        assert_corners_between(mesh, v, ring, corners, is_open)


def same_ring(ring, expected, is_open, is_twisted):
    """Return whether a ring is the expected one, and starts where it should."""
    if is_open:
        return ring == expected or (is_twisted and ring == expected[::-1])
    turned = []
    for candidate in (expected, expected[::-1]) if is_twisted else (expected,):
        at = candidate.index(min(candidate))
        turned.append(candidate[at:] + candidate[:at])
    return ring in turned


def assert_corners_between(mesh, v, ring, corners, is_open):
    """Fail unless each corner lies at v, between one ring vertex and the next one."""
    following, previous = mesh.next_corner(), mesh.previous_corner()
    wanted = len(ring) - is_open
    assert len(set(corners[:wanted])) == wanted
    for k, corner in enumerate(corners):
        if k == wanted:
            assert corner == -1
            continue
        assert mesh.corner_vertex[corner] == v
        sides = {mesh.corner_vertex[following[corner]], mesh.corner_vertex[previous[corner]]}
        assert sides == {ring[k], ring[(k + 1) % len(ring)]}


@pytest.mark.parametrize("name", MESHES)
def test_rings_match_the_loop_twin(name):
    assert_matches_twin(read_only(MESHES[name]()))


@pytest.mark.parametrize("shortest", [1, 2, 3])
@pytest.mark.parametrize("seed", range(15))
def test_rings_of_polygon_soups(seed, shortest):
    assert_matches_twin(soup(seed, shortest=shortest))


def test_rings_of_triangle_soups_of_distinct_vertices():
    n_manifold = 0
    for seed in range(40):
        mesh = clean_soup(seed, n_vertices=8 + seed % 7)
        assert_matches_twin(mesh)
        n_manifold += sum(fan is not None for fan in fans(mesh))
    assert n_manifold > 60  # else these soups would only have tested the unordered case


def test_rings_of_many_fans_at_one_vertex():
    assert_matches_twin(bow_tie(100))


@pytest.mark.parametrize("closed", [True, False])
@pytest.mark.parametrize("sides", [31, 32, 33, 34, 300])
@pytest.mark.parametrize("reversed_share", [0.0, 0.4])
def test_rings_of_high_valence(sides, closed, reversed_share):
    assert_matches_twin(turned_over(pyramid(sides, closed), share=reversed_share))


@pytest.mark.parametrize("closed", [True, False])
def test_ring_of_5000_spokes(closed):
    """Long walks are ranked by pointer doubling; several at once, among other fans."""
    n, many = 5000, pyramid(5000, closed)
    mesh = union(many, triangle_torus(3, 3), many, bow_tie(2, 40))
    connectivity = connect(mesh)
    for hub in (0, n + 1 + 9):
        assert connectivity.ring_of(hub).tolist() == list(range(hub + 1, hub + n + 1))
        assert not connectivity.is_non_manifold[hub]
    hub = 2 * (n + 1) + 9
    assert connectivity.is_non_manifold[hub]
    assert connectivity.ring_of(hub).tolist() == list(range(hub + 1, hub + 83))


def test_ring_order_does_not_depend_on_the_scrambling_of_a_long_fan(rng):
    new = rng.permutation(5001)
    faces = [new[face] for face in faces_of(pyramid(5000, closed=True))]
    mesh = SurfaceMesh.from_faces(np.zeros((5001, 3)), [faces[k] for k in rng.permutation(5000)])
    ring = connect(mesh).ring_of(new[0])
    at = ring[np.argsort(new)[ring] == 1]
    expected = np.roll(new[1:], -int(np.argmin(new[1:])))
    assert len(at) == 1
    assert ring.tolist() == expected.tolist()


def test_blocks_and_threads_do_not_change_the_rings():
    mesh = union(turned_over(triangle_torus(), seed=1), bow_tie(3), pyramid(40, closed=True), soup(2))
    plain = connect(mesh)
    with Blocks(2, block_size=7) as blocks:
        blocked = connect(mesh, blocks)
    for name in (
        "ring",
        "ring_corner",
        "ring_offset",
        "is_non_manifold",
        "boundary_neighbors",
        "face_across",
    ):
        assert np.array_equal(getattr(plain, name), getattr(blocked, name)), name


@pytest.mark.parametrize("name", MESHES)
def test_faces_across_edges(name):
    mesh = MESHES[name]()
    across = connect(mesh).face_across
    owner = np.repeat(np.arange(mesh.n_faces), mesh.face_sizes())
    for corner, edge in enumerate(mesh.corner_edge):
        others = [owner[c] for c in np.flatnonzero(mesh.corner_edge == edge) if c != corner]
        is_loop = mesh.edges[edge][0] == mesh.edges[edge][1]
        assert across[corner] == (others[0] if len(others) == 1 and not is_loop else -1)


def test_defects_are_listed():
    mesh = MESHES["three pages"]()
    connectivity = connect(mesh)
    assert mesh.edges[connectivity.edge_face_count > 2].tolist() == [[11, 12]]
    assert np.flatnonzero(connectivity.is_non_manifold).tolist() == [11, 12]
    mesh = MESHES["mixed sheet"]()
    connectivity = connect(mesh)
    assert mesh.edges[connectivity.loose_edges()].tolist() == [[42, 43]]
    assert np.flatnonzero(connectivity.is_loose).tolist() == [42, 43, 44]


@pytest.mark.parametrize(
    ("name", "closed"),
    [
        ("tetrahedron", True),
        ("prism", True),
        ("closed fan", False),
        ("moebius strip", False),
        ("three pages", False),
    ],
)
def test_closedness(name, closed):
    assert connect(MESHES[name]()).is_closed is closed


def test_a_mesh_without_faces_has_no_rings():
    connectivity = connect(SurfaceMesh.from_faces(np.zeros((3, 3)), [], [(0, 1)]))
    assert connectivity.is_loose.all()
    assert not len(connectivity.ring)
    assert not connectivity.is_closed
    assert connectivity.edge_face_count.tolist() == [0]
