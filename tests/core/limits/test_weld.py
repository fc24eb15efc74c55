# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Unwelded meshes are denoised as if they were welded, and stay unwelded."""

import tracemalloc

import numpy as np
import pytest
from checks import assert_same_bits, edge_length, lengths, wild_mesh
from framelet.core import PRESETS, PreparationCache, Region, SurfaceMesh, denoise, prepare
from framelet.core.mesh.connectivity import connect
from framelet.core.mesh.weld import components_within, make_weld, same_places
from meshes import faces_of, flipped, mixed_sheet, noisy, quad_grid, quad_torus, triangle_grid, triangle_torus
from region_cases import METHODS, box, exploded, renumbered

EXACT = Region(weld_distance=0.0)


def groups_by_a_loop(points, distance):
    """Return the group of each point, by joining groups pair by pair."""
    group = list(range(len(points)))
    for a in range(len(points)):
        for b in range(a):
            if np.linalg.norm(points[a] - points[b]) <= distance and group[a] != group[b]:
                old, new = max(group[a], group[b]), min(group[a], group[b])
                group = [new if g == old else g for g in group]
    names = {g: k for k, g in enumerate(dict.fromkeys(group))}
    return [names[g] for g in group]


@pytest.mark.parametrize("distance", [0.0, 0.02, 0.1, 0.5])
def test_groups_match_a_loop(distance, rng):
    points = rng.random((120, 3))
    points[60:90] = points[:30]
    points[90:] += [-3.0, 2.0, 0.0]
    points = np.concatenate((points, [[10.0, 0, 0], [20, 0, 0], [10, 20, 0]]))
    mesh = SurfaceMesh.from_faces(points, [(0, 1, 2), (95, 96, 97), (120, 121, 122)])
    assert make_weld(mesh, distance).vertex.tolist() == groups_by_a_loop(points, distance)


def test_points_on_a_lattice_are_joined_at_exactly_the_distance():
    points = np.stack(np.meshgrid([0.0, 1.0], [0.0, 1.0, 2.5], [0.0, 1.0]), -1).reshape(-1, 3)
    mesh = SurfaceMesh.from_faces([*points, (9, 9, 9), (9, 7, 9)], [(0, 12, 13)])
    assert make_weld(mesh, 1.0).vertex.tolist() == groups_by_a_loop(mesh.vertices, 1.0)


@pytest.mark.parametrize("origin", [0.0, 1e6, 5e6])
def test_the_cost_of_welding_does_not_depend_on_where_the_mesh_is(origin):
    """Georeferenced scans lie millions of units from the origin."""
    soup, _ = exploded(triangle_grid(40, 40))
    soup = soup.with_vertices(0.01 * soup.vertices.astype(np.float64) + [origin, origin, 0.0])
    tracemalloc.start()
    weld = make_weld(soup, 1e-5)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert weld.surface.n_vertices == triangle_grid(40, 40).n_vertices
    assert peak < 1000 * soup.n_vertices


def test_zeros_of_both_signs_are_one_place():
    points = np.array([[0.0, 1, 2], [-0.0, 1, 2], [0, 1, 3], [0, 1, 2]], np.float32)
    assert same_places(points).tolist() == [0, 0, 1, 0]


@pytest.mark.parametrize("make", [triangle_torus, lambda: flipped(triangle_torus()), quad_torus, mixed_sheet])
def test_an_exploded_mesh_is_put_together_again(make):
    mesh = make()
    soup, vertex = exploded(mesh)
    weld = make_weld(soup, 0.0)
    assert len(np.unique(vertex)) == weld.surface.n_vertices
    assert weld.n_merged == soup.n_vertices - weld.surface.n_vertices
    assert weld.face.tolist() == list(range(mesh.n_faces))
    assert_same_bits(weld.surface.vertices[weld.vertex], soup.vertices)
    old, new = connect(mesh), connect(weld.surface)
    assert sorted(old.valence[~old.is_loose]) == sorted(new.valence)
    assert old.is_closed == new.is_closed
    # Edges are those of the faces.
    ends = weld.surface.edges[weld.surface.corner_edge]
    corners = weld.surface.corner_vertex
    following = corners[weld.surface.next_corner()]
    assert (np.sort(ends) == np.sort(np.stack((corners, following), 1))).all()


def test_faces_that_collapse_are_left_out():
    points = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 0], [1, 1, 0], [2, 0, 0]]
    faces = [(0, 1, 2, 3), (0, 4, 1), (0, 1, 5, 4), (0, 1, 4, 3), (1, 6, 2), (0, 1, 2, 5, 3)]
    weld = make_weld(wild_mesh(points, faces, [(0, 4), (5, 6)]), 0.0)
    assert weld.vertex.tolist() == [0, 1, 2, 3, 0, 2, 4]
    assert weld.face.tolist() == [0, 2, 4, 5]
    assert [sorted(face) for face in faces_of(weld.surface)] == [
        [0, 1, 2, 3],
        [0, 1, 2],
        [1, 2, 4],
        [0, 1, 2, 3],
    ]
    loose = np.bincount(weld.surface.corner_edge, minlength=weld.surface.n_edges) == 0
    assert not loose.any()


@pytest.mark.parametrize("preset", METHODS)
@pytest.mark.parametrize("make", [triangle_torus, lambda: flipped(triangle_torus()), triangle_grid])
def test_a_soup_is_denoised_like_the_mesh(preset, make, rng):
    mesh = noisy(make(), rng)
    mesh = make_weld(exploded(mesh)[0], 0.0).surface  # with the numbers that welding gives
    soup, vertex = exploded(mesh)
    settings = PRESETS[preset].settings
    whole, result = denoise(mesh, settings), denoise(soup, settings, region=EXACT)
    assert_same_bits(result.vertices, whole.vertices[vertex])
    report = result.report
    assert report.welded_vertices == soup.n_vertices - mesh.n_vertices
    assert report.n_vertices == soup.n_vertices
    assert report.volume_change == whole.report.volume_change
    assert report.folded_faces == whole.report.folded_faces
    assert report.noise == whole.report.noise


def test_without_welding_nothing_is_cleaned(rng):
    """So that the test above means something."""
    soup, _ = exploded(noisy(triangle_torus(), rng))
    result = denoise(soup, PRESETS["BILATERAL"].settings).vertices
    assert lengths(result - soup.vertices).max() < 1e-6


def test_vertices_that_are_near_keep_their_gap(rng):
    mesh = noisy(quad_torus(12, 16), rng)
    soup, vertex = exploded(mesh)
    gap = 1e-3 * edge_length(mesh)
    soup = soup.with_vertices(soup.vertices + rng.uniform(-0.2, 0.2, soup.vertices.shape) * gap)
    settings = PRESETS["QUAD_2"].settings
    moved = denoise(soup, settings, region=Region(weld_distance=gap)).vertices - soup.vertices
    for v in range(mesh.n_vertices):
        assert np.ptp(moved[vertex == v], axis=0).max() < 1e-12
    expected = denoise(mesh, settings).vertices - mesh.vertices
    assert lengths(moved - expected[vertex]).max() < 10 * gap


def test_a_split_seam_stays_closed_under_all_limits(rng):
    mesh, edges = box(6)
    mesh = noisy(mesh, rng, 0.1)
    soup, vertex = exploded(mesh)
    soup = soup.with_vertices(soup.vertices.astype(np.float32))
    corner = {v: k for k, v in enumerate(vertex)}
    lines = np.array([[corner[a], corner[b]] for a, b in edges])
    region = Region(
        weights=rng.random(mesh.n_vertices)[vertex],
        feature_edges=lines,
        max_displacement=0.2,
        along_normals=True,
        keep_volume=True,
        weld_distance=0.0,
    )
    result = denoise(soup, PRESETS["TRI_2"].settings, region=region)
    for v in range(mesh.n_vertices):
        bits = result.vertices[vertex == v].view(np.uint32)
        assert (bits == bits[0]).all()
    assert result.report.line_vertices == len(np.unique(edges))
    assert abs(result.report.volume_change) < 1e-4


def test_of_welded_vertices_the_one_that_may_move_least_counts(rng):
    mesh = noisy(triangle_torus(), rng)
    soup, vertex = exploded(mesh)
    movable = np.ones(soup.n_vertices, bool)
    weights = np.ones(soup.n_vertices)
    movable[0] = False
    weights[np.flatnonzero(vertex == vertex[1])[0]] = 0.0
    result = denoise(
        soup, PRESETS["TRI_2"].settings, movable=movable, region=Region(weld_distance=0.0, weights=weights)
    )
    stays = np.isin(vertex, vertex[:2])
    assert_same_bits(result.vertices[stays], soup.vertices[stays])
    assert (result.vertices[~stays] != soup.vertices[~stays]).any(axis=1).mean() > 0.9


def test_nothing_may_move_is_said(rng):
    soup, vertex = exploded(noisy(quad_grid(), rng))
    movable = np.zeros(soup.n_vertices, bool)
    movable[np.flatnonzero(vertex == 8)[0]] = True
    with pytest.raises(ValueError, match="or lie on others that may not move"):
        denoise(soup, PRESETS["QUAD_2"].settings, movable=movable, region=EXACT)


def test_positions_are_checked_first():
    mesh = triangle_grid()
    vertices = mesh.vertices.copy()
    vertices[3] = np.nan
    with pytest.raises(ValueError, match="Vertex 3 at"):
        denoise(mesh.with_vertices(vertices), region=EXACT)
    with pytest.raises(ValueError, match="The mesh is empty"):
        denoise(SurfaceMesh.from_faces(np.zeros((0, 3)), []), region=EXACT)


def test_preparing_works_with_welds(rng):
    soup, _ = exploded(noisy(triangle_torus(), rng))
    settings, cache = PRESETS["TRI_2"].settings, PreparationCache()
    plain = denoise(soup, settings, region=EXACT).vertices
    for _ in range(2):
        assert_same_bits(denoise(soup, settings, region=EXACT, prepared=cache).vertices, plain)
    assert len(cache) == 1
    assert_same_bits(denoise(soup, settings, region=EXACT, connectivity=connect(soup)).vertices, plain)
    with pytest.raises(ValueError, match="prepared for another mesh"):
        denoise(soup, settings, region=EXACT, prepared=prepare(soup, settings))


def test_renumbering_a_soup(rng):
    soup, _ = exploded(noisy(flipped(triangle_torus()), rng))
    other, new = renumbered(soup, rng)
    settings = PRESETS["TRI_2"].settings
    found = denoise(other, settings, region=EXACT, dtype=np.float64).vertices[new]
    assert np.abs(found - denoise(soup, settings, region=EXACT, dtype=np.float64).vertices).max() < 1e-9


def test_a_large_scattered_soup(rng):
    """Large enough that the welded mesh is renumbered for locality."""
    mesh = noisy(triangle_torus(150, 500), rng, 0.1)
    scattered, new = renumbered(mesh, rng)
    soup, vertex = exploded(scattered)
    soup = soup.with_vertices(soup.vertices.astype(np.float32))
    settings = PRESETS["TRI_2"].settings
    result = denoise(soup, settings, region=EXACT).vertices
    expected = denoise(mesh, settings).vertices[np.argsort(new)][vertex]
    assert np.abs(result - expected).max() < 1e-4


@pytest.mark.parametrize("distance", [0.02, 0.3, 3.0])
def test_a_wide_distance_takes_little_memory(distance, rng):
    """All pairs of 6,000 points took 2.3 GB."""
    points = rng.random((6000, 3))
    tracemalloc.start()
    try:
        component = components_within(points, distance)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert peak < 150e6
    assert (len(np.unique(component)) > 5000) == (distance < 0.1)
    assert (component == 0).all() == (distance > 0.1)


def test_links_may_be_many_enough_in_the_last_portion(rng):
    """Two clusters in cells that touch at a corner, and a face far off: nothing is left to join then."""
    clusters = np.repeat([[0.45, 0.45, 0.0], [0.55, 0.55, 0.0]], [350, 30], axis=0)
    far = [[-10.5, -10.5, 0.0], [-8.5, -10.5, 0.0], [-10.5, -8.5, 0.0]]
    points = np.concatenate((far, clusters + 0.01 * rng.random((380, 3))))
    mesh = SurfaceMesh.from_faces(points, [(0, 1, 2), (0, 1, 3)])
    assert make_weld(mesh, 1.0).vertex.tolist() == [0, 1, 2] + [3] * 380


def test_components_do_not_depend_on_how_many_pairs_are_looked_at_together(rng):
    points = rng.random((400, 3)) * [1, 1, 0.1]
    whole = components_within(points, 0.04)
    parts = components_within(points, 0.04, most_pairs=8)
    links = np.linalg.norm(points[:, None] - points, axis=2) <= 0.04
    assert 10 < len(np.unique(whole)) < 390
    assert (whole[:, None] == whole)[links].all()
    assert np.array_equal(whole, parts)
