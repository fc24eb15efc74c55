# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The points under the masks, against the rules of section 3.1 and 4.2 written as loops."""

from itertools import permutations

import numpy as np
import pytest
from checks import read_only
from framelet.core.blocks import Blocks
from framelet.core.frames import BANKS
from framelet.core.mesh.connectivity import connect
from framelet.core.stencils import make_stencil, straight
from framelet.core.stencils.builder import StencilBuilder
from meshes import (
    MESHES,
    bow_tie,
    faces_of,
    flipped,
    noisy,
    pyramid,
    soup,
    triangle_grid,
    triangle_torus,
    union,
)
from twins import PAIRS, completed_ring, fans, straight_pairs

EXACT = 1e-12

IRREGULAR = {
    **MESHES,
    "long open fan": lambda: pyramid(40),
    "long closed fan": lambda: pyramid(41, closed=True),
    "soup 5": lambda: soup(5),
    "many fans": lambda: bow_tie(20),
}


def stencil_of(mesh, rule, boundary="FREE", blocks=None):
    return make_stencil(mesh, connect(mesh), rule, boundary, blocks)


def points_of(mesh, rule, boundary="FREE"):
    """Return the data-matrix as (N, T, 3)."""
    return stencil_of(mesh, rule, boundary).data_matrix(mesh.vertices).transpose(1, 0, 2)


def regular_vertices(mesh):
    """Return the vertices with a closed fan of six triangles."""
    sizes = [set() for _ in range(mesh.n_vertices)]
    for face in faces_of(mesh):
        for v in face:
            sizes[v].add(len(face))
    return {
        v
        for v, fan in enumerate(fans(mesh))
        if fan is not None and not fan[1] and len(fan[0]) == 6 and sizes[v] == {3}
    }


def same_pairs(taps, expected):
    """Return whether taps (7, 3) hold pairs of points, in any order of pairs and within pairs."""
    pairs = [(taps[a], taps[b]) for a, b in PAIRS]
    for order in permutations(expected):
        if all(
            any(np.allclose(pair, way, rtol=0, atol=EXACT) for way in (other, other[::-1]))
            for pair, other in zip(pairs, order, strict=True)
        ):
            return True
    return False


@pytest.mark.parametrize("name", IRREGULAR)
def test_mean_rule(name, rng):
    mesh = read_only(noisy(IRREGULAR[name](), rng))
    connectivity = connect(mesh)
    stencil = stencil_of(mesh, "MEAN")
    points = stencil.data_matrix(mesh.vertices).transpose(1, 0, 2)
    regular_ones = regular_vertices(mesh)
    for v in range(mesh.n_vertices):
        ring = connectivity.ring_of(v)
        regular = v in regular_ones
        assert stencil.is_irregular[v] == (not regular and not connectivity.is_loose[v])
        if regular:
            expected = mesh.vertices[ring]
        elif len(ring) < 2:
            expected = np.repeat(mesh.vertices[v][None], 6, axis=0)
        else:
            expected = np.repeat(mesh.vertices[ring].mean(axis=0)[None], 6, axis=0)
        assert np.allclose(points[v], [mesh.vertices[v], *expected], rtol=0, atol=EXACT)


@pytest.mark.parametrize("name", IRREGULAR)
def test_straight_rule(name, rng):
    mesh = read_only(noisy(IRREGULAR[name](), rng))
    connectivity = connect(mesh)
    points = points_of(mesh, "STRAIGHT")
    mean = points_of(mesh, "MEAN")
    regular_ones = regular_vertices(mesh)
    for v, fan in enumerate(fans(mesh)):
        ring = connectivity.ring_of(v).tolist()
        if v in regular_ones:
            expected = [tuple(mesh.vertices[[ring[k], ring[k + 3]]]) for k in range(3)]
        elif len(ring) >= 3 and fan is not None and connectivity.all_triangles[v] and len(ring) < 5:
            six = completed_ring(mesh.vertices, ring)
            expected = [(six[k], six[k + 3]) for k in range(3)]
        elif len(ring) >= 4:
            expected = [tuple(mesh.vertices[list(pair)]) for pair in straight_pairs(mesh.vertices, v, ring)]
            if len(ring) == 4:  # no ring edges to halve: the mean fills the third pair
                expected.append(tuple(mean[v][[1, 1]]))
        else:
            assert np.array_equal(points[v], mean[v])
            continue
        assert same_pairs(points[v], expected), v
        assert np.array_equal(points[v][0], mesh.vertices[v])


def test_straight_rule_on_every_valence(rng):
    """The pairs of one vertex each of valence 3 to 12, noisy, inside a closed fan; most get no ties."""
    for sides in range(3, 13):
        mesh = noisy(pyramid(sides, closed=True), rng, 0.3)
        points = points_of(mesh, "STRAIGHT")[0]
        if sides < 5:
            six = completed_ring(mesh.vertices, list(range(1, sides + 1)))
            expected = [(six[k], six[k + 3]) for k in range(3)]
        elif sides == 6:
            expected = [(mesh.vertices[k], mesh.vertices[k + 3]) for k in (1, 2, 3)]
        else:
            pairs = straight_pairs(mesh.vertices, 0, list(range(1, sides + 1)))
            expected = [tuple(mesh.vertices[list(pair)]) for pair in pairs]
        assert same_pairs(points, expected), sides


def test_straight_rule_gives_up_above_the_highest_valence(rng):
    limit = straight.HIGHEST_VALENCE
    for sides, takes_mean in ((limit, False), (limit + 1, True)):
        mesh = noisy(pyramid(sides, closed=True), rng)
        is_mean = np.array_equal(points_of(mesh, "STRAIGHT")[0], points_of(mesh, "MEAN")[0])
        assert is_mean is takes_mean


@pytest.mark.parametrize("boundary", ["ALONG", "FIXED"])
@pytest.mark.parametrize("rule", ["MEAN", "STRAIGHT"])
@pytest.mark.parametrize("name", IRREGULAR)
def test_boundary_rule(name, rule, boundary, rng):
    """The rim is one straight pair, everything else is mirrored: 2 V - P lies opposite P."""
    mesh = noisy(IRREGULAR[name](), rng)
    points, free = points_of(mesh, rule, boundary), points_of(mesh, rule)
    connectivity = connect(mesh)
    for v, fan in enumerate(fans(mesh)):
        if fan is None or not fan[1]:
            assert np.array_equal(points[v], free[v])  # the border changes nothing elsewhere
            continue
        ring, center = mesh.vertices[connectivity.ring_of(v)], mesh.vertices[v]
        assert np.allclose(points[v][[1, 4]], ring[[0, -1]], rtol=0, atol=EXACT)
        inner = ring[1:-1]
        if not len(inner):
            assert np.array_equal(points[v][[2, 3, 5, 6]], np.repeat(center[None], 4, axis=0))
            continue
        near = max((len(inner) + 1) // 3, 1) - 1
        two = inner[[near, -1 - near]]
        if rule == "MEAN" and len(inner) > 2:
            two = np.repeat(inner.mean(axis=0)[None], 2, axis=0)
        assert np.allclose(points[v][[2, 3]], two, rtol=0, atol=EXACT)
        assert np.allclose(points[v][[5, 6]], 2 * center - two, rtol=0, atol=EXACT)


def test_regular_rings_start_at_the_lowest_neighbor():
    mesh = triangle_torus()
    slots = stencil_of(mesh, "STRAIGHT").slots
    assert (slots[0] == np.arange(mesh.n_vertices)).all()
    assert (slots[1] == slots[1:].min(axis=0)).all()
    for v, (ring, _, _) in enumerate(fans(mesh)):
        at = ring.index(min(ring))
        assert slots[1:, v].tolist() == ring[at:] + ring[:at]


def test_virtual_points_are_affine_combinations(rng):
    mesh = union(*(build() for build in IRREGULAR.values()))
    stencil = stencil_of(mesh, "STRAIGHT", "ALONG")
    counts = np.diff(stencil.virtual_offset)
    assert counts.min() > 0
    weights = np.add.reduceat(stencil.virtual_weight, stencil.virtual_offset[:-1])
    assert np.abs(weights - 1.0).max() < EXACT
    vertices = rng.normal(size=(mesh.n_vertices, 3))
    points = stencil.extended(vertices)
    assert points.shape == (3, stencil.n_points)
    for x in range(len(counts)):
        part = slice(stencil.virtual_offset[x], stencil.virtual_offset[x + 1])
        expected = sum(
            w * vertices[v]
            for v, w in zip(stencil.virtual_vertex[part], stencil.virtual_weight[part], strict=True)
        )
        assert np.allclose(points[:, stencil.n_vertices + x], expected, rtol=0, atol=EXACT)
    with Blocks(2, block_size=5) as blocks:
        assert np.array_equal(points, stencil.extended(vertices, blocks))


def test_blocks_do_not_change_a_stencil(rng, monkeypatch):
    mesh = noisy(union(flipped(triangle_torus()), MESHES["soup"](), pyramid(200)), rng)
    plain = stencil_of(mesh, "STRAIGHT", "ALONG")
    with Blocks(2, block_size=3) as blocks:
        blocked = stencil_of(mesh, "STRAIGHT", "ALONG", blocks)
    for name in ("slots", "virtual_offset", "virtual_vertex", "virtual_weight"):
        assert np.array_equal(getattr(plain, name), getattr(blocked, name)), name


def test_slots_that_nobody_sets_hold_the_vertex():
    stencil = StencilBuilder(4, BANKS["BOX_SPLINE_111"].offsets).finish()
    assert stencil.n_points == 4
    assert (stencil.slots == np.arange(4)).all()
    assert np.array_equal(stencil.data_matrix(np.eye(4, 3)), np.repeat(np.eye(4, 3)[None], 7, axis=0))


def test_flat_border_of_a_regular_grid_has_no_second_differences():
    """Along a straight, even rim nothing is left to shrink, so it stays."""
    mesh = triangle_grid(5, 6)
    points = points_of(mesh, "STRAIGHT", "ALONG")
    corners = [0, 5, 24, 29]
    for v in set(range(mesh.n_vertices)) - set(corners):
        for a, b in PAIRS:
            assert np.array_equal(points[v][a] + points[v][b], 2 * mesh.vertices[v])


def test_an_unknown_rule_is_refused():
    mesh = triangle_grid()
    with pytest.raises(ValueError, match=r"The stencil is 'BEST'; choose one of MEAN, STRAIGHT"):
        make_stencil(mesh, connect(mesh), "BEST")


@pytest.mark.parametrize("valence", [3, 4, 5, 7])
def test_longest_edges_match_a_loop(valence, rng):
    points = rng.integers(0, 3, (30, 3)).astype(float)  # on a grid, so that there are equals
    rings = np.array([rng.choice(30, valence, replace=False) for _ in range(200)]).T.astype(np.int32)
    for n_edges in range(valence + 1):
        found = straight.longest_edges(points, rings, n_edges)
        for ring, code in zip(rings.T, found, strict=True):
            lengths = [
                np.linalg.norm(points[ring[(k + 1) % valence]] - points[ring[k]]) for k in range(valence)
            ]
            order = sorted(range(valence), key=lambda k: -lengths[k])
            assert code == sum(1 << k for k in order[:n_edges])
