# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Folded, turned and degenerate faces are seen, and motions that make new ones are taken back."""

import numpy as np
import pytest
from checks import AS_SOLVED, assert_same_bits, lengths, wild_mesh
from framelet.core import PRESETS, Region, denoise
from framelet.core.blocks import Blocks
from framelet.core.limits.face_flips import DEGENERATE, FaceFlips
from framelet.core.limits.folds import damp_until_valid
from framelet.core.mesh.connectivity import connect
from framelet.core.mesh.corner_lists import corners_around
from framelet.core.mesh.geometry import face_area_vectors, mean_edge_length, vertex_normals
from framelet.core.mesh.welded_mesh import WeldedMesh
from framelet.core.mesh.winding import wound_alike
from mesh_files import mesh_files, read_mesh
from meshes import MESHES, faces_of, flipped, noisy, quad_torus, triangle_grid, triangle_torus
from region_cases import METHODS, exploded
from twins import signed_volume

TURN_OVER = 4.0
"""Standard deviation of random motions, in edge lengths, that leave hardly a face as it was."""


def watch_of(mesh, threads=2):
    welded = WeldedMesh(mesh, mesh, connect(mesh), mean_edge_length(mesh))
    return FaceFlips(welded, Blocks(threads, block_size=50))


def folded_by_a_loop(mesh):
    """Return which faces are folded, by loops over faces and pairs of faces that walk apart."""
    areas, faces = face_area_vectors(mesh), faces_of(mesh)
    at_edge, at_vertex = {}, np.zeros((mesh.n_vertices, 3))
    for f, face in enumerate(faces):
        for k, vertex in enumerate(face):
            at_vertex[vertex] += areas[f]
            following = face[(k + 1) % len(face)]
            at_edge.setdefault(tuple(sorted((vertex, following))), []).append((f, vertex))
    folded = []
    for f, face in enumerate(faces):
        across = []
        for k, vertex in enumerate(face):
            there = at_edge[tuple(sorted((vertex, face[(k + 1) % len(face)])))]
            across += [g for g, start in there if len(there) == 2 and start != vertex]
        disagrees = any(areas[f] @ areas[g] < 0 for g in across)
        folded.append(disagrees and areas[f] @ sum(at_vertex[v] for v in face) < 0)
    return np.array(folded)


@pytest.mark.parametrize("name", [name for name in MESHES if name != "soup"])
def test_folded_faces_match_a_loop(name, rng):
    mesh = noisy(MESHES[name](), rng, 0.4)
    watch = watch_of(mesh)
    assert watch.before.is_folded.tolist() == folded_by_a_loop(mesh).tolist()
    other = noisy(mesh, rng, 0.4)
    watch.look(other.vertices)
    assert watch.is_folded.tolist() == folded_by_a_loop(other).tolist()
    edge = mean_edge_length(mesh)
    assert np.abs(watch.areas * edge**2 - face_area_vectors(other).T).max() < 1e-12
    turned = np.einsum("fi,fi->f", face_area_vectors(mesh), face_area_vectors(other)) < 0
    assert watch.n_turned == turned.sum()


@pytest.mark.parametrize("make", [triangle_torus, lambda: quad_torus(12, 16)])
def test_volumes_are_those_of_the_mesh(make, rng):
    mesh = noisy(make(), rng)
    watch = watch_of(mesh)
    assert watch.before.volume * mean_edge_length(mesh) ** 3 == pytest.approx(signed_volume(mesh), rel=1e-12)


def test_a_face_that_is_turned_by_hand_is_folded(rng):
    mesh = noisy(triangle_torus(24, 32), rng, 0.05)
    watch = watch_of(mesh)
    assert not watch.before.is_folded.any()
    vertices = mesh.vertices.copy()
    a, b, c = mesh.corner_vertex[:3]
    vertices[a] = vertices[b] + vertices[c] - vertices[a]  # over to the other side of its edge
    watch.look(vertices)
    assert watch.is_folded[0] and watch.is_bad()[0]
    assert watch.is_bad().sum() < 10


def test_flat_meshes_and_smooth_ones_have_no_folds():
    for mesh in (triangle_grid(), triangle_torus(), quad_torus(12, 16)):
        assert not watch_of(mesh).before.is_folded.any()


def test_degenerate_faces_are_counted(rng):
    points = [[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0], [1, 1, 0]]
    mesh = wild_mesh(points, [(0, 1, 2), (0, 1, 3), (1, 4, 3), (1, 1, 4)])
    watch = watch_of(mesh)
    assert watch.before.is_degenerate.tolist() == [True, False, False, True]
    vertices = mesh.vertices.copy()
    vertices[3] = [0.5 * DEGENERATE, 0, 0]
    watch.look(vertices)
    assert watch.is_degenerate.tolist() == [True, True, False, True]
    assert np.flatnonzero(watch.is_bad()).tolist() == [1]


def test_looking_around_a_change_sees_what_looking_at_all_sees(rng):
    for make in (lambda: flipped(triangle_torus()), lambda: quad_torus(12, 16), MESHES["mixed sheet"]):
        mesh = noisy(make(), rng)
        some, all_ = watch_of(mesh), watch_of(mesh)
        vertices = mesh.vertices.copy()
        some.look(vertices)
        for _ in range(5):
            changed = rng.random(mesh.n_vertices) < 0.1
            vertices = np.where(changed[:, None], vertices + rng.normal(0, 0.5, vertices.shape), vertices)
            some.look_around(vertices, changed)
            all_.look(vertices)
            assert_same_bits(some.areas, all_.areas)
            assert some.is_bad().tolist() == all_.is_bad().tolist()
            assert some.is_folded.tolist() == all_.is_folded.tolist()


@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize("sigma", [0.1, 0.5, TURN_OVER])
def test_any_motion_can_be_taken_back(name, sigma, rng):
    mesh = noisy(MESHES[name](), rng)
    watch = watch_of(mesh)
    displacement = rng.normal(0, sigma * mean_edge_length(mesh), (3, mesh.n_vertices))
    displacement[:, rng.random(mesh.n_vertices) < 0.1] = 0.0
    shares = np.ones(mesh.n_vertices)
    vertices = damp_until_valid(watch, displacement, shares, Blocks(2))
    again = watch_of(mesh)
    again.look(vertices)
    assert not again.is_bad().any()
    assert again.is_folded.sum() <= again.before.is_folded.sum()
    assert again.is_degenerate.sum() <= again.before.is_degenerate.sum()
    moved = vertices - mesh.vertices
    assert np.abs(moved.T - displacement * shares).max() < 1e-12
    assert set(shares) <= {1.0, 0.5, 0.25, 0.125, 0.0625, 0.0}
    still = shares == 0.0
    assert_same_bits(vertices[still], mesh.vertices[still])


def test_most_of_a_motion_is_kept(rng):
    mesh = noisy(triangle_torus(24, 32), rng, 0.05)
    displacement = rng.normal(0, 0.15 * mean_edge_length(mesh), (3, mesh.n_vertices))
    shares = np.ones(mesh.n_vertices)
    damp_until_valid(watch_of(mesh), displacement, shares, Blocks(2))
    assert shares.mean() > 0.95


@pytest.mark.parametrize("preset", METHODS)
def test_where_nothing_folds_nothing_changes(preset, rng):
    mesh = noisy(triangle_torus(24, 32), rng, 0.05)
    settings = PRESETS[preset].settings
    raw, result = denoise(mesh, settings, region=AS_SOLVED), denoise(mesh, settings)
    assert raw.report.folded_faces == 0
    assert result.report.damped_vertices == 0
    assert_same_bits(result.vertices, raw.vertices)


@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize("preset", ["TRI_1", "TRI_2", "BILATERAL"])
def test_never_more_folds_than_before(name, preset, rng):
    for sigma in (0.15, 0.5):
        mesh = noisy(MESHES[name](), rng, sigma)
        check_folds(mesh, preset, Region())
        check_folds(mesh, preset, Region(keep_volume=True, along_normals=True))


@pytest.mark.parametrize("name", MESHES)
def test_never_more_folds_than_before_with_the_slow_method(name, rng):
    check_folds(noisy(MESHES[name](), rng, 0.15), "AUTO", Region(keep_volume=True, along_normals=True))
    check_folds(noisy(MESHES[name](), rng, 0.5), "AUTO", Region())


@pytest.mark.parametrize("preset", ["QUAD_1", "QUAD_2"])
@pytest.mark.parametrize("name", ["quad torus", "quad grid", "single quad"])
def test_never_more_folds_than_before_on_quads(name, preset, rng):
    check_folds(noisy(MESHES[name](), rng, 0.4), preset, Region())


def test_bilateral_filtering_does_fold():
    """So that the tests above mean something."""
    rng = np.random.default_rng(0)
    mesh = noisy(flipped(triangle_torus()), rng, 0.3)
    raw = denoise(mesh, PRESETS["BILATERAL"].settings, region=AS_SOLVED).report
    assert raw.folded_faces > raw.folded_faces_before
    report = denoise(mesh, PRESETS["BILATERAL"].settings).report
    assert report.damped_vertices > 0


def test_soups_have_folds_only_between_welded_faces(rng):
    mesh = noisy(flipped(triangle_torus()), rng, 0.3)
    soup, _ = exploded(mesh)
    check_folds(soup, "BILATERAL", Region(weld_distance=0.0))


def check_folds(mesh, preset, region):
    """Fail if a result has more folded or degenerate faces than the input, or does not say so."""
    result = denoise(mesh, PRESETS[preset].settings, region=region)
    report = result.report
    assert report.folded_faces <= report.folded_faces_before
    assert report.degenerate_faces <= report.degenerate_faces_before
    if region.weld_distance is None:
        wound = wound_alike(mesh)
        same = mesh if wound is None else wound.surface
        assert report.folded_faces == folded_by_a_loop(same.with_vertices(result.vertices)).sum()
        assert report.folded_faces_before == folded_by_a_loop(same).sum()
    return result


@pytest.mark.parametrize("preset", ["TRI_2", "QUAD_2", "BILATERAL", "AUTO"])
def test_never_more_folds_than_before_on_files(preset, shared_meshes, rng):
    """All files with faces, with noise along the normals, the small ones with strong noise too."""
    n_tested = 0
    for path in mesh_files(shared_meshes, "tri", "quad", "mixed", "nonmanifold", "scan", "bad"):
        mesh = read_mesh(path)
        if not mesh.n_faces or mesh.n_vertices > 8000 or not np.isfinite(mesh.vertices).all():
            continue
        edge = mean_edge_length(mesh)
        if not edge or (preset == "QUAD_2" and not connect(mesh).has_quads):
            continue
        for sigma in (0.2, 0.6) if mesh.n_vertices < 5000 else (0.3,):
            height = rng.normal(0, sigma * edge, (mesh.n_vertices, 1))
            noise = mesh.with_vertices((mesh.vertices + height * vertex_normals(mesh)).astype(np.float32))
            report = denoise(noise, PRESETS[preset].settings).report
            assert report.folded_faces <= report.folded_faces_before, (path.name, sigma)
            assert report.degenerate_faces <= report.degenerate_faces_before, (path.name, sigma)
            n_tested += 1
    assert n_tested > 20


def test_the_number_of_calls_does_not_grow_with_the_mesh(rng):
    """A fold is mended by array operations, a few for each round."""
    import cProfile
    import pstats

    calls = []
    for size in (12, 48):
        mesh = noisy(triangle_torus(size, 4 * size), rng, 0.05)
        watch = watch_of(mesh, threads=1)
        watch._blocks = blocks = Blocks(1)
        displacement = np.zeros((3, mesh.n_vertices))
        displacement[:, :4] = rng.normal(0, 2 * mean_edge_length(mesh), (3, 4))
        profile = cProfile.Profile()
        profile.runcall(damp_until_valid, watch, displacement, np.ones(mesh.n_vertices), blocks)
        calls.append(pstats.Stats(profile).total_calls)
    assert calls[1] < 3 * calls[0]
    assert lengths(displacement.T).max() > 0


@pytest.mark.parametrize("name", MESHES)
def test_corners_around_vertices_match_a_search(name, rng):
    mesh = MESHES[name]()
    connectivity = connect(mesh)
    for share in (0.02, 0.3, 1.0):
        vertices = np.flatnonzero(rng.random(mesh.n_vertices) < share)
        found = corners_around(mesh, connectivity, vertices)
        assert found.tolist() == np.flatnonzero(np.isin(mesh.corner_vertex, vertices)).tolist()


def test_faces_that_are_known_already_give_the_same(rng):
    mesh = noisy(triangle_torus(12, 30), rng, 0.4)
    first = watch_of(mesh)
    again = FaceFlips(first.welded, Blocks(1), first.before)
    other = noisy(mesh, rng, 0.4)
    areas = first.before.areas.copy()
    for watch in (first, again):
        watch.look(other.vertices)
        changed = np.zeros(mesh.n_vertices, bool)
        changed[:9] = True
        watch.look_around(np.where(changed[:, None], mesh.vertices, other.vertices), changed)
    assert first.is_bad().any()
    assert again.is_bad().tolist() == first.is_bad().tolist()
    assert_same_bits(again.areas, first.areas)
    assert_same_bits(first.before.areas, areas)
