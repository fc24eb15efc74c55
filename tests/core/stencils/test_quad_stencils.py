# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The nine points of quad lattices, and of 3x3 on triangles, against sections 3.1, 3.3 and 5.4 as loops."""

from itertools import combinations

import numpy as np
import pytest
from checks import read_only
from framelet.core import BANKS, FilterBank, connect, make_stencil
from meshes import MESHES, flipped, noisy, quad_grid, triangle_grid, triangle_torus, turned_over, union
from stars import star
from stencil_twins import MeshTwin
from twins import angle_cosine

EXACT = 1e-12

QUADS = {
    "quad torus": MESHES["quad torus"],
    "quad grid": quad_grid,
    "mixed sheet": MESHES["mixed sheet"],
    "prism": MESHES["prism"],
    "three pages": MESHES["three pages"],
    "turned-over sheet": MESHES["turned-over sheet"],
    "turned-over stars": lambda: turned_over(QUADS["stars"](), seed=4),
    "stars": lambda: union(*(star(valence, 2, 4)[0] for valence in (3, 5, 6, 7, 8, 11))),
}
NINE = FilterBank("TENSOR", "TRIANGLES", BANKS["LINEAR_SPLINE"].offsets, BANKS["LINEAR_SPLINE"].masks)


def points_of(mesh, rule, boundary="FREE", bank=BANKS["LINEAR_SPLINE"]):
    """Return the data-matrix as (N, 9, 3); its taps 1 to 8 run around the vertex."""
    return (
        make_stencil(mesh, connect(mesh), rule, boundary, bank=bank)
        .data_matrix(mesh.vertices)
        .transpose(1, 0, 2)
    )


def mean_taps(twin, v, points):
    """Return the nine points by the MEAN rule: near and far means in turn."""
    near = twin.ring[v]
    if len(near) < 2:
        return np.tile(points[v], (9, 1))
    far = [w for w in twin.between(v, 4) if w >= 0]
    one, two = points[near].mean(axis=0), points[far or near].mean(axis=0)
    return np.array([points[v], *[one, two] * 4])


def rim_of(twin, v):
    """Return near and far members in turn."""
    return [w for pair in zip(twin.ring[v], twin.between(v, 4), strict=True) for w in pair]


def straight_eight(points, v, rim):
    """Return the eight points of Algorithm-Quad-2 in ring order, a near one first."""
    if len(rim) == 6:
        edges = [(rim[k], rim[(k + 1) % 6]) for k in range(6)]
        longest = sorted(edges, key=lambda e: -np.linalg.norm(points[e[0]] - points[e[1]]))[:2]
        eight = []
        for a, b in edges:
            eight += [points[a]] + ([0.5 * (points[a] + points[b])] if (a, b) in longest else [])
    else:
        left = list(rim)
        for _ in range(4):
            pair = min(combinations(left, 2), key=lambda pair: angle_cosine(points, v, *pair))
            left = [w for w in left if w not in pair]
        eight = [points[w] for w in rim if w not in left]
    spokes = [np.linalg.norm(point - points[v]) for point in eight]
    drop_first = sum(spokes[0::2]) > sum(spokes[1::2])
    return np.array(eight[1:] + eight[:1] if drop_first else eight)


def same_ring(taps, expected):
    """Return whether eight points agree when the ring is turned by whole quads."""
    return any(
        np.allclose(taps, np.roll(expected, -turn, axis=0), rtol=0, atol=EXACT) for turn in (0, 2, 4, 6)
    )


@pytest.mark.parametrize("rule", ["MEAN", "STRAIGHT"])
@pytest.mark.parametrize("name", QUADS)
def test_rules_of_quads(name, rule, rng):
    """Regular rings start at the lowest neighbor; extraordinary ones take means, or eight straight points."""
    mesh = read_only(noisy(QUADS[name](), rng))
    twin, taken = MeshTwin(mesh), points_of(mesh, rule)
    kinds = set()
    for v in range(mesh.n_vertices):
        kind = "mean"
        if twin.is_regular(v, 4):
            kind, expected = "regular", mesh.vertices[[v, *rim_of(twin, v)]]
        elif rule == "STRAIGHT" and twin.is_closed(v) and twin.sizes(v) == {4} and len(twin.ring[v]) > 2:
            kind, eight = "straight", straight_eight(mesh.vertices, v, rim_of(twin, v))
            assert same_ring(taken[v, 1:], eight), v
            expected = taken[v]
        else:
            expected = mean_taps(twin, v, mesh.vertices)
        assert np.allclose(taken[v], expected, rtol=0, atol=EXACT), (v, kind)
        assert np.array_equal(taken[v, 0], mesh.vertices[v])
        kinds.add(kind)
    assert ("straight" in kinds) == (rule == "STRAIGHT" and "stars" in name)
    assert "mean" in kinds or rule == "STRAIGHT" or name == "quad torus"


def test_the_dropped_spokes_are_the_longer_four(rng):
    """Of the eight, alternating spokes are near and far; the near ones are shorter in total."""
    for valence in (3, 5, 9):
        mesh = noisy(star(valence, 1, 4)[0], rng, 0.25)
        taps = points_of(mesh, "STRAIGHT")[0]
        spokes = np.linalg.norm(taps[1:] - taps[0], axis=1)
        assert spokes[0::2].sum() <= spokes[1::2].sum()
        ways = {tuple(np.round(taps[k], 9)) for k in range(1, 9)}
        assert len(ways) == 8  # nobody is named twice


@pytest.mark.parametrize("rule", ["MEAN", "STRAIGHT"])
@pytest.mark.parametrize("name", QUADS)
def test_boundary_rule_of_quads(name, rule, rng):
    """The rim is one straight pair; what lies inside is mirrored: two quads give the lattice's own points."""
    mesh = noisy(QUADS[name](), rng)
    twin, taken, free = MeshTwin(mesh), points_of(mesh, rule, "ALONG"), points_of(mesh, rule)
    for v in range(mesh.n_vertices):
        if not twin.is_open[v]:
            assert np.array_equal(taken[v], free[v])  # the border changes nothing elsewhere
            continue
        center, ring = mesh.vertices[v], twin.ring[v]
        far = [w for w in twin.between(v, 4) if w >= 0]
        assert np.allclose(taken[v][[1, 5]], mesh.vertices[[ring[0], ring[-1]]], rtol=0, atol=EXACT)
        inner = mesh.vertices[ring[1:-1]].mean(axis=0) if len(ring) > 2 else center
        two = np.tile(mesh.vertices[far].mean(axis=0) if far else center, (2, 1))
        if len(ring) == 3 and twin.sizes(v) == {4}:
            two = mesh.vertices[far]
        expected = np.array([two[0], inner, two[1]])
        assert np.allclose(taken[v][[2, 3, 4]], expected, rtol=0, atol=EXACT)
        assert np.allclose(taken[v][[6, 7, 8]], 2 * center - expected, rtol=0, atol=EXACT)


@pytest.mark.parametrize("rule", ["MEAN", "STRAIGHT"])
def test_flat_sheets_of_quads_are_the_lattice(rule):
    """Inside and along straight borders the points are V + (row, column), seen from the vertex's own ring."""
    mesh = quad_grid(5, 6)
    taken = points_of(mesh, rule, "ALONG")
    for v in set(range(mesh.n_vertices)) - {0, 5, 24, 29}:
        left, up = taken[v][1] - taken[v][0], taken[v][3] - taken[v][0]
        rows, columns = BANKS["LINEAR_SPLINE"].offsets.T
        expected = taken[v][0] - np.outer(columns, left) - np.outer(rows, up)
        assert np.allclose(taken[v], expected, rtol=0, atol=EXACT)


@pytest.mark.parametrize("boundary", ["FREE", "ALONG"])
@pytest.mark.parametrize("rule", ["MEAN", "STRAIGHT"])
@pytest.mark.parametrize("name", ["torus", "grid", "star", "mixed"])
def test_all_nine_taps_on_triangles(name, rule, boundary, rng):
    """Seven as ever, and two across the ring edges 2-3 and 5-6: their mean at irregular vertices."""
    mesh = {
        "torus": lambda: flipped(triangle_torus()),
        "grid": triangle_grid,
        "star": lambda: star(8, 3, 3)[0],
        "mixed": MESHES["mixed sheet"],
    }[name]()
    mesh = noisy(mesh, rng)
    twin, taken = MeshTwin(mesh), points_of(mesh, rule, boundary, NINE)
    seven = make_stencil(mesh, connect(mesh), rule, boundary).data_matrix(mesh.vertices).transpose(1, 0, 2)
    at = [NINE.offsets.tolist().index(place) for place in BANKS["BOX_SPLINE_111"].offsets.tolist()]
    assert np.array_equal(taken[:, at], seven)
    across = [NINE.offsets.tolist().index(place) for place in ([-1, 1], [1, -1])]
    for v in range(mesh.n_vertices):
        ring, center = twin.ring[v], mesh.vertices[v]
        if v not in twin.named or len(ring) < 2:
            assert np.array_equal(taken[v], np.tile(center, (9, 1)))
            continue
        far = twin.between(v, 3)
        points = [mesh.vertices[w] if w >= 0 else None for w in far]
        known = [point for point in points if point is not None]
        if twin.is_regular(v, 3):
            two = [points[1], points[4]]
            two = [
                p if p is not None else 2 * center - q if q is not None else center
                for p, q in (two, two[::-1])
            ]
        elif twin.is_open[v] and boundary == "ALONG":
            inner = [p for p in points[1:-2] if p is not None]
            middle = np.mean(inner, axis=0) if inner else center
            two = [middle, 2 * center - middle]
        else:
            two = [np.mean(known, axis=0) if known else center] * 2
        assert np.allclose(taken[v, across], two, rtol=0, atol=EXACT), (v, ring)


@pytest.mark.parametrize("rule", ["MEAN", "STRAIGHT"])
def test_flat_sheets_of_triangles_are_the_lattice_of_nine(rule):
    mesh = triangle_grid(6, 7)
    taken = points_of(mesh, rule, "ALONG", NINE)
    connectivity = connect(mesh)
    for v in np.flatnonzero(
        connectivity.is_regular_triangle() | (connectivity.is_boundary & (connectivity.valence == 4))
    ):
        rows, columns = NINE.offsets.T
        right, down = taken[v][5] - taken[v][0], taken[v][7] - taken[v][0]
        expected = taken[v][0] + np.outer(columns, right) + np.outer(rows, down)
        assert np.allclose(taken[v], expected, rtol=0, atol=EXACT), v
