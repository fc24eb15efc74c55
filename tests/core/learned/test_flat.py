# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A flat mesh has nothing to clean."""

import numpy as np
import pytest
from checks import TRIANGLE_PRESETS, lengths, preset_settings, random_rotation
from framelet.core import PRESETS, denoise
from framelet.core.mesh.surface_mesh import SurfaceMesh
from mesh_files import read_mesh
from meshes import flipped, pyramid, quad_grid, triangle_grid

UNMOVED = 1e-5
"""Mean edge lengths that rounding may move a vertex in float32; the meshes are about ten edges wide."""

FLAT = {
    "triangle grid": triangle_grid,
    "quad grid": quad_grid,
    "single triangle": lambda: SurfaceMesh.from_faces([(0, 0, 0), (1, 0, 0), (0.3, 0.9, 0)], [(0, 1, 2)]),
    "single quad": lambda: quad_grid(2, 2),
    "single hexagon": lambda: SurfaceMesh.from_faces(
        [(np.cos(k * np.pi / 3), np.sin(k * np.pi / 3), 0) for k in range(6)], [range(6)]
    ),
}
HELD = pytest.mark.parametrize("boundary", ["ALONG", "FIXED"])


def settings_of(preset, boundary):
    return preset_settings(preset, boundary=boundary, iterations=30)


@pytest.mark.parametrize("name", FLAT)
@pytest.mark.parametrize("preset", TRIANGLE_PRESETS)
@HELD
def test_flat_meshes_come_back_unchanged(name, preset, boundary):
    mesh = FLAT[name]()
    moved = denoise(mesh, settings_of(preset, boundary)).vertices - mesh.vertices
    assert (moved[:, 2] == 0).all()
    assert lengths(moved).max() < UNMOVED


@pytest.mark.parametrize("name", FLAT)
@pytest.mark.parametrize("preset", TRIANGLE_PRESETS)
@HELD
def test_tilted_flat_meshes_come_back_unchanged(name, preset, boundary, rng):
    mesh = FLAT[name]()
    mesh = mesh.with_vertices(mesh.vertices @ random_rotation(rng) + 3.0)
    assert lengths(denoise(mesh, settings_of(preset, boundary)).vertices - mesh.vertices).max() < UNMOVED


@pytest.mark.parametrize("file", ["flat_triangles.obj", "flat_quads.obj"])
@pytest.mark.parametrize("preset", TRIANGLE_PRESETS)
@HELD
def test_flat_files_come_back_unchanged(shared_meshes, file, preset, boundary):
    mesh = read_mesh(shared_meshes / "bad" / file)
    moved = denoise(mesh, settings_of(preset, boundary)).vertices - mesh.vertices
    assert lengths(moved).max() < UNMOVED


@pytest.mark.parametrize("preset", ["TRI_2", "BILATERAL"])
@pytest.mark.parametrize("boundary", ["ALONG", "FIXED", "FREE"])
def test_a_plane_stays_a_plane_whatever_its_triangles(preset, boundary, rng):
    """In the plane an uneven mesh may be evened out; TRI_1 shrinks along the axes, see the next test."""
    mesh = flipped(triangle_grid(9, 9))
    flat = mesh.vertices + rng.normal(0, 0.2, mesh.vertices.shape) * [1, 1, 0]
    rotation = random_rotation(rng)
    solved = denoise(mesh.with_vertices(flat @ rotation), settings_of(preset, boundary), dtype=np.float64)
    assert np.abs((solved.vertices @ rotation.T)[:, 2]).max() < 1e-12


@pytest.mark.parametrize("preset", TRIANGLE_PRESETS)
@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_plane_across_an_axis_stays_a_plane(preset, axis, rng):
    mesh = flipped(triangle_grid(9, 9))
    flat = mesh.vertices + rng.normal(0, 0.2, mesh.vertices.shape) * [1, 1, 0]
    solved = denoise(mesh.with_vertices(np.roll(flat, axis, axis=1)), PRESETS[preset].settings)
    assert (solved.vertices[:, (2 + axis) % 3] == 0).all()


@pytest.mark.parametrize("preset", ["TRI_2", "BILATERAL"])
def test_a_flat_regular_fan_is_still(preset):
    """One vertex inside, a rim of corners that may only leave the plane."""
    mesh = pyramid(6, closed=True)
    mesh = mesh.with_vertices(mesh.vertices * [1, 1, 0])
    assert lengths(denoise(mesh, settings_of(preset, "ALONG")).vertices - mesh.vertices).max() < UNMOVED
