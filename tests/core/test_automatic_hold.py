# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertices that slid within the surface go back, but not so far that faces fold."""

import numpy as np
import pytest
from checks import assert_same_bits
from framelet.core import connect
from framelet.core.automatic import hold
from framelet.core.automatic.hold import LARGEST_TURN, held_in_place
from framelet.core.automatic.problem import NormalProblem
from framelet.core.automatic.smooth_positions import smooth_positions
from kinds import ALONE, KIND, KINDS
from meshes import faces_of, noisy, triangle_grid, triangle_torus
from twins import newell


def problem_of(mesh):
    return NormalProblem(mesh.vertices.T.copy(), mesh, connect(mesh), 0.1, ALONE)


def held(points, mesh, share=1.0):
    normals = problem_of(mesh).vertex_normals(points)
    return held_in_place(points, mesh.vertices.T, normals, share, mesh, ALONE)


def turns_of(points, mesh, before):
    """Return by how many degrees the faces turn, by a loop over them."""
    turns = []
    for face in faces_of(mesh):
        one, other = newell(before.T[face]), newell(points.T[face])
        cosine = one @ other / np.linalg.norm(one) / np.linalg.norm(other)
        turns.append(np.degrees(np.arccos(np.clip(cosine, -1, 1))))
    return np.array(turns)


@KIND
def test_motion_within_the_surface_is_taken_back(kind, rng, monkeypatch):
    """Against a loop over the vertices, where nothing may turn too far."""
    monkeypatch.setattr(hold, "LARGEST_TURN", 180.0)
    mesh = noisy(KINDS[kind](), rng)
    points = mesh.vertices.T + 0.1 * rng.normal(size=(3, mesh.n_vertices))
    normals = problem_of(mesh).vertex_normals(points)
    for share in (0.3, 1.0):
        found = held(points, mesh, share)
        for v in range(mesh.n_vertices):
            motion, n = points[:, v] - mesh.vertices[v], normals[:, v]
            kept = (motion @ n) * n
            expected = mesh.vertices[v] + kept + (1 - share) * (motion - kept)
            assert np.abs(found[:, v] - expected).max() < 1e-12
    assert_same_bits(held(points, mesh, 0.0), points)


def test_vertices_that_slid_within_a_sheet_go_back(rng):
    """With heights as the low-pass left them: the shape of an irregular sheet stays, its triangles return."""
    mesh = triangle_grid(20, 20)
    aside = 0.15 * rng.normal(size=(mesh.n_vertices, 2))
    sheet = mesh.with_vertices(mesh.vertices + np.column_stack((aside, np.zeros(mesh.n_vertices))))
    slid = smooth_positions(sheet.vertices.T.copy(), problem_of(sheet).rings, 8)
    assert np.abs(slid - sheet.vertices.T).max() > 0.2 and np.abs(slid[2]).max() == 0
    assert np.abs(held(slid, sheet) - sheet.vertices.T).max() < 1e-12


@pytest.mark.parametrize("share", [0.5, 1.0])
def test_no_face_is_turned_too_far(share, rng):
    """Noise within the surface, so strong that to take motion back would fold many faces."""
    mesh = triangle_torus(30, 40)
    points = mesh.vertices.T.copy()
    spoiled = mesh.with_vertices(mesh.vertices + 0.3 * rng.normal(size=mesh.vertices.shape))
    normals = problem_of(mesh).vertex_normals(points)
    motion = points - spoiled.vertices.T
    within = motion - normals * (normals * motion).sum(axis=0)
    assert (turns_of(points - share * within, mesh, points) > LARGEST_TURN).mean() > 0.2
    found = held_in_place(points, spoiled.vertices.T, normals, share, mesh, ALONE)
    went = np.linalg.norm(found - points, axis=0) / np.linalg.norm(within, axis=0)
    assert went.max() <= share + 1e-9 and 0.2 * share < went.mean() < 0.9 * share
    assert turns_of(found, mesh, points).max() < LARGEST_TURN + 1e-6


def test_faces_without_area_hold_nobody_back(rng):
    mesh = noisy(triangle_grid(6, 6), rng, 0.01)
    flat = mesh.vertices.copy()
    flat[8] = flat[9]  # faces at this edge have no area
    mesh = mesh.with_vertices(flat)
    points = flat.T + 0.001 * rng.normal(size=(3, len(flat)))
    points[:, 8] = points[:, 9]
    found = held(points, mesh)
    normals = problem_of(mesh).vertex_normals(points)
    motion = found - flat.T
    assert np.abs(motion - normals * (normals * motion).sum(axis=0)).max() < 1e-9
