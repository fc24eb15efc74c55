# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Each object remembers its settings; a new one starts from what was set last."""

import bpy
import pytest
from blender_objects import noisy_monkey
from drawing import draw
from framelet.operators import own_soon
from framelet.operators.mesh_io.mesh_bridge import read_positions
from framelet.operators.preview import current_preview
from framelet.operators.properties import setting_values
from framelet.operators.properties.own_settings import (
    NAMES,
    has_own,
    remember_settings,
    settings_of,
    shown_settings,
)
from framelet.operators.properties.setting_values import to_settings
from framelet.ui.panels import panel
from run_steps import expected_for, same, settle, turn_on


@pytest.fixture
def pair(empty_scene):
    """Two noisy meshes; the second one is active."""
    return noisy_monkey("First"), noisy_monkey("Second")


def activate(obj):
    bpy.ops.object.select_all(action="DESELECT")
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj


def shown(name):
    return getattr(shown_settings(bpy.context), name)


def test_all_settings_but_the_mark_are_remembered():
    properties = bpy.context.scene.framelet.bl_rna.properties.keys()
    assert set(properties) - {"name", "rna_type", "is_own"} == set(NAMES)


def test_the_panel_shows_the_settings_of_the_active_object(pair):
    for obj, strength, output, group in zip(
        pair, (1.5, 0.5), ("IN_PLACE", "SHAPE_KEY"), ("One", "Two"), strict=True
    ):
        activate(obj)
        settings = shown_settings(bpy.context)
        settings.strength, settings.output, settings.vertex_group = strength, output, group
    for obj, strength, output, group in zip(
        pair, (1.5, 0.5), ("IN_PLACE", "SHAPE_KEY"), ("One", "Two"), strict=True
    ):
        activate(obj)
        assert (shown("strength"), shown("output"), shown("vertex_group")) == (strength, output, group)
        button = draw(panel.VIEW3D_PT_framelet)["object.framelet_denoise"]
        assert (button.strength, button.output, button.vertex_group) == (strength, output, group)


def test_a_new_object_starts_from_what_was_set_last_but_without_the_group(pair):
    activate(pair[0])
    settings = shown_settings(bpy.context)
    settings.strength, settings.vertex_group, settings.preset = 1.5, "Face", "SCULPT"
    activate(pair[1])
    assert not has_own(pair[1])
    assert (shown("preset"), shown("noise"), shown("vertex_group")) == ("SCULPT", "FINE", "")
    activate(pair[0])
    shown_settings(bpy.context).strength = 0.75
    assert settings_of(pair[1], bpy.context.scene).strength == 0.75
    assert settings_of(pair[0], bpy.context.scene).vertex_group == "Face"


def test_a_change_of_one_object_leaves_another_one(pair):
    for obj in pair:
        activate(obj)
        shown_settings(bpy.context).strength = 1.25
    shown_settings(bpy.context).preset = "TRI_2"
    assert (pair[0].framelet.preset, pair[0].framelet.method) == ("AUTO", "AUTO")
    assert to_settings(pair[1].framelet).method == "POSITIONS"


def test_settings_of_the_scene_are_those_of_the_active_object_for_scripts(pair):
    activate(pair[0])
    bpy.context.scene.framelet.strength = 0.5
    bpy.context.scene.framelet.vertex_group = "One"
    activate(pair[1])
    bpy.context.scene.framelet.strength = 2.0
    activate(pair[0])
    assert (shown("strength"), shown("vertex_group")) == (0.5, "One")
    bpy.context.scene.framelet.passes = 3  # changes nothing else
    assert (shown("strength"), shown("passes"), shown("vertex_group")) == (0.5, 3, "One")
    bpy.context.scene.framelet.preset = "TRI_1"
    assert shown("method") == "POSITIONS" and pair[1].framelet.method == "AUTO"


def test_they_are_in_files_and_in_copies(pair, tmp_path):
    shown_settings(bpy.context).strength = 1.75
    bpy.ops.object.duplicate()
    assert shown("strength") == 1.75
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "two.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "two.blend"))
    second = bpy.data.objects["Second"]
    assert has_own(second) and second.framelet.strength == 1.75
    assert not has_own(bpy.data.objects["First"])


def test_undo_takes_a_change_back(pair):
    bpy.context.preferences.edit.use_global_undo = True
    shown_settings(bpy.context).strength = 0.5
    bpy.ops.ed.undo_push(message="First")
    shown_settings(bpy.context).strength = 2.0
    bpy.ops.ed.undo_push(message="Second")
    bpy.ops.ed.undo()
    assert shown("strength") == 0.5 and bpy.context.scene.framelet.strength == 0.5


def test_an_engine_that_is_gone_is_replaced_in_objects_too(pair, tmp_path):
    shown_settings(bpy.context).preset = "TRI_2"
    settings = pair[1].framelet
    setting_values.write_quietly(settings, "preset", "AUTO")
    store = settings.bl_system_properties_get() if bpy.app.version >= (5, 0, 0) else settings
    store["method"] = 1  # Normals
    assert settings.method == ""
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "old.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "old.blend"))
    assert bpy.data.objects["Second"].framelet.method == "AUTO"


def test_drawing_leaves_no_trace_on_objects(pair):
    draw(panel.VIEW3D_PT_framelet)
    assert not pair[1].is_property_set("framelet") and not pair[1].keys()


def test_an_object_that_the_sidebar_shows_gets_its_own_once(pair):
    bpy.context.scene.framelet.property_unset("strength")
    own_soon._asked.update({"First", "Gone"})
    own_soon._begin()
    assert has_own(pair[0]) and not pair[0].framelet.is_property_set("strength")
    assert not has_own(pair[1]) and not own_soon._asked


def test_the_settings_of_a_run_are_remembered(pair, settings):
    """As all objects of a run from the sidebar do; tests/gui has the run."""
    settings.iterations, settings.vertex_group = 3, "Face"
    remember_settings(pair[0], settings_of(pair[1], bpy.context.scene))
    own = pair[0].framelet
    assert (own.preset, own.iterations, own.output) == ("POSITIONS", 3, "IN_PLACE")
    assert own.vertex_group == "Face" and not own.is_property_set("keep_sharp")


def test_a_run_of_a_script_leaves_no_settings(pair):
    bpy.ops.object.framelet_denoise(preset="TRI_2")
    assert not pair[1].is_property_set("framelet")


@pytest.mark.usefixtures("no_thread_stays")
def test_a_preview_follows_the_settings_of_its_object(pair, settings):
    from framelet.operators.mesh_io import mesh_bridge

    surface = mesh_bridge.read_surface(pair[1])
    session = turn_on()
    shown_settings(bpy.context).lambda_ = 0.5
    settle(session)
    assert same(read_positions(pair[1].data), expected_for(surface, pair[1].framelet))
    wanted = read_positions(pair[1].data)
    activate(pair[0])
    shown_settings(bpy.context).lambda_ = 0.1
    settle(session)
    assert same(read_positions(pair[1].data), wanted) and session.name == "Second"
    current_preview.end_preview()
