# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Distances and angles between surfaces."""

from math import degrees

import numpy as np
import pytest
from checks import edge_length, lengths, read_only, wild_mesh
from framelet.core import SurfaceMesh, compare
from framelet.core.metrics import normal_angles
from meshes import MESHES, faces_of, noisy, triangle_grid, triangle_torus
from twins import newell


@pytest.mark.parametrize("name", MESHES)
def test_matches_a_loop(name, rng):
    mesh = read_only(noisy(MESHES[name](), rng))
    other = mesh.with_vertices(mesh.vertices + rng.normal(0, 0.3, mesh.vertices.shape))
    angles = []
    for face in faces_of(mesh):
        a, b = newell(mesh.vertices[face]), newell(other.vertices[face])
        if min(np.linalg.norm(a), np.linalg.norm(b)) > 1e-12:
            angles.append(degrees(np.arctan2(np.linalg.norm(np.cross(a, b)), a @ b)))
    distance = lengths(other.vertices - mesh.vertices)
    found = compare(other, mesh)
    if name != "soup":  # faces there may have rounding for an area
        assert found.mean_angle == pytest.approx(np.mean(angles), rel=1e-10)
        assert found.max_angle == pytest.approx(np.max(angles), rel=1e-10)
        assert found.flipped_faces == sum(angle > 90 for angle in angles)
    assert found.rms_distance == pytest.approx(np.sqrt(np.mean(distance**2)))
    assert found.max_distance == pytest.approx(distance.max())
    assert found.mean_edge_length == pytest.approx(edge_length(mesh))


@pytest.mark.parametrize("angle", [0.0, 1e-12, 1e-9, 1e-6, 1e-3, 1.0, 45.0, 90.0, 179.0, 180.0 - 1e-6, 180.0])
def test_angles_are_exact(angle):
    """The arc cosine of a product would lose every angle below 1e-6 degrees."""
    turn = np.radians(angle)
    found = normal_angles(np.array([[1.0, 0.0, 0.0]]), np.array([[np.cos(turn), np.sin(turn), 0.0]]))
    assert found[0] == pytest.approx(angle, rel=1e-9, abs=1e-16)


def test_tiny_angles_of_a_mesh():
    mesh = triangle_grid()
    tilted = mesh.with_vertices(mesh.vertices + mesh.vertices[:, :1] * [0, 0, 1e-9])
    assert compare(tilted, mesh).mean_angle == pytest.approx(degrees(1e-9), rel=1e-6)
    assert compare(tilted, mesh).max_angle == pytest.approx(degrees(1e-9), rel=1e-6)


def test_nothing_is_between_a_mesh_and_itself(rng):
    found = compare(*[noisy(triangle_torus(), rng)] * 2)
    assert (found.mean_angle, found.max_angle, found.rms_distance, found.max_distance) == (0, 0, 0, 0)
    assert found.flipped_faces == 0


def test_float32_and_float64_can_be_compared(rng):
    mesh = noisy(triangle_torus(), rng)
    single = mesh.with_vertices(mesh.vertices.astype(np.float32))
    error = lengths(single.vertices.astype(np.float64) - mesh.vertices)
    assert compare(single, mesh).rms_distance == pytest.approx(np.sqrt(np.mean(error**2)))


def test_faces_without_area_do_not_count():
    mesh = wild_mesh([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2), (0, 0, 0), (1, 1, 2)])
    tilted = mesh.with_vertices(mesh.vertices + mesh.vertices[:, :1] * [0, 0, 1])
    assert compare(tilted, mesh).mean_angle == pytest.approx(45.0)
    zero = np.zeros((1, 3))
    assert np.isnan(normal_angles(zero, np.eye(1, 3))).all()
    assert np.isnan(normal_angles(zero, zero)).all()
    flat = SurfaceMesh.from_faces(np.arange(9.0).reshape(3, 3) * 0, [(0, 1, 2)])
    with pytest.raises(ValueError, match="The reference has no size"):
        compare(flat, flat)


def test_mirrored_faces_are_flipped():
    mesh = triangle_grid()
    assert compare(mesh.with_vertices(mesh.vertices * [-1, 1, 1]), mesh).flipped_faces == mesh.n_faces


@pytest.mark.parametrize(
    ("other", "message"),
    [
        (triangle_grid(3, 4), "The meshes have 12 and 72 vertices; only meshes with the same topology"),
        (MESHES["irregular grid"](), "The meshes have different faces; only meshes with the same topology"),
        (SurfaceMesh.from_faces(np.zeros((72, 3)), []), "The meshes have different faces"),
    ],
)
def test_meshes_that_cannot_be_compared_are_refused(other, message):
    with pytest.raises(ValueError, match=message):
        compare(other, triangle_grid())


def test_there_must_be_something_to_compare():
    bare = SurfaceMesh.from_faces(np.eye(3), [])
    with pytest.raises(ValueError, match="The meshes have no faces; there is nothing to compare"):
        compare(bare, bare)
