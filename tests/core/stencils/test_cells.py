# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Cells, the points around them, and what comes back from them, against loops (sections 3.3 and 5.3)."""

from itertools import pairwise

import numpy as np
import pytest
from framelet.core import BANKS, connect, make_stencil, make_transform
from framelet.core.frames.filter_bank import CELL_CORNERS
from framelet.core.stencils.cells import find_cells
from meshes import (
    MESHES,
    faces_of,
    flipped,
    noisy,
    quad_grid,
    soup,
    triangle_grid,
    triangle_torus,
    turned_over,
    union,
)
from stars import star
from stencil_twins import MeshTwin, Walker

EXACT = 1e-12

CELLED = ["B_SPLINE_1", "B_SPLINE_3", "B_SPLINE_5", "BOX_SPLINE_FOUR_DIRECTION"]


def cells_of(mesh, *, with_triangles=True):
    return find_cells(mesh, with_triangles=with_triangles)


@pytest.mark.parametrize("name", [*MESHES, "soup 7"])
def test_cells_are_quads_and_edges_between_two_triangles(name):
    """Each quad once, in face order; each edge with two faces, both triangles, once; nothing else."""
    mesh = soup(7) if name == "soup 7" else MESHES[name]()
    faces, cells, is_oriented = faces_of(mesh), cells_of(mesh), connect(mesh).is_oriented
    quads = [f for f, face in enumerate(faces) if len(face) == 4]
    assert cells.n_quads == len(quads)
    assert cells.owner[: cells.n_quads].tolist() == quads
    for f, corners in zip(quads, cells.corners.tolist(), strict=False):
        assert corners[0] == min(faces[f])
        assert any(corners == faces[f][turn:] + faces[f][:turn] for turn in range(4))
    at_edge = {}
    for face, (begin, end) in zip(faces, pairwise(mesh.face_offset), strict=True):
        for edge in mesh.corner_edge[begin:end].tolist():
            at_edge.setdefault(edge, []).append(face)
    pairs = {
        edge
        for edge, around in at_edge.items()
        if [len(face) for face in around] == [3, 3] and mesh.edges[edge, 0] != mesh.edges[edge, 1]
    }
    owners = cells.owner[cells.n_quads :].tolist()
    assert sorted(owners) == sorted(pairs)
    assert len(owners) == len(cells.corners) - cells.n_quads
    for edge, (start, right, stop, left) in zip(owners, cells.corners[cells.n_quads :].tolist(), strict=True):
        assert (start, stop) == tuple(sorted(mesh.edges[edge]))
        assert sorted([sorted((start, stop, right)), sorted((start, stop, left))]) == sorted(
            map(sorted, at_edge[edge])
        )
        if is_oriented:
            assert any(
                [stop, left, start] == face[turn:] + face[:turn]
                for face in at_edge[edge]
                for turn in range(3)
            )
    alone = cells_of(mesh, with_triangles=False)
    assert np.array_equal(alone.corners, cells.corners[: cells.n_quads])


@pytest.mark.parametrize("build", [quad_grid, triangle_grid])
@pytest.mark.parametrize("name", CELLED)
def test_flat_grids_give_the_lattice(name, build):
    """The four corners span a lattice; all taps of inner cells, quads or pairs, are its points."""
    bank = BANKS[name]
    reach = bank.reach
    size = 2 * (2 * reach + 1) + 3
    mesh = build(size, size)
    stencil = make_stencil(mesh, connect(mesh), bank=bank)
    taps = stencil.data_matrix(mesh.vertices)
    assert np.array_equal(stencil.slots[:4], cells_of(mesh).corners.T)
    x, y = taps[:4, :, 0], -taps[:4, :, 1]
    depth = np.minimum(np.minimum(x, size - 1 - x), np.minimum(y, size - 1 - y)).min(axis=0)
    inside = np.flatnonzero(depth >= 2 * reach)
    assert len(inside) >= 4
    assert (stencil.slots[:, inside] < mesh.n_vertices).all()
    right, down = (taps[1] - taps[0])[inside], (taps[3] - taps[0])[inside]
    for tap, (row, column) in enumerate(bank.offsets.tolist()):
        assert np.array_equal(taps[tap, inside], taps[0, inside] + column * right + row * down)


def cell_taps(twin, walker, bank, corners, is_pair):
    """Return the points under the taps of a cell: out through each corner, or over all ways out of it."""
    taps = {place: twin.points[v] for place, v in zip(CELL_CORNERS, corners, strict=True)}
    for k in range(4):
        here, ahead, behind = corners[k], corners[(k + 1) % 4], corners[k - 1]
        swing = 2 if is_pair and k % 2 else 1
        origin, one, two = (np.array(CELL_CORNERS[i % 4]) for i in (k, k + 1, k - 1))
        regular = twin.is_regular(here, 3) or twin.is_regular(here, 4)
        for a in range(bank.reach + 1):
            for b in range(bank.reach + 1):
                place = tuple(origin + a * (origin - one) + b * (origin - two))
                if a == b == 0 or list(place) not in bank.offsets.tolist():
                    continue
                ends = walker.corner(
                    walker.straight((ahead, here)), walker.straight((behind, here)), a, b, swing
                )
                if twin.is_closed(here) and not regular:
                    ways = [w for w in twin.ring[here] if w not in (ahead, behind)]
                    legs = {(a, b), (b, a)} if a and b else {(a + b, 0)}
                    out = [
                        walker.walk((here, w), first, turn, second)
                        for w in ways
                        for first, second in legs
                        for turn in ((-swing, swing) if second else (0,))
                    ]
                    ends = [end for end in out if end is not None] or ends
                if ends:
                    taps[place] = twin.points[ends].mean(axis=0)
                    continue
                inside = tuple(2 * origin - place)
                mirror = corners[CELL_CORNERS.index(inside)] if inside in CELL_CORNERS else here
                taps[place] = 2 * twin.points[here] - twin.points[mirror]
    return np.array([taps[place] for place in map(tuple, bank.offsets.tolist())])


@pytest.mark.parametrize("name", ["B_SPLINE_5", "BOX_SPLINE_FOUR_DIRECTION"])
@pytest.mark.parametrize("kind", ["quad star", "triangle star", "irregular", "mixed", "non-manifold"])
def test_matches_the_plain_walks(kind, name, rng):
    """Beyond regular, extraordinary and border corners; narrower banks take some of the same places."""
    mesh = {
        "quad star": lambda: union(star(5, 3, 4)[0], star(3, 3, 4)[0]),
        "triangle star": lambda: star(5, 3, 3)[0],
        "irregular": lambda: flipped(triangle_torus(6, 8)),
        "mixed": lambda: union(MESHES["mixed sheet"](), turned_over(star(5, 2, 4)[0])),
        "non-manifold": MESHES["three pages"],
    }[kind]()
    mesh = noisy(mesh, rng, 0.1)
    twin, cells, bank = MeshTwin(mesh), cells_of(mesh), BANKS[name]
    walker = Walker(twin)
    stencil = make_stencil(mesh, connect(mesh), bank=bank)
    taps = stencil.data_matrix(mesh.vertices)
    assert not stencil.is_vertex_centered
    assert stencil.n_sites == len(cells.corners) > 0
    for site, corners in enumerate(cells.corners.tolist()):
        expected = cell_taps(twin, walker, bank, corners, site >= cells.n_quads)
        assert np.allclose(taps[:, site], expected, rtol=0, atol=EXACT), (site, corners)


@pytest.mark.parametrize("valence", [3, 5, 6])
def test_beyond_an_extraordinary_corner_lies_the_mean_of_the_ways_out(valence, rng):
    """The cell of sector 0 at the vertex 0 of a star: its other spokes lead out, on both sides of each."""
    mesh, places = star(valence, 2, 4)
    mesh = noisy(mesh, rng)
    cells, bank = cells_of(mesh).corners.tolist(), BANKS["B_SPLINE_3"]
    site = cells.index([0, places[0, 1, 0], places[0, 1, 1], places[0, 0, 1]])
    taps = make_stencil(mesh, connect(mesh), bank=bank).data_matrix(mesh.vertices)[:, site]
    straight = np.mean([mesh.vertices[places[k, 1, 0]] for k in range(2, valence)], axis=0)
    aslant = [mesh.vertices[places[way % valence, 1, 1]] for k in range(2, valence) for way in (k, k - 1)]
    for place, expected in (((0, -1), straight), ((-1, 0), straight), ((-1, -1), np.mean(aslant, axis=0))):
        tap = bank.offsets.tolist().index(list(place))
        assert np.allclose(taps[tap], expected, rtol=0, atol=EXACT)


@pytest.mark.parametrize("name", CELLED)
@pytest.mark.parametrize("level", [1, 2])
def test_coarser_levels_lie_around_the_vertices(name, level):
    """At odd multiples of 2^(l-1): evenly around, so that coefficients live on vertices."""
    bank = BANKS[name]
    reach = (2 * bank.reach + 1) * 2 ** (level - 1)
    mesh = quad_grid(2 * reach + 1, 2 * reach + 1)
    stencil = make_stencil(mesh, connect(mesh), bank=bank, level=level)
    assert stencil.n_sites == mesh.n_vertices
    center = reach * (2 * reach + 1) + reach
    taps = stencil.data_matrix(mesh.vertices)[:, center]
    leaps = sorted(map(tuple, (taps - mesh.vertices[center])[:, :2].astype(int).tolist()))
    assert leaps == sorted(map(tuple, ((2 * bank.offsets - 1) * 2 ** (level - 1)).tolist()))


@pytest.mark.parametrize("name", CELLED)
def test_vertices_take_the_mean_over_their_cells(name, rng):
    """Low-pass and any bands: the mean of row c times the bands, over the cells where v is corner c."""
    mesh = noisy(
        union(MESHES["mixed sheet"](), flipped(triangle_torus(5, 6)), MESHES["single triangle"]()), rng
    )
    bank, cells = BANKS[name], cells_of(mesh).corners.tolist()
    transform = make_transform(mesh, name)
    found = transform.analyze(mesh.vertices)
    taps = make_stencil(mesh, connect(mesh), bank=bank).data_matrix(mesh.vertices)
    site_bands = np.einsum("bt,tsc->bsc", bank.masks, taps)
    assert np.allclose(found.details(0), site_bands[1:], rtol=0, atol=EXACT)
    high, low = rng.normal(size=found.details(0).shape), rng.normal(size=found.low.shape)
    rebuilt = transform.synthesize(found.with_details([high], low))
    n_without = 0
    for v in range(mesh.n_vertices):
        own = [(c, site) for site, corners in enumerate(cells) for c, w in enumerate(corners) if w == v]
        if not own:
            n_without += 1
            assert np.array_equal(
                found.low[v], mesh.vertices[v]
            )  # it keeps its position, and nothing is lost
            assert np.allclose(rebuilt[v], low[v], rtol=0, atol=EXACT)
            continue
        assert np.allclose(
            found.low[v], np.mean([site_bands[0, s] for _, s in own], axis=0), rtol=0, atol=EXACT
        )
        back = np.mean([bank.reconstruction[c, 1:] @ high[:, s] for c, s in own], axis=0)
        assert np.allclose(rebuilt[v], low[v] + back, rtol=0, atol=EXACT)
    assert n_without >= 3
