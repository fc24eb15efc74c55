# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Presets of the user's own: saved, used, removed, and beside those that come with Framelet."""

import os

import bpy
import pytest
from drawing import draw
from framelet.core.settings import PRESETS
from framelet.operators.properties import presets, setting_values
from framelet.ui.panels import panel, preset_panel

MESHES = ["AUTO", "FREE_FORM", "PRISMATIC", "MARCHING_CUBES", "SCULPT"]
"""Presets by what the mesh is."""


@pytest.fixture
def preset_folder(tmp_path, monkeypatch):
    """Let Blender keep the user's scripts in a folder of the test."""
    scripts = tmp_path / "scripts"
    original = bpy.utils.user_resource

    def user_resource(kind, path="", create=False):
        if kind != "SCRIPTS":
            return original(kind, path=path, create=create)
        folder = scripts / path
        if create:
            folder.mkdir(parents=True, exist_ok=True)
        return str(folder)

    monkeypatch.setattr(bpy.utils, "user_resource", user_resource)
    monkeypatch.setattr(
        bpy.utils,
        "preset_paths",
        lambda subdir: [str(path)] if (path := scripts / "presets" / subdir).is_dir() else [],
    )
    # Blender writes the name of the last preset over the label.
    monkeypatch.setattr(preset_panel.VIEW3D_PT_framelet_presets, "bl_label", "Framelet Presets")
    return scripts / "presets" / "framelet"


def scene_settings():
    return bpy.context.scene.framelet


def save(name):
    assert bpy.ops.object.framelet_preset_add(name=name) == {"FINISHED"}


def use(path):
    menu = "VIEW3D_PT_framelet_presets"
    assert bpy.ops.script.execute_preset(filepath=str(path), menu_idname=menu) == {"FINISHED"}


def values():
    return {name: getattr(scene_settings(), name) for name in presets.SAVED_NAMES}


@pytest.mark.parametrize("preset", [*PRESETS, setting_values.CUSTOM])
def test_a_saved_preset_brings_everything_back(preset_folder, preset):
    settings = scene_settings()
    settings.preset = preset
    settings.lambda_, settings.strength, settings.noise, settings.boundary = 0.77, 0.6, "FINE", "FREE"
    if preset == setting_values.CUSTOM:
        settings.method, settings.stencil, settings.levels = "POSITIONS", "MEAN", 3
    saved = values()
    save("My Statues")
    assert [path.name for path in preset_folder.iterdir()] == ["My_Statues.py"]
    settings.preset = "QUAD_1"
    settings.threads = 3
    use(preset_folder / "My_Statues.py")
    assert values() == saved
    assert settings.preset == preset and settings.threads == 3


def test_a_preset_can_be_removed(preset_folder):
    save("One")
    save("Two")
    assert bpy.ops.object.framelet_preset_add(name="One", remove_name=True) == {"FINISHED"}
    assert os.listdir(preset_folder) == ["Two.py"]


def test_a_name_that_exists_is_not_overwritten(preset_folder, capfd):
    save("One")
    text = (preset_folder / "One.py").read_text()
    scene_settings().preset = "TRI_1"
    bpy.ops.object.framelet_preset_add(name="One")
    assert (preset_folder / "One.py").read_text() == text


def test_all_settings_but_the_threads_are_saved():
    assert set(presets.SAVED_NAMES) == set(setting_values.PROPERTY_NAMES) - {"threads"}
    assert presets.SAVED_NAMES[0] == "preset"
    for name in presets.SAVED_NAMES:
        assert name in scene_settings().bl_rna.properties


def test_there_is_one_list_of_built_in_presets_with_the_paper_under_research():
    items = bpy.context.scene.framelet.bl_rna.properties["preset"].enum_items_static_ui
    listed = [(item.identifier, item.name) for item in items]
    research = listed.index(("", "Research"))
    assert [identifier for identifier, _ in listed if identifier] == [*PRESETS, "CUSTOM"]
    assert [identifier for identifier, _ in listed[:research]] == MESHES
    popover = bpy.types.VIEW3D_PT_framelet_presets
    assert not hasattr(preset_panel, "draw_built_in") and popover.preset_subdir == "framelet"


def test_the_first_preset_can_be_saved():
    record = draw(lambda drawn, context: preset_panel.draw_add(drawn.layout, context))
    assert record["prop"] == ["preset_name"]
    manager = bpy.context.window_manager
    assert record["object.framelet_preset_add"].name == manager.preset_name != ""


def test_the_buttons_of_the_list_lead_to_its_operators():
    menu = bpy.types.VIEW3D_PT_framelet_presets
    assert menu.preset_add_operator == "object.framelet_preset_add"
    assert menu.preset_subdir == presets.OBJECT_OT_framelet_preset_add.preset_subdir == "framelet"
    assert presets.OBJECT_OT_framelet_preset_add.preset_menu == menu.__name__
    shown = []
    header = type("Layout", (), {"popover": lambda self, **options: shown.append(options)})()
    header.emboss = ""
    panel.VIEW3D_PT_framelet.draw_header_preset(type("Drawn", (), {"layout": header})(), bpy.context)
    assert [each["panel"] for each in shown] == [menu.__name__]


def test_the_operator_has_presets_of_its_own():
    assert "PRESET" in bpy.types.OBJECT_OT_framelet_denoise.bl_options
