# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The live preview shows what Denoise would give, and whatever happens the original bits come back."""

import threading

import bpy
import numpy as np
import pytest

# isort: split
# This module exists once bpy was imported.
import bmesh
from framelet.core import PRESETS, add_noise, denoise
from framelet.operators import current_preview, kept_original, mesh_bridge, preview_session
from framelet.operators.setting_values import to_settings
from meshes import noisy, triangle_grid

SECONDS = 60


def monkey(name="Monkey"):
    bpy.ops.mesh.primitive_monkey_add()
    obj = bpy.context.object
    obj.name = obj.data.name = name
    surface = mesh_bridge.read_surface(obj)
    mesh_bridge.write_vertices(obj, surface, add_noise(surface, 0.2, 1))
    return obj


def points(mesh):
    return mesh_bridge.read_positions(mesh)


def same(first, second):
    return first.tobytes() == second.tobytes()


@pytest.fixture
def settings(empty_scene):
    found = bpy.context.scene.framelet
    found.preset = "POSITIONS"
    return found


@pytest.fixture(autouse=True)
def no_thread_stays():
    yield
    current_preview.stop_preview()
    assert not [thread for thread in threading.enumerate() if thread.name.startswith("framelet")]


def turn_on():
    assert bpy.ops.object.framelet_preview() == {"FINISHED"}
    session = current_preview.current_preview()
    assert session is not None
    return session


def settle(session):
    """Tick as the timer does until all that was asked for is shown."""
    current_preview.tick_preview()
    assert session.wait(SECONDS)
    current_preview.tick_preview()


def expected_for(surface, settings):
    return denoise(surface, to_settings(settings)).vertices


def assert_clean(mesh):
    """No trace of a preview is left."""
    assert kept_original.ORIGINAL not in mesh.attributes and kept_original.COUNT not in mesh


def test_it_shows_what_denoise_gives_and_off_restores_the_bits(settings):
    obj = monkey()
    obj.data.vertices[7].co.x = -0.0
    surface = mesh_bridge.read_surface(obj)
    session = turn_on()
    shown = []
    for lambda_ in (0.1, 0.5, 2.0, 0.0):
        settings.lambda_ = lambda_
        settle(session)
        assert session.is_current and session.message == ""
        assert same(points(obj.data), expected_for(surface, settings))
        shown.append(points(obj.data).tobytes())
    assert len(set(shown)) == 4
    assert bpy.ops.object.framelet_preview() == {"FINISHED"}
    assert current_preview.current_preview() is None
    assert same(points(obj.data), surface.vertices)
    assert_clean(obj.data)


@pytest.mark.parametrize("preset", ["AUTO", "TRI_2", "FREE_FORM", "BILATERAL"])
def test_all_methods(preset, settings):
    obj = monkey()
    surface = mesh_bridge.read_surface(obj)
    settings.preset = preset
    session = turn_on()
    settle(session)
    assert same(points(obj.data), expected_for(surface, settings))
    if preset == "AUTO":
        settings.strength = 0.4
        settle(session)
        assert same(points(obj.data), expected_for(surface, settings))


def test_stencils_are_prepared_once(settings, monkeypatch):
    from framelet.core.denoising import preparation_cache

    made, original = [], preparation_cache.prepare

    def prepare(*given, previous=None, **more):
        found = original(*given, previous=previous, **more)
        made.append(found is previous)
        return found

    monkeypatch.setattr(preparation_cache, "prepare", prepare)
    monkey()
    session = turn_on()
    for lambda_ in (0.1, 0.2, 0.3):
        settings.lambda_ = lambda_
        settle(session)
    assert made[0] is False and all(made[1:]) and len(made) >= 3


def test_apply_keeps_it_and_reports_it(settings):
    obj = monkey()
    surface = mesh_bridge.read_surface(obj)
    session = turn_on()
    assert not session.is_current and not bpy.ops.object.framelet_apply_preview.poll()
    with pytest.raises(ValueError, match="does not show these settings yet"):
        session.apply()
    settle(session)
    assert bpy.ops.object.framelet_apply_preview() == {"FINISHED"}
    assert current_preview.current_preview() is None
    assert same(points(obj.data), expected_for(surface, settings))
    assert_clean(obj.data)
    assert bpy.context.window_manager.framelet_report.names == "Monkey"


@pytest.mark.parametrize("output", ["SHAPE_KEY", "NEW_OBJECT"])
def test_apply_goes_where_output_says(output, settings):
    obj = monkey()
    surface = mesh_bridge.read_surface(obj)
    settings.output = output
    settle(turn_on())
    bpy.ops.object.framelet_apply_preview()
    assert same(points(obj.data), surface.vertices)
    assert_clean(obj.data)
    expected = expected_for(surface, settings)
    if output == "SHAPE_KEY":
        assert same(mesh_bridge.read_surface(obj).vertices, expected)
    else:
        new = bpy.data.objects["Monkey.denoised"]
        assert same(points(new.data), expected)
        assert_clean(new.data)


def test_apply_is_one_undo_step(settings):
    obj = monkey()
    before = points(obj.data)
    bpy.ops.ed.undo_push(message="Before")
    settle(turn_on())
    settings.lambda_ = 0.4
    # Blender stores a step for a slider, with the mesh as it is shown.
    bpy.ops.ed.undo_push(message="Smoothing")
    settle(current_preview.current_preview())
    bpy.ops.object.framelet_apply_preview()
    after = points(obj.data)
    bpy.ops.ed.undo_push(message="Apply")
    for _ in range(2):
        bpy.ops.ed.undo()
        mesh = bpy.data.objects["Monkey"].data
        assert same(points(mesh), before)
        assert_clean(mesh)
    bpy.ops.ed.redo()
    bpy.ops.ed.redo()
    assert same(points(bpy.data.objects["Monkey"].data), after)
    assert_clean(bpy.data.objects["Monkey"].data)


def test_undo_while_it_is_on_goes_on_with_the_original(settings):
    obj = monkey()
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
    assert same(points(mesh), expected_for(surface, settings))
    current_preview.end_preview()
    assert same(points(mesh), surface.vertices)
    for step in (bpy.ops.ed.redo, bpy.ops.ed.undo, bpy.ops.ed.undo):
        step()
        mesh = bpy.data.objects["Monkey"].data
        assert same(points(mesh), surface.vertices)
        assert_clean(mesh)


def test_saved_files_have_the_original(settings, tmp_path):
    obj = monkey()
    before = points(obj.data)
    session = turn_on()
    settle(session)
    shown = points(obj.data)
    path = str(tmp_path / "saved.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    assert session.is_on and same(points(obj.data), shown) and not same(shown, before)
    settings.lambda_ = 0.7
    settle(session)
    assert not same(points(obj.data), shown)
    bpy.ops.wm.open_mainfile(filepath=path, load_ui=False)
    assert current_preview.current_preview() is None
    mesh = bpy.data.objects["Monkey"].data
    assert same(points(mesh), before)
    assert_clean(mesh)


def test_files_that_blender_saved_by_itself_are_put_right(settings, tmp_path, monkeypatch):
    """Recovery files are written without the handlers, with the mesh as it is shown."""
    obj = monkey()
    before = points(obj.data)
    session = turn_on()
    settle(session)
    monkeypatch.setattr(session, "suspend", lambda: None)
    path = str(tmp_path / "recovered.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path, load_ui=False)
    mesh = bpy.data.objects["Monkey"].data
    assert same(points(mesh), before)
    assert_clean(mesh)


def test_another_file_ends_it():
    monkey()
    session = turn_on()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    assert not session.is_on and current_preview.current_preview() is None
    assert not current_preview.tick_preview()


def test_denoise_works_on_the_original(settings):
    obj = monkey()
    surface = mesh_bridge.read_surface(obj)
    settings.lambda_ = 2.0
    settle(turn_on())
    assert bpy.ops.object.framelet_denoise(preset="TRI_2") == {"FINISHED"}
    assert current_preview.current_preview() is None
    assert same(points(obj.data), denoise(surface, PRESETS["TRI_2"].settings).vertices)
    assert_clean(obj.data)


def test_other_operators_work_on_the_original(settings):
    obj, twin = monkey("A"), monkey("B")
    bpy.ops.object.framelet_add_noise(sigma=0.1, seed=3)
    expected = points(twin.data)
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)
    twin.select_set(False)
    settle(turn_on())
    bpy.ops.object.framelet_add_noise(sigma=0.1, seed=3)
    assert same(points(obj.data), expected)


def test_edit_mode_ends_it(settings):
    obj = monkey()
    before = points(obj.data)
    session = turn_on()
    settle(session)
    bpy.ops.object.mode_set(mode="EDIT")
    assert not current_preview.tick_preview()
    assert session.message == "The mode of ‘Monkey’ was changed, so that the preview ended."
    assert same(mesh_bridge.read_surface(obj).vertices, before)
    assert kept_original.ORIGINAL not in bmesh.from_edit_mesh(obj.data).verts.layers.float_vector
    bpy.ops.object.mode_set(mode="OBJECT")
    assert same(points(obj.data), before)
    assert_clean(obj.data)


@pytest.mark.parametrize("mode", ["SCULPT", "WEIGHT_PAINT"])
def test_other_modes_end_it(mode, settings):
    obj = monkey()
    before = points(obj.data)
    settle(turn_on())
    bpy.ops.object.mode_set(mode=mode)
    assert not current_preview.tick_preview()
    assert same(points(obj.data), before)
    bpy.ops.object.mode_set(mode="OBJECT")
    assert same(points(obj.data), before)
    assert_clean(obj.data)


def test_deleting_the_object_ends_it(settings):
    obj = monkey()
    twin = bpy.data.objects.new("Twin", obj.data)
    bpy.context.collection.objects.link(twin)
    before = points(obj.data)
    session = turn_on()
    settle(session)
    bpy.ops.object.delete()
    assert not current_preview.tick_preview()
    assert session.message == "‘Monkey’ was deleted, so that the preview ended."
    assert same(points(twin.data), before)
    assert_clean(twin.data)


def test_deleting_the_mesh_too_ends_it(settings):
    obj = monkey()
    settle(turn_on())
    bpy.data.meshes.remove(obj.data)
    assert not current_preview.tick_preview()


def test_an_edit_of_some_vertices_is_kept(settings):
    obj = monkey()
    before = points(obj.data)
    session = turn_on()
    settle(session)
    shown = points(obj.data)
    assert (shown[5] != before[5]).any()
    obj.data.vertices[5].co.z += 0.25
    obj.data.update()
    bpy.context.view_layer.update()
    assert not current_preview.tick_preview()
    assert "was edited" in session.message
    after = points(obj.data)
    others = np.arange(len(after)) != 5
    assert same(after[others], before[others])
    assert np.allclose(after[5], before[5] + [0, 0, 0.25], atol=1e-6)
    assert_clean(obj.data)


def test_an_edit_of_all_vertices_keeps_what_is_shown(settings):
    obj = monkey()
    obj.scale = (0.1, 0.1, 0.1)
    settle(turn_on())
    shown = points(obj.data)
    bpy.ops.object.transform_apply(location=False, rotation=False)
    bpy.context.view_layer.update()
    assert not current_preview.tick_preview()
    assert "it keeps what the preview showed" in current_preview.preview_message()
    assert np.allclose(points(obj.data), 0.1 * shown, rtol=1e-5)
    assert_clean(obj.data)


def test_copies_of_the_object_have_the_original(settings):
    obj = monkey()
    before = points(obj.data)
    session = turn_on()
    settle(session)
    shown = points(obj.data)
    bpy.ops.object.duplicate()
    copy = bpy.context.object
    assert copy != obj and same(points(copy.data), shown)
    bpy.context.view_layer.update()
    assert current_preview.tick_preview()
    assert same(points(copy.data), before) and same(points(obj.data), shown)
    assert_clean(copy.data)


def test_joined_vertices_are_not_pulled_to_the_origin(settings):
    obj, other = monkey("A"), monkey("B")
    other.location.x = 5
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)
    settle(turn_on())
    bpy.ops.object.join()
    joined = points(obj.data)
    assert len(joined) == 2 * 507 and joined[:, 0].max() > 4
    assert not current_preview.tick_preview()
    assert same(points(obj.data), joined)
    assert_clean(obj.data)


def test_wrong_settings_show_the_original_and_a_sentence(settings):
    surface_of = triangle_grid(9, 9)
    mesh = bpy.data.meshes.new("Grid")
    faces = surface_of.corner_vertex.reshape(-1, 3).tolist()
    mesh.from_pydata(noisy(surface_of, np.random.default_rng(1)).vertices.tolist(), [], faces)
    obj = bpy.data.objects.new("Grid", mesh)
    bpy.context.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    before = points(mesh)
    session = turn_on()
    settle(session)
    assert not same(points(mesh), before)
    settings.frame = "LINEAR_SPLINE"
    settle(session)
    assert session.is_on and not session.is_current
    assert session.message.startswith("‘Grid’: ") and "quads" in session.message
    assert same(points(mesh), before)
    settings.frame = "AUTO"
    settle(session)
    assert session.message == "" and not same(points(mesh), before)


def test_regions_are_followed(settings):
    obj = monkey()
    surface = mesh_bridge.read_surface(obj)
    group = obj.vertex_groups.new(name="Part")
    group.add(list(range(100)), 1.0, "REPLACE")
    session = turn_on()
    settle(session)
    assert (points(obj.data) != surface.vertices)[100:].any()
    settings.vertex_group = "Part"
    settle(session)
    moved = (points(obj.data) != surface.vertices).any(axis=1)
    assert session.is_current and moved[:100].any() and not moved[100:].any()
    settings.vertex_group = "None of these"
    settle(session)
    assert session.is_on and not session.is_current and "no vertex group" in session.message
    assert same(points(obj.data), surface.vertices)
    settings.lambda_ = 0.9
    settle(session)
    assert same(points(obj.data), surface.vertices) and "no vertex group" in session.message
    settings.vertex_group = ""
    settle(session)
    assert same(points(obj.data), expected_for(surface, settings)) and session.message == ""
    current_preview.end_preview()
    assert same(points(obj.data), surface.vertices)


def test_unexpected_errors_are_shown(settings, monkeypatch, capfd):
    monkey()

    def compute(*_, **__):
        raise KeyError("gone")

    monkeypatch.setattr(preview_session, "compute", compute)
    session = turn_on()
    settle(session)
    assert session.message == "An unexpected error: KeyError('gone')."
    assert "Traceback" in capfd.readouterr().err


def test_what_can_have_no_preview(settings, monkeypatch):
    obj = monkey()
    monkeypatch.setattr(preview_session, "MOST_VERTICES", 500)
    with pytest.raises(RuntimeError, match="has 507 vertices, too many for a preview, which goes up to 500"):
        bpy.ops.object.framelet_preview()
    monkeypatch.undo()
    obj.shape_key_add(name="Basis")
    with pytest.raises(RuntimeError, match="has shape keys, of which there is no preview"):
        bpy.ops.object.framelet_preview()
    assert_clean(obj.data)
    bpy.ops.object.mode_set(mode="EDIT")
    with pytest.raises(RuntimeError, match="Switch to Object Mode"):
        bpy.ops.object.framelet_preview()
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.ops.object.light_add()
    with pytest.raises(RuntimeError, match="Make a mesh object active"):
        bpy.ops.object.framelet_preview()


def test_unregistering_ends_it(settings):
    import framelet

    obj = monkey()
    before = points(obj.data)
    settle(turn_on())
    framelet.unregister()
    try:
        assert same(points(obj.data), before)
        assert_clean(obj.data)
    finally:
        framelet.register()
