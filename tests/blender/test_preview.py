# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The live preview shows what Denoise would give, and applies it."""

import threading

import bpy
import numpy as np
import pytest
from blender_objects import noisy_monkey
from framelet.operators.mesh_io import mesh_bridge
from framelet.operators.mesh_io.mesh_bridge import read_positions
from framelet.operators.preview import current_preview, outcomes
from meshes import noisy, triangle_grid
from run_steps import assert_clean, expected_for, same, settle, turn_on

pytestmark = pytest.mark.usefixtures("no_thread_stays")


def test_it_shows_what_denoise_gives_and_off_restores_the_bits(settings):
    obj = noisy_monkey()
    obj.data.vertices[7].co.x = -0.0
    surface = mesh_bridge.read_surface(obj)
    session = turn_on()
    shown = []
    for lambda_ in (0.1, 0.5, 2.0, 0.0):
        settings.lambda_ = lambda_
        settle(session)
        assert session.is_current and session.message == ""
        assert same(read_positions(obj.data), expected_for(surface, settings))
        shown.append(read_positions(obj.data).tobytes())
    assert len(set(shown)) == 4
    assert bpy.ops.object.framelet_preview() == {"FINISHED"}
    assert current_preview.current_preview() is None
    assert same(read_positions(obj.data), surface.vertices)
    assert_clean(obj.data)


@pytest.mark.parametrize("preset", ["AUTO", "TRI_2", "FREE_FORM", "BILATERAL"])
def test_all_methods(preset, settings):
    obj = noisy_monkey()
    surface = mesh_bridge.read_surface(obj)
    settings.preset = preset
    session = turn_on()
    settle(session)
    assert same(read_positions(obj.data), expected_for(surface, settings))
    if preset == "AUTO":
        settings.strength = 0.4
        settle(session)
        assert same(read_positions(obj.data), expected_for(surface, settings))


@pytest.mark.parametrize(("preset", "name"), [("POSITIONS", "lambda_"), ("AUTO", "strength")])
def test_a_mesh_is_prepared_once(settings, monkeypatch, preset, name):
    from framelet.core import preparation_cache

    made, original = [], preparation_cache.prepare_again

    def prepare_again(surface, settings, previous, **more):
        found = original(surface, settings, previous, **more)
        made.append(found is previous)
        return found

    monkeypatch.setattr(preparation_cache, "prepare_again", prepare_again)
    noisy_monkey()
    session = turn_on()
    settings.preset = preset
    settle(session)
    assert False in made
    made.clear()
    for value in (0.3, 0.2, 0.1):
        setattr(settings, name, value)
        settle(session)
        assert session.is_current
    assert len(made) >= 3 and all(made)


def test_the_last_result_is_shown_until_the_next_is_there(settings, monkeypatch):
    """Nothing in between, and nothing that was not computed."""
    go, original = threading.Event(), outcomes.compute
    go.set()

    def gated(job, callback=None, should_stop=None):
        while not go.wait(0.005):
            if should_stop():
                break
        return original(job, callback, should_stop)

    monkeypatch.setattr(outcomes, "compute", gated)
    settings.preset = "AUTO"
    obj = noisy_monkey()
    surface = mesh_bridge.read_surface(obj)
    session = turn_on()
    settle(session)
    first = read_positions(obj.data)
    go.clear()
    settings.noise = "WIDE"
    current_preview.tick_preview()
    assert same(read_positions(obj.data), first)
    assert not session.is_current and not bpy.ops.object.framelet_apply_preview.poll()
    go.set()
    settle(session)
    assert session.is_current and same(read_positions(obj.data), expected_for(surface, settings))


def test_apply_keeps_it_and_reports_it(settings):
    obj = noisy_monkey()
    surface = mesh_bridge.read_surface(obj)
    session = turn_on()
    assert not session.is_current and not bpy.ops.object.framelet_apply_preview.poll()
    with pytest.raises(ValueError, match="does not show these settings yet"):
        session.apply()
    settle(session)
    assert bpy.ops.object.framelet_apply_preview() == {"FINISHED"}
    assert current_preview.current_preview() is None
    assert same(read_positions(obj.data), expected_for(surface, settings))
    assert_clean(obj.data)
    assert bpy.context.window_manager.framelet_report.names == "Monkey"


@pytest.mark.parametrize("output", ["SHAPE_KEY", "NEW_OBJECT"])
def test_apply_goes_where_output_says(output, settings):
    obj = noisy_monkey()
    surface = mesh_bridge.read_surface(obj)
    settings.output = output
    settle(turn_on())
    bpy.ops.object.framelet_apply_preview()
    assert same(read_positions(obj.data), surface.vertices)
    assert_clean(obj.data)
    expected = expected_for(surface, settings)
    if output == "SHAPE_KEY":
        assert same(mesh_bridge.read_surface(obj).vertices, expected)
    else:
        new = bpy.data.objects["Monkey.denoised"]
        assert same(read_positions(new.data), expected)
        assert_clean(new.data)


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_a_mesh_without_a_place_goes_back(settings, value):
    """The end of the preview looked for a linear map between positions that are no numbers."""
    obj = noisy_monkey()
    obj.data.vertices[7].co.x = value
    before = read_positions(obj.data)
    settle(turn_on())
    assert bpy.ops.object.framelet_preview() == {"FINISHED"}
    assert current_preview.current_preview() is None
    assert same(read_positions(obj.data), before)
    assert_clean(obj.data)


def test_wrong_settings_show_the_original_and_a_sentence(settings):
    surface_of = triangle_grid(9, 9)
    mesh = bpy.data.meshes.new("Grid")
    faces = surface_of.corner_vertex.reshape(-1, 3).tolist()
    mesh.from_pydata(noisy(surface_of, np.random.default_rng(1)).vertices.tolist(), [], faces)
    obj = bpy.data.objects.new("Grid", mesh)
    bpy.context.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    before = read_positions(mesh)
    session = turn_on()
    settle(session)
    assert not same(read_positions(mesh), before)
    settings.frame = "LINEAR_SPLINE"
    settle(session)
    assert session.is_on and not session.is_current
    assert session.message.startswith("‘Grid’: ") and "quads" in session.message
    assert same(read_positions(mesh), before)
    settings.frame = "AUTO"
    settle(session)
    assert session.message == "" and not same(read_positions(mesh), before)


def test_regions_are_followed(settings):
    obj = noisy_monkey()
    surface = mesh_bridge.read_surface(obj)
    group = obj.vertex_groups.new(name="Part")
    group.add(list(range(100)), 1.0, "REPLACE")
    session = turn_on()
    settle(session)
    assert (read_positions(obj.data) != surface.vertices)[100:].any()
    settings.vertex_group = "Part"
    settle(session)
    moved = (read_positions(obj.data) != surface.vertices).any(axis=1)
    assert session.is_current and moved[:100].any() and not moved[100:].any()
    settings.vertex_group = "None of these"
    settle(session)
    assert session.is_on and not session.is_current and "no vertex group" in session.message
    assert same(read_positions(obj.data), surface.vertices)
    settings.lambda_ = 0.9
    settle(session)
    assert same(read_positions(obj.data), surface.vertices) and "no vertex group" in session.message
    settings.vertex_group = ""
    settle(session)
    assert same(read_positions(obj.data), expected_for(surface, settings)) and session.message == ""
    current_preview.end_preview()
    assert same(read_positions(obj.data), surface.vertices)


def test_unexpected_errors_are_shown(settings, monkeypatch, capfd):
    noisy_monkey()

    def compute(*_, **__):
        raise KeyError("gone")

    monkeypatch.setattr(outcomes, "compute", compute)
    session = turn_on()
    settle(session)
    assert session.message == "An unexpected error: KeyError('gone')."
    assert "Traceback" in capfd.readouterr().err


def test_what_can_have_no_preview(settings, monkeypatch):
    obj = noisy_monkey()
    monkeypatch.setattr(current_preview, "MOST_VERTICES", 500)
    with pytest.raises(RuntimeError, match="has too many vertices for a preview; press Denoise"):
        bpy.ops.object.framelet_preview()
    with pytest.raises(ValueError, match="has 507 vertices, too many for a preview, which goes up to 500"):
        current_preview.start_preview(obj, bpy.context.scene)
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
