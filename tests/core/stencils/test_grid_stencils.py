# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Neighborhoods of (2m+1)^2 points, against walks from edge to edge (sections 3.3 and 5.3)."""

import numpy as np
import pytest
from checks import wild_mesh
from framelet.core import BANKS, FilterBank, connect, make_stencil
from meshes import MESHES, flipped, noisy, quad_grid, triangle_grid, triangle_torus, turned_over, union
from stars import star
from stencil_twins import NEAR, RING, MeshTwin, Walker, sector_of

EXACT = 1e-12

FIVE = FilterBank("FIVE", "TRIANGLES", BANKS["B_SPLINE_4"].offsets, BANKS["B_SPLINE_4"].masks)
WIDE = {"B_SPLINE_4": BANKS["B_SPLINE_4"], "B_SPLINE_6": BANKS["B_SPLINE_6"], "FIVE": FIVE}


def stencil_of(mesh, bank, level=0, boundary="ALONG"):
    return make_stencil(mesh, connect(mesh), "STRAIGHT", boundary, bank=bank, level=level)


@pytest.mark.parametrize("level", [0, 1, 2])
@pytest.mark.parametrize("name", WIDE)
def test_flat_grids_give_the_lattice(name, level):
    """All taps are V + 2^l (row, column); near the border too, where some are mirrored."""
    bank, step = WIDE[name], 2**level
    reach = bank.reach * step
    rows, columns = 2 * reach + 2, 2 * reach + 3
    mesh = (triangle_grid if name == "FIVE" else quad_grid)(rows, columns)
    stencil = stencil_of(mesh, bank, level)
    taps = stencil.data_matrix(mesh.vertices)
    near = [bank.offsets.tolist().index(place) for place in ([0, 1], [1, 0])]
    for row, column in [(reach, reach), (reach + 1, reach + 2), (reach, reach + 1)]:
        v = row * columns + column
        assert (stencil.slots[:, v] < mesh.n_vertices).all()
        right, down = taps[near, v] - taps[0, v]
        assert sorted(np.abs([right, down]).max(axis=1)) == [step, step]
        expected = taps[0, v] + bank.offsets[:, 1:] * right + bank.offsets[:, :1] * down
        assert np.array_equal(taps[:, v], expected)
    # In from the border by half the reach: half of the taps are mirrored, and a flat sheet stays one.
    v = (reach // 2) * columns + columns // 2
    right, down = taps[near, v] - taps[0, v]
    expected = taps[0, v] + bank.offsets[:, 1:] * right + bank.offsets[:, :1] * down
    assert np.allclose(taps[:, v], expected, rtol=0, atol=EXACT)


@pytest.mark.parametrize("level", [0, 1])
@pytest.mark.parametrize("valence", [3, 5, 7])
@pytest.mark.parametrize("name", ["B_SPLINE_6", "FIVE"])
def test_orbit_means_at_an_extraordinary_vertex(name, valence, level, rng):
    """Around vertex 0 of a star all walks of a shape end at the places (k, a, b) and (k, b, a)."""
    bank, ring = WIDE[name], RING if name == "FIVE" else NEAR
    reach = bank.reach * 2**level * (2 if name == "FIVE" else 1)
    mesh, places = star(valence, reach, len(ring) // 2 + (2 if name != "FIVE" else 0))
    mesh = noisy(mesh, rng)
    taps = stencil_of(mesh, bank, level).data_matrix(mesh.vertices)[:, 0]
    for tap, place in enumerate(bank.offsets.tolist()):
        if tap == 0:
            assert np.array_equal(taps[0], mesh.vertices[0])
            continue
        _, a, b = sector_of((2**level * place[0], 2**level * place[1]), ring)
        orbit = {places[k, *way] for k in range(valence) for way in ((a, b), (b, a))}
        assert np.allclose(taps[tap], mesh.vertices[sorted(orbit)].mean(axis=0), rtol=0, atol=EXACT)


def directions(twin, v, n):
    """Return the neighbors in each lattice direction of a regular or rim vertex, None across the border."""
    ring = twin.ring[v]
    if not twin.is_open[v]:
        return list(ring)
    inner, half = ring[1:-1], n // 2
    taken = [None] * n
    taken[0], taken[half] = ring[0], ring[-1]
    if inner and half == 2:
        taken[1] = inner[(len(inner) - 1) // 2]
    elif inner:
        near = max((len(inner) + 1) // 3, 1) - 1
        taken[1], taken[2] = inner[near], inner[-1 - near]
    return taken


def directed_taps(twin, walker, v, bank, level, ring):
    """Return the points under the taps of a regular or rim vertex."""
    swing = 2 if ring is RING else 1
    ways = directions(twin, v, len(ring))

    def reached(place):
        s, a, b = sector_of(place, ring)
        one, two = ways[s], ways[(s + 1) % len(ring)]
        ends = walker.corner(
            (v, one) if one is not None else None, (v, two) if two is not None else None, a, b, swing
        )
        return twin.points[ends].mean(axis=0) if ends else None

    taps = []
    for row, column in (bank.offsets * 2**level).tolist():
        own = reached((row, column)) if (row, column) != (0, 0) else twin.points[v]
        if own is None:
            other = reached((-row, -column))
            own = twin.points[v] if other is None else 2 * twin.points[v] - other
        taps.append(own)
    return np.array(taps)


def orbit_taps(twin, walker, v, bank, level, ring):
    """Return the points under the taps of an irregular vertex: means over all walks of a shape, both ways."""
    swing = 2 if ring is RING else 1
    taps = [twin.points[v]]
    for row, column in (bank.offsets[1:] * 2**level).tolist():
        _, a, b = sector_of((row, column), ring)
        ends = []
        for w in twin.ring[v]:
            for first, second in {(a, b), (b, a)} if b else {(a, 0)}:
                for turn in (-swing, swing) if b else (0,):
                    ends.append(walker.walk((v, w), first, turn, second))
        ends = [end for end in ends if end is not None]
        taps.append(twin.points[ends].mean(axis=0) if ends else twin.points[v])
    return np.array(taps)


@pytest.mark.parametrize("boundary", ["ALONG", "FREE"])
@pytest.mark.parametrize(("name", "level"), [("B_SPLINE_4", 1), ("B_SPLINE_6", 0), ("FIVE", 0), ("FIVE", 1)])
@pytest.mark.parametrize("kind", ["stars", "irregular", "mixed"])
def test_matches_the_plain_walks(kind, name, level, boundary, rng):
    """Regular vertices beside irregular ones, where the orders of walking differ, borders, everything."""
    bank, ring = WIDE[name], RING if name == "FIVE" else NEAR
    sides = 3 if ring is RING else 4
    mesh = {
        "stars": lambda: union(star(5, 3, sides)[0], star(3, 3, sides)[0]),
        "irregular": lambda: flipped(triangle_torus(6, 8)) if sides == 3 else star(7, 3, 4)[0],
        "mixed": lambda: union(
            MESHES["mixed sheet"](),
            turned_over(star(5, 2, sides)[0], share=0.5 * (boundary == "ALONG")),
            MESHES["octahedron"](),
        ),
    }[kind]()
    mesh = noisy(mesh, rng, 0.1)
    twin = MeshTwin(mesh)
    walker = Walker(twin)
    stencil = stencil_of(mesh, bank, level, boundary)
    taps = stencil.data_matrix(mesh.vertices)
    n_averaged = n_mirrored = 0
    for v in range(level, mesh.n_vertices, 1 + level):
        assert stencil.is_irregular[v] == (v in twin.named and not twin.is_regular(v, sides))
        if v not in twin.named:
            expected = np.tile(mesh.vertices[v], (bank.n_taps, 1))
        elif twin.is_regular(v, sides) or (twin.is_open[v] and boundary == "ALONG"):
            expected = directed_taps(twin, walker, v, bank, level, ring)
            n_averaged += (stencil.slots[:, v] >= mesh.n_vertices).any() and not twin.is_open[v]
            n_mirrored += twin.is_open[v]
        else:
            expected = orbit_taps(twin, walker, v, bank, level, ring)
        assert np.allclose(taps[:, v], expected, rtol=0, atol=EXACT), v
    assert n_averaged or kind == "mixed"
    assert n_mirrored or boundary == "FREE" or (kind, sides) == ("irregular", 3)


def test_both_orders_of_walking_count_alike(rng):
    """A regular vertex whose diagonal leads past valence 5: two ends, and the tap is their midpoint."""
    mesh, places = star(5, 4, 4)
    mesh = noisy(mesh, rng, 0.05)
    v = places[0, 1, 1]  # one step around vertex 0 in either direction, then one more
    twin = MeshTwin(mesh)
    walker = Walker(twin)
    bank = WIDE["B_SPLINE_4"]
    taps = stencil_of(mesh, bank).data_matrix(mesh.vertices)[:, v]
    seen = []
    for place in ((-2, -2), (-2, 2), (2, 2), (2, -2)):
        s, a, b = sector_of(place, NEAR)
        one, two = twin.ring[v][s], twin.ring[v][(s + 1) % 4]
        ends = walker.corner((v, one), (v, two), a, b, 1)
        seen.append(len(set(ends)))
        tap = bank.offsets.tolist().index(list(place))
        assert np.allclose(taps[tap], mesh.vertices[ends].mean(axis=0), rtol=0, atol=EXACT)
    assert sorted(seen) == [1, 1, 1, 2]


def test_walked_stencils_do_not_depend_on_numbers_at_non_manifold_vertices(rng):
    """Reversing all faces changes no neighborhood, so an irregular vertex keeps its points."""
    mesh = noisy(MESHES["three pages"](), rng)
    reversed_ = turned_over(mesh, share=1.1)
    broken = np.flatnonzero(connect(mesh).is_non_manifold)
    assert len(broken)
    one, two = (stencil_of(m, FIVE, boundary="FREE").data_matrix(m.vertices) for m in (mesh, reversed_))
    assert np.allclose(one[:, broken], two[:, broken], rtol=0, atol=EXACT)


def test_a_face_of_one_vertex_alone():
    """It has no ring to walk along; each tap looks up the vertex itself."""
    mesh = wild_mesh([(1.0, 2.0, 3.0)], [(0, 0, 0, 0)])
    for bank in (FIVE, BANKS["B_SPLINE_3"], BANKS["B_SPLINE_6"]):
        assert np.allclose(stencil_of(mesh, bank).data_matrix(mesh.vertices), mesh.vertices[0])
