# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator Add Noise: the paper's noise, repeatable, on the selected meshes or vertices."""

import bpy
import numpy as np
import pytest

# isort: split
# This module exists once bpy was imported.
import bmesh
from framelet.core import add_noise
from framelet.operators.mesh_io import mesh_bridge


@pytest.fixture
def sphere(empty_scene):
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3)
    return bpy.context.object


def test_operator_equals_core(sphere):
    surface = mesh_bridge.read_surface(sphere)
    assert bpy.ops.object.framelet_add_noise(sigma=0.3, seed=5) == {"FINISHED"}
    assert mesh_bridge.read_surface(sphere).vertices.tobytes() == add_noise(surface, 0.3, 5).tobytes()


def test_default_is_the_papers_noise(sphere):
    surface = mesh_bridge.read_surface(sphere)
    bpy.ops.object.framelet_add_noise()
    assert mesh_bridge.read_surface(sphere).vertices.tobytes() == add_noise(surface, 0.2, 0).tobytes()


def test_edit_mode_moves_selected_vertices_only(sphere):
    bpy.ops.object.mode_set(mode="EDIT")
    surface = mesh_bridge.read_surface(sphere)
    bpy.ops.mesh.select_all(action="DESELECT")
    for vert in bmesh.from_edit_mesh(sphere.data).verts:
        vert.select = vert.index < 50
    bpy.ops.object.framelet_add_noise(seed=2)
    after = mesh_bridge.read_surface(sphere).vertices
    assert after[:50].tobytes() == add_noise(surface, 0.2, 2)[:50].tobytes()
    assert after[50:].tobytes() == surface.vertices[50:].tobytes()


def test_zero_noise_changes_nothing(sphere):
    before = mesh_bridge.read_surface(sphere).vertices
    assert bpy.ops.object.framelet_add_noise(sigma=0.0) == {"FINISHED"}
    assert np.array_equal(mesh_bridge.read_surface(sphere).vertices, before)


def test_nothing_selected_in_edit_mode_gets_a_sentence(sphere):
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="DESELECT")
    with pytest.raises(RuntimeError, match="has no selected vertices"):
        bpy.ops.object.framelet_add_noise()


def test_no_faces_get_a_sentence():
    obj = bpy.data.objects.new("Nothing", bpy.data.meshes.new("Nothing"))
    bpy.context.collection.objects.link(obj)
    obj.select_set(True)
    with pytest.raises(RuntimeError, match="‘Nothing’ has no faces"):
        bpy.ops.object.framelet_add_noise()


def test_denoising_brings_the_sphere_back():
    # Fine enough that the curvature is small against the noise.
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=6)
    sphere = bpy.context.object
    clean = mesh_bridge.read_surface(sphere).vertices

    def error():
        return np.linalg.norm(mesh_bridge.read_surface(sphere).vertices - clean, axis=1).mean()

    bpy.ops.object.framelet_add_noise()
    noisy = error()
    bpy.ops.object.framelet_denoise(preset="POSITIONS")
    assert error() < noisy
