# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces that are turned over are turned back, in the neighborhoods and in what a run is given."""

from time import process_time

import numpy as np
import pytest
from checks import assert_same_bits, lengths
from framelet.core import (
    PRESETS,
    FrameTransform,
    Region,
    SurfaceMesh,
    connect,
    denoise,
    equalize,
    noise_field,
)
from framelet.core.mesh.geometry import face_area_vectors
from framelet.core.mesh.winding import with_reversed, wound_alike
from meshes import (
    MESHES,
    faces_of,
    noisy,
    quad_torus,
    soup,
    triangle_grid,
    triangle_torus,
    turned_over,
    union,
)

ORIENTABLE = {
    "triangles": triangle_torus,
    "quads": lambda: quad_torus(12, 16),
    "border": lambda: triangle_grid(7, 9),
    "mixed": MESHES["mixed sheet"],
    "parts": lambda: union(triangle_torus(), triangle_grid(5, 6), quad_torus(6, 8)),
}


def n_disagreeing(mesh):
    """Return how many edges between two faces both walk along in the same direction, by loops."""
    steps = {}
    for face in faces_of(mesh):
        for a, b in zip(face, face[1:] + face[:1], strict=True):
            steps.setdefault(tuple(sorted((a, b))), []).append((a, b))
    return sum(len(found) == 2 and found[0] == found[1] for found in steps.values())


@pytest.mark.parametrize("share", [0.02, 0.3, 0.4])
@pytest.mark.parametrize("name", ORIENTABLE)
def test_most_faces_stay_and_the_others_are_turned_back(name, share):
    mesh = ORIENTABLE[name]()
    assert wound_alike(mesh) is None
    turned = turned_over(mesh, seed=3, share=share)
    assert n_disagreeing(turned)
    wound = wound_alike(turned)
    assert n_disagreeing(wound.surface) == 0
    assert wound_alike(wound.surface) is None
    if name != "parts":  # of a small part by chance more than half may have been turned over
        assert np.allclose(face_area_vectors(wound.surface), face_area_vectors(mesh), rtol=0, atol=1e-12)
    for one, other in zip(faces_of(turned), faces_of(wound.surface), strict=True):
        assert one[0] == other[0] and other[1:] in (one[1:], one[:0:-1])
    assert_same_bits(wound.surface.corner_vertex, turned.corner_vertex[wound.corner])
    assert_same_bits(wound.surface.corner_edge, turned.corner_edge[wound.side])


@pytest.mark.parametrize("seed", range(10))
def test_edges_stay_those_of_the_sides(seed):
    for mesh in (soup(seed), MESHES["moebius strip"](), MESHES["three pages"]()):
        turned = with_reversed(
            mesh, np.random.default_rng(seed).permutation(mesh.n_faces)[: mesh.n_faces // 2]
        )
        wound = wound_alike(turned)
        for surface in (turned, *(() if wound is None else (wound.surface,))):
            sides = np.stack((surface.corner_vertex, surface.corner_vertex[surface.next_corner()]), axis=1)
            assert_same_bits(np.sort(sides, axis=1), np.sort(surface.edges[surface.corner_edge], axis=1))
        assert wound is None or n_disagreeing(wound.surface) < n_disagreeing(turned)


def test_a_surface_of_one_side_disagrees_at_few_edges():
    strip = MESHES["moebius strip"]()
    assert 0 < n_disagreeing(strip) < 5
    assert wound_alike(strip) is None
    turned = turned_over(strip, seed=1)
    wound = wound_alike(turned)
    assert 0 < n_disagreeing(wound.surface) < 0.3 * n_disagreeing(turned)


@pytest.mark.parametrize("name", ORIENTABLE)
def test_neighborhoods_do_not_depend_on_how_faces_are_wound(name):
    mesh = ORIENTABLE[name]()
    turned = turned_over(mesh, seed=5, share=0.1)
    one, two = connect(mesh), connect(turned)
    for field in ("ring_offset", "ring", "boundary_neighbors", "valence", "edge_face_count"):
        assert_same_bits(getattr(one, field), getattr(two, field))
    assert one.is_oriented and not two.is_oriented
    offset = mesh.face_offset
    for f in range(mesh.n_faces):
        part = slice(offset[f], offset[f + 1])
        assert sorted(one.face_across[part]) == sorted(two.face_across[part])
        assert one.face_across[offset[f]] in two.face_across[part]
    has_corner = one.ring_corner >= 0
    vertex, face = turned.corner_vertex, turned.face_of_corner()
    assert_same_bits(vertex[two.ring_corner[has_corner]], mesh.corner_vertex[one.ring_corner[has_corner]])
    assert_same_bits(face[two.ring_corner[has_corner]], face[one.ring_corner[has_corner]])


@pytest.mark.parametrize("region", [Region(), Region(keep_volume=True, along_normals=True)])
@pytest.mark.parametrize("preset", ["AUTO", "TRI_2", "BILATERAL"])
def test_results_do_not_depend_on_how_faces_are_wound(preset, region, rng):
    """With a fiftieth of the faces turned over AUTO left 6.8 degrees instead of 2.1 on a torus."""
    mesh = noisy(triangle_torus(12, 18), rng, 0.3)
    expected = denoise(mesh, PRESETS[preset].settings, region=region, dtype=np.float64)
    for share in (0.02, 0.4):
        turned = turned_over(mesh, seed=2, share=share)
        found = denoise(turned, PRESETS[preset].settings, region=region, dtype=np.float64)
        assert lengths(found.vertices - expected.vertices).max() < 1e-4
        assert found.report.folded_faces == expected.report.folded_faces
        assert found.report.volume_change == pytest.approx(expected.report.volume_change, abs=1e-4)


def test_welded_meshes_are_wound_alike_too(rng):
    """Each face of a soup has vertices of its own, so that only the welded mesh tells how faces agree."""
    mesh = noisy(triangle_torus(12, 18), rng, 0.3)
    turned = turned_over(mesh, seed=2, share=0.1)
    settings, region = PRESETS["AUTO"].settings, Region(weld_distance=0.0)
    vertices, n_damped = [], []
    for surface in (mesh, turned):
        points = surface.vertices[surface.corner_vertex]
        faces = np.arange(surface.n_corners).reshape(-1, 3)
        result = denoise(SurfaceMesh.from_faces(points, faces), settings, region=region)
        vertices.append(np.zeros_like(mesh.vertices))
        vertices[-1][surface.corner_vertex] = result.vertices
        n_damped.append(result.report.damped_vertices)
    assert lengths(vertices[0] - vertices[1]).max() < 1e-4
    assert n_damped[0] == n_damped[1]


@pytest.mark.parametrize("frame", ["AUTO", "ADAPTIVE"])
@pytest.mark.parametrize("name", ["border", "mixed"])
def test_bands_do_not_depend_on_how_faces_are_wound(name, frame, rng):
    mesh = noisy(ORIENTABLE[name](), rng, 0.05)
    turned = turned_over(mesh, seed=4, share=0.2)
    one, two = (equalize(each, [0.0, 2.0], frame=frame) for each in (mesh, turned))
    assert lengths(one - two).max() < 1e-5
    low, other = (FrameTransform(each, frame, 2).analyze(each.vertices).low for each in (mesh, turned))
    assert lengths(low - other).max() < 1e-12


def test_a_large_face_that_touches_many_is_no_work():
    """Each petal of a star, the face in its middle last: joined one by one they took four seconds."""
    n = 20_000
    hub, tips = np.arange(n), np.arange(n, 2 * n)
    petals = np.stack((np.roll(hub, -1), hub, tips), axis=1)
    petals[0] = petals[0, ::-1]
    star = SurfaceMesh.from_faces(
        np.zeros((2 * n, 3)),
        np.concatenate((petals.ravel(), hub)),
        offsets=np.concatenate((np.arange(0, 3 * n + 1, 3), [4 * n])),
    )
    began = process_time()
    wound = wound_alike(star)
    assert process_time() - began < 1.0
    assert wound.is_reversed.tolist() == [True] + n * [False]


def test_the_noise_that_was_taken_away_does_not_depend_on_it(rng):
    clean = triangle_torus(12, 18)
    mesh = noisy(clean, rng, 0.3)
    one = noise_field(mesh, clean.vertices)
    two = noise_field(turned_over(mesh, seed=2, share=0.2), clean.vertices)
    assert np.allclose(one.strength, two.strength, rtol=1e-4)
