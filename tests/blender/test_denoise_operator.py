# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator Denoise does what core does, to the right vertices of the right meshes, and says so."""

import bpy
import numpy as np
import pytest

# isort: split
# This module exists once bpy was imported.
import bmesh
from blender_objects import noisy_monkey, read, select_only
from framelet.core import DEFAULT_PRESET, PRESETS, DenoiseSettings, denoise
from framelet.operators.mesh_io import mesh_bridge
from framelet.operators.run.denoise_object import denoise_object

# A quick algorithm, for what all of them have in common.
QUICK = "POSITIONS"
QUICK_SETTINGS = PRESETS[QUICK].settings


def select_vertices(obj, is_selected):
    """Select vertices in Edit Mode."""
    edit_mesh = bmesh.from_edit_mesh(obj.data)
    for vert in edit_mesh.verts:
        vert.select_set(False)
    for vert in edit_mesh.verts:
        if is_selected[vert.index]:
            vert.select = True
    bmesh.update_edit_mesh(obj.data)


def last_report():
    return bpy.context.window_manager.framelet_report


@pytest.mark.parametrize("preset", list(PRESETS))
def test_operator_equals_core(preset):
    obj = noisy_monkey()
    surface = mesh_bridge.read_surface(obj)
    expected = denoise(surface, PRESETS[preset].settings)
    assert bpy.ops.object.framelet_denoise(preset=preset) == {"FINISHED"}
    assert read(obj).tobytes() == expected.vertices.tobytes()
    assert expected.report.n_moved > 0


def test_values_given_by_a_script_override_the_preset():
    obj = noisy_monkey()
    surface = mesh_bridge.read_surface(obj)
    settings = PRESETS["TRI_1"].settings.with_changes(mu=2.3, iterations=7, boundary="FIXED")
    expected = denoise(surface, settings)
    bpy.ops.object.framelet_denoise(mu=2.3, boundary="FIXED", iterations=7, preset="TRI_1")
    assert read(obj).tobytes() == expected.vertices.tobytes()


def test_no_arguments_mean_the_default_preset_whatever_the_scene_says():
    obj = noisy_monkey()
    expected = denoise(mesh_bridge.read_surface(obj), PRESETS[DEFAULT_PRESET].settings)
    bpy.context.scene.framelet.preset = "TRI_1"
    bpy.context.scene.framelet.strength = 2.0
    bpy.ops.object.framelet_denoise()
    assert read(obj).tobytes() == expected.vertices.tobytes()


def test_denoise_object_equals_core_and_reports():
    obj = noisy_monkey()
    settings = DenoiseSettings(method="POSITIONS", lambda_=0.2)
    expected = denoise(mesh_bridge.read_surface(obj), settings)
    report = denoise_object(obj, settings)
    assert read(obj).tobytes() == expected.vertices.tobytes()
    assert report.displacement_rms == expected.report.displacement_rms


def test_a_stopped_run_leaves_the_mesh():
    obj = noisy_monkey()
    before = read(obj)
    report = denoise_object(obj, QUICK_SETTINGS, callback=lambda fraction, change: True)
    assert report.is_stopped
    assert read(obj).tobytes() == before.tobytes()


def test_edit_mode_moves_selected_visible_vertices_only():
    obj = noisy_monkey()
    bpy.ops.object.mode_set(mode="EDIT")
    surface = mesh_bridge.read_surface(obj)
    is_selected = np.arange(surface.n_vertices) < 200
    select_vertices(obj, is_selected)
    edit_mesh = bmesh.from_edit_mesh(obj.data)
    edit_mesh.verts.ensure_lookup_table()
    edit_mesh.verts[3].hide = True
    movable = is_selected.copy()
    movable[3] = False
    expected = denoise(surface, QUICK_SETTINGS, movable=movable)
    assert bpy.ops.object.framelet_denoise(preset=QUICK) == {"FINISHED"}
    assert obj.mode == "EDIT"
    assert read(obj).tobytes() == expected.vertices.tobytes()
    bpy.ops.object.mode_set(mode="OBJECT")
    after = read(obj)
    assert after.tobytes() == expected.vertices.tobytes()
    assert after[~movable].tobytes() == surface.vertices[~movable].tobytes()
    assert (after[movable] != surface.vertices[movable]).any()


def test_all_meshes_in_edit_mode_are_denoised():
    objects = [noisy_monkey("A"), noisy_monkey("B", (3, 0, 0)), noisy_monkey("C", (6, 0, 0))]
    before = [read(obj) for obj in objects]
    select_only(objects[0], objects[1])
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.object.framelet_denoise(preset=QUICK)
    bpy.ops.object.mode_set(mode="OBJECT")
    changed = [read(obj).tobytes() != old.tobytes() for obj, old in zip(objects, before, strict=True)]
    assert changed == [True, True, False]
    assert last_report().n_objects == 2


def test_all_selected_meshes_are_denoised_and_others_are_not():
    objects = [noisy_monkey("A"), noisy_monkey("B"), noisy_monkey("C")]
    bpy.ops.object.light_add()
    light = bpy.context.object
    before = [read(obj) for obj in objects]
    select_only(light, objects[0], objects[2])
    bpy.ops.object.framelet_denoise(preset=QUICK)
    changed = [read(obj).tobytes() != old.tobytes() for obj, old in zip(objects, before, strict=True)]
    assert changed == [True, False, True]
    assert sorted(last_report().names.split(", ")) == ["A", "C"]


def test_a_mesh_of_two_objects_is_denoised_once():
    obj = noisy_monkey("A")
    twin = bpy.data.objects.new("Twin", obj.data)
    bpy.context.collection.objects.link(twin)
    expected = denoise(mesh_bridge.read_surface(obj), QUICK_SETTINGS)
    select_only(twin, obj)
    bpy.ops.object.framelet_denoise(preset=QUICK)
    assert read(obj).tobytes() == expected.vertices.tobytes()
    assert last_report().names == "Twin", "the active object stands for the mesh"
    assert obj.data.users == 2


def test_modifiers_are_left_alone():
    obj = noisy_monkey()
    expected = denoise(mesh_bridge.read_surface(obj), QUICK_SETTINGS)
    obj.modifiers.new("Subdivision", "SUBSURF").levels = 1
    obj.modifiers.new("Mirror", "MIRROR")
    bpy.ops.object.framelet_denoise(preset=QUICK)
    assert [modifier.type for modifier in obj.modifiers] == ["SUBSURF", "MIRROR"]
    assert read(obj).tobytes() == expected.vertices.tobytes()


def test_the_active_shape_key_is_denoised(rng):
    obj = noisy_monkey()
    basis = obj.shape_key_add(name="Basis")
    smile = obj.shape_key_add(name="Smile")
    wide = mesh_bridge.read_surface(obj).vertices * np.float32([2, 1, 1])
    smile.data.foreach_set("co", wide.reshape(-1))
    obj.active_shape_key_index = 1
    basis_before = [tuple(point.co) for point in basis.data]
    surface = mesh_bridge.read_surface(obj)
    assert np.array_equal(surface.vertices, wide)
    expected = denoise(surface, QUICK_SETTINGS)
    bpy.ops.object.framelet_denoise(preset=QUICK)
    assert read(obj).tobytes() == expected.vertices.tobytes()
    assert [tuple(point.co) for point in basis.data] == basis_before
    assert [tuple(vertex.co) for vertex in obj.data.vertices] == basis_before


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
def test_undo_restores(mode):
    obj = noisy_monkey()
    before = read(obj)
    bpy.ops.object.mode_set(mode=mode)
    if mode == "EDIT":
        bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.ed.undo_push(message="Before")
    bpy.ops.object.framelet_denoise(preset=QUICK)
    bpy.ops.ed.undo_push(message="Denoise")
    assert read(bpy.data.objects["Monkey"]).tobytes() != before.tobytes()
    bpy.ops.ed.undo()
    assert read(bpy.data.objects["Monkey"]).tobytes() == before.tobytes()
    bpy.ops.ed.redo()
    assert read(bpy.data.objects["Monkey"]).tobytes() != before.tobytes()
