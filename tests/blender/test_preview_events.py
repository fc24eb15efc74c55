# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whatever happens while a preview is on, the original bits come back, and edits are kept."""

import bpy
import numpy as np
import pytest

# isort: split
# This module exists once bpy was imported.
import bmesh
from blender_objects import noisy_monkey
from framelet.core import PRESETS, denoise
from framelet.operators import window_events
from framelet.operators.mesh_io import kept_original, mesh_bridge
from framelet.operators.mesh_io.mesh_bridge import read_positions
from framelet.operators.preview import current_preview
from mathutils import Vector
from run_steps import assert_clean, expected_for, same, settle, turn_on

pytestmark = pytest.mark.usefixtures("no_thread_stays")


def test_apply_is_one_undo_step(settings):
    obj = noisy_monkey()
    before = read_positions(obj.data)
    bpy.ops.ed.undo_push(message="Before")
    settle(turn_on())
    settings.lambda_ = 0.4
    # Blender stores a step for a slider, with the mesh as it is shown.
    bpy.ops.ed.undo_push(message="Smoothing")
    settle(current_preview.current_preview())
    bpy.ops.object.framelet_apply_preview()
    after = read_positions(obj.data)
    bpy.ops.ed.undo_push(message="Apply")
    for _ in range(2):
        bpy.ops.ed.undo()
        mesh = bpy.data.objects["Monkey"].data
        assert same(read_positions(mesh), before)
        assert_clean(mesh)
    bpy.ops.ed.redo()
    bpy.ops.ed.redo()
    assert same(read_positions(bpy.data.objects["Monkey"].data), after)
    assert_clean(bpy.data.objects["Monkey"].data)


def test_undo_while_it_is_on_goes_on_with_the_original(settings):
    obj = noisy_monkey()
    surface = mesh_bridge.read_surface(obj)
    bpy.ops.ed.undo_push(message="Before")
    settle(turn_on())
    for lambda_ in (0.4, 0.8):
        settings.lambda_ = lambda_
        settle(current_preview.current_preview())
        bpy.ops.ed.undo_push(message="Smoothing")
    bpy.ops.ed.undo()
    session = current_preview.current_preview()
    settings = bpy.context.scene.framelet
    assert settings.lambda_ == pytest.approx(0.4)
    settle(session)
    mesh = bpy.data.objects["Monkey"].data
    assert same(read_positions(mesh), expected_for(surface, settings))
    current_preview.end_preview()
    assert same(read_positions(mesh), surface.vertices)
    for step in (bpy.ops.ed.redo, bpy.ops.ed.undo, bpy.ops.ed.undo):
        step()
        mesh = bpy.data.objects["Monkey"].data
        assert same(read_positions(mesh), surface.vertices)
        assert_clean(mesh)


def test_saved_files_have_the_original(settings, tmp_path):
    obj = noisy_monkey()
    before = read_positions(obj.data)
    session = turn_on()
    settle(session)
    shown = read_positions(obj.data)
    path = str(tmp_path / "saved.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    assert session.is_on and same(read_positions(obj.data), shown) and not same(shown, before)
    settings.lambda_ = 0.7
    settle(session)
    assert not same(read_positions(obj.data), shown)
    bpy.ops.wm.open_mainfile(filepath=path, load_ui=False)
    assert current_preview.current_preview() is None
    mesh = bpy.data.objects["Monkey"].data
    assert same(read_positions(mesh), before)
    assert_clean(mesh)


def test_files_that_blender_saved_by_itself_are_put_right(settings, tmp_path, monkeypatch):
    """Recovery files are written without the handlers, with the mesh as it is shown."""
    obj = noisy_monkey()
    before = read_positions(obj.data)
    session = turn_on()
    settle(session)
    monkeypatch.setattr(session, "suspend", lambda: None)
    path = str(tmp_path / "recovered.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path, load_ui=False)
    mesh = bpy.data.objects["Monkey"].data
    assert same(read_positions(mesh), before)
    assert_clean(mesh)


def test_another_file_ends_it():
    noisy_monkey()
    session = turn_on()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    assert not session.is_on and current_preview.current_preview() is None
    assert not current_preview.tick_preview()


def test_denoise_works_on_the_original(settings):
    obj = noisy_monkey()
    surface = mesh_bridge.read_surface(obj)
    settings.lambda_ = 2.0
    settle(turn_on())
    assert bpy.ops.object.framelet_denoise(preset="TRI_2") == {"FINISHED"}
    assert current_preview.current_preview() is None
    assert same(read_positions(obj.data), denoise(surface, PRESETS["TRI_2"].settings).vertices)
    assert_clean(obj.data)


def test_other_operators_work_on_the_original(settings):
    obj, twin = noisy_monkey("A"), noisy_monkey("B")
    bpy.ops.object.framelet_add_noise(sigma=0.1, seed=3)
    expected = read_positions(twin.data)
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)
    twin.select_set(False)
    settle(turn_on())
    bpy.ops.object.framelet_add_noise(sigma=0.1, seed=3)
    assert same(read_positions(obj.data), expected)


def test_edit_mode_ends_it(settings):
    obj = noisy_monkey()
    before = read_positions(obj.data)
    session = turn_on()
    settle(session)
    bpy.ops.object.mode_set(mode="EDIT")
    assert not current_preview.tick_preview()
    assert session.message == "The mode of ‘Monkey’ was changed, so that the preview ended."
    assert same(mesh_bridge.read_surface(obj).vertices, before)
    assert kept_original.ORIGINAL not in bmesh.from_edit_mesh(obj.data).verts.layers.float_vector
    bpy.ops.object.mode_set(mode="OBJECT")
    assert same(read_positions(obj.data), before)
    assert_clean(obj.data)


@pytest.mark.parametrize("mode", ["SCULPT", "WEIGHT_PAINT"])
def test_other_modes_end_it(mode, settings):
    obj = noisy_monkey()
    before = read_positions(obj.data)
    settle(turn_on())
    bpy.ops.object.mode_set(mode=mode)
    assert not current_preview.tick_preview()
    assert same(read_positions(obj.data), before)
    bpy.ops.object.mode_set(mode="OBJECT")
    assert same(read_positions(obj.data), before)
    assert_clean(obj.data)


def test_deleting_the_object_ends_it(settings):
    obj = noisy_monkey()
    twin = bpy.data.objects.new("Twin", obj.data)
    bpy.context.collection.objects.link(twin)
    before = read_positions(obj.data)
    session = turn_on()
    settle(session)
    bpy.ops.object.delete()
    assert not current_preview.tick_preview()
    assert session.message == "‘Monkey’ was deleted, so that the preview ended."
    assert same(read_positions(twin.data), before)
    assert_clean(twin.data)


def test_deleting_the_mesh_too_ends_it(settings):
    obj = noisy_monkey()
    settle(turn_on())
    bpy.data.meshes.remove(obj.data)
    assert not current_preview.tick_preview()


def test_an_edit_of_some_vertices_is_kept(settings):
    obj = noisy_monkey()
    before = read_positions(obj.data)
    session = turn_on()
    settle(session)
    shown = read_positions(obj.data)
    assert (shown[5] != before[5]).any()
    obj.data.vertices[5].co.z += 0.25
    obj.data.update()
    bpy.context.view_layer.update()
    assert not current_preview.tick_preview()
    assert "was edited" in session.message
    after = read_positions(obj.data)
    others = np.arange(len(after)) != 5
    assert same(after[others], before[others])
    assert np.allclose(after[5], before[5] + [0, 0, 0.25], atol=1e-6)
    assert_clean(obj.data)


def test_applying_a_scale_gives_the_original_with_it(settings):
    obj = noisy_monkey()
    before = read_positions(obj.data)
    obj.scale = (0.1, 0.2, -0.3)
    settle(turn_on())
    bpy.ops.object.transform_apply(location=False, rotation=False)
    bpy.context.view_layer.update()
    assert not current_preview.tick_preview()
    assert "was edited, so that the preview ended" in current_preview.preview_message()
    assert np.allclose(read_positions(obj.data), before * (0.1, 0.2, -0.3), atol=1e-6)
    assert_clean(obj.data)


def test_an_edit_of_all_vertices_keeps_what_is_shown(settings):
    obj = noisy_monkey()
    settle(turn_on())
    bent = read_positions(obj.data)
    bent[:, 2] += bent[:, 0] ** 2 + 0.1
    mesh_bridge.show_positions(obj.data, bent)
    bpy.context.view_layer.update()
    assert not current_preview.tick_preview()
    assert "it keeps what the preview showed" in current_preview.preview_message()
    assert same(read_positions(obj.data), bent)
    assert_clean(obj.data)


def test_copies_of_the_object_have_the_original(settings):
    obj = noisy_monkey()
    before = read_positions(obj.data)
    session = turn_on()
    settle(session)
    shown = read_positions(obj.data)
    bpy.ops.object.duplicate()
    copy = bpy.context.object
    assert copy != obj and same(read_positions(copy.data), shown)
    bpy.context.view_layer.update()
    assert current_preview.tick_preview()
    assert same(read_positions(copy.data), before) and same(read_positions(obj.data), shown)
    assert_clean(copy.data)


POSES = {
    "as it is": {},
    "moved": {"location": (3.0, -1.0, 0.5)},
    "turned and scaled": {"location": (3.0, 0, 0), "rotation_euler": (0.3, 1, 2), "scale": (2, 0.5, -1)},
}


@pytest.mark.parametrize("active", ["A", "B"])
@pytest.mark.parametrize("pose", POSES)
def test_a_join_takes_the_original(active, pose, settings, tmp_path):
    """Whichever object stays, the joined mesh has the original, and nothing is left of the preview."""
    obj, other = noisy_monkey("A"), noisy_monkey("B")
    for name, value in POSES[pose].items():
        setattr(other, name, value)
    bpy.context.view_layer.update()
    into, of = bpy.data.objects[active], other if active == "A" else obj
    to_joined = into.matrix_world.inverted() @ of.matrix_world
    moved = np.array([to_joined @ vertex.co for vertex in of.data.vertices], np.float32)
    expected = np.concatenate((read_positions(into.data), moved))
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)
    settle(turn_on())
    bpy.context.view_layer.objects.active = into
    bpy.ops.object.join()
    path = str(tmp_path / "joined.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)  # before any tick
    assert not current_preview.tick_preview()
    for _ in range(2):
        joined = bpy.data.objects[active].data
        assert len(joined.vertices) == 2 * 507
        assert np.allclose(read_positions(joined), expected, atol=2e-6)
        assert_clean(joined)
        bpy.ops.wm.open_mainfile(filepath=path, load_ui=False)


def test_a_flat_mesh_that_is_joined_has_its_noise_back(settings):
    """What is shown may lie in a plane, which says nothing of the way across it."""
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=9, y_subdivisions=9)
    flat = bpy.context.object
    original = read_positions(flat.data)
    noisy = original + np.float32([0, 0, 0.05]) * np.random.default_rng(0).normal(size=(len(original), 1))
    kept_original.keep(flat.data, noisy.astype(np.float32), original)
    other = noisy_monkey("Other", (2, 0, 0))
    other.rotation_euler, other.scale = (0.5, 0.3, 0), (2, 2, 2)
    bpy.context.view_layer.update()
    to_joined = other.matrix_world.inverted() @ flat.matrix_world
    expected = [to_joined @ Vector(point) for point in noisy]
    flat.select_set(True)
    bpy.ops.object.join()
    kept_original.put_all_back()
    assert np.allclose(read_positions(other.data)[507:], expected, atol=2e-6)


def test_subdivided_meshes_have_the_original(settings):
    obj = noisy_monkey()
    twin = bpy.data.objects.new("Twin", obj.data.copy())
    bpy.context.collection.objects.link(twin)
    settle(turn_on())
    for each in (obj, twin):
        bpy.context.view_layer.objects.active = each
        edit_mesh = bmesh.new()
        edit_mesh.from_mesh(each.data)
        bmesh.ops.subdivide_edges(edit_mesh, edges=edit_mesh.edges[:], cuts=1)
        edit_mesh.to_mesh(each.data)
        edit_mesh.free()
    assert not current_preview.tick_preview()
    assert np.allclose(read_positions(obj.data), read_positions(twin.data), atol=1e-6)
    assert_clean(obj.data)


@pytest.mark.parametrize("job", ["RENDER", "OBJECT_BAKE"])
def test_nothing_is_written_while_meshes_are_read(settings, monkeypatch, job):
    obj = noisy_monkey()
    session = turn_on()
    settle(session)
    shown = read_positions(obj.data)
    jobs = {job}
    monkeypatch.setattr(window_events, "is_job_running", lambda name: name in jobs)
    settings.lambda_ = 0.9
    assert current_preview.tick_preview()
    assert session.wait(60) and current_preview.tick_preview()
    assert same(read_positions(obj.data), shown)
    jobs.clear()
    settle(session)
    assert not same(read_positions(obj.data), shown) and session.is_current


def test_unregistering_ends_it(settings):
    import framelet

    obj = noisy_monkey()
    before = read_positions(obj.data)
    settle(turn_on())
    framelet.unregister()
    try:
        assert same(read_positions(obj.data), before)
        assert_clean(obj.data)
    finally:
        framelet.register()
