# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels show every setting once and draw without errors."""

import re

import bpy
import pytest
from framelet.core.settings import PRESETS
from framelet.operators import setting_values
from framelet.ui import menus, panel


class Layout:
    """Records what a panel draws, checking that properties and operators exist."""

    def __init__(self, record=None):
        self.record = {"prop": [], "label": [], "operator": []} if record is None else record

    def row(self, **_options):
        return Layout(self.record)

    column = split = row

    def separator(self):
        pass

    def prop(self, data, name, **_options):
        assert name in data.bl_rna.properties
        self.record["prop"].append(name)

    def label(self, text=""):
        self.record["label"].append(text)

    def operator(self, idname, **_options):
        group, name = idname.split(".")
        assert getattr(bpy.types, f"{group.upper()}_OT_{name}").bl_rna
        self.record["operator"].append(idname)
        values = type("Values", (), {"preset": None})()
        self.record["values"] = values
        return values


def draw(panel_class):
    """Call a panel's draw with a recording layout."""
    layout = Layout()
    panel_class.draw(type("Panel", (), {"layout": layout})(), bpy.context)
    return layout.record


def test_panels_are_registered_in_one_tab():
    for each in panel.classes:
        assert each.is_registered
        assert (each.bl_category, each.bl_region_type, each.bl_space_type) == ("Framelet", "UI", "VIEW_3D")
        assert each.bl_label
    parents = [each for each in panel.classes if not hasattr(each, "bl_parent_id")]
    assert parents == [panel.VIEW3D_PT_framelet]


@pytest.mark.parametrize("preset", list(PRESETS))
def test_every_setting_of_a_method_is_shown_once(preset):
    bpy.context.scene.framelet.preset = preset
    method = PRESETS[preset].settings.method
    shown = draw(panel.VIEW3D_PT_framelet)["prop"] + draw(panel.VIEW3D_PT_framelet_advanced)["prop"]
    expected = [name for name in setting_values.PROPERTY_NAMES if setting_values.has_effect(method, name)]
    assert sorted(shown) == sorted(expected)


def test_the_button_carries_the_scene_settings():
    scene_settings = bpy.context.scene.framelet
    scene_settings.preset = "TRI_1"
    scene_settings.mu = 4.0
    record = draw(panel.VIEW3D_PT_framelet)
    assert record["operator"] == ["object.framelet_denoise"]
    assert (record["values"].preset, record["values"].mu) == ("TRI_1", 4.0)


def test_menu_entries_carry_the_scene_settings():
    bpy.context.scene.framelet.preset = "BILATERAL"
    record = draw(type("Menu", (), {"draw": menus._draw_denoise}))
    assert record["values"].preset == "BILATERAL"
    for name in menus.MENU_NAMES:
        drawers = getattr(bpy.types, name)._dyn_ui_initialize()
        assert menus._draw_denoise in drawers


def test_last_run_before_and_after():
    assert draw(panel.VIEW3D_PT_framelet_last_run)["label"] == ["Nothing was denoised yet"]
    bpy.ops.mesh.primitive_monkey_add()
    bpy.ops.object.framelet_denoise()
    labels = draw(panel.VIEW3D_PT_framelet_last_run)["label"]
    assert "Suzanne" in labels and "Open mesh" in labels
    assert re.fullmatch(r"[\d.]+ cm", labels[labels.index("RMS") + 1])
    assert re.fullmatch(r"\d+\.\d{3} edge lengths", labels[labels.index("RMS") + 3])


def test_lengths_follow_the_units_of_the_scene():
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3)
    bpy.ops.object.framelet_denoise()

    def rms():
        labels = draw(panel.VIEW3D_PT_framelet_last_run)["label"]
        return labels[labels.index("RMS") + 1]

    units = bpy.context.scene.unit_settings
    metric = rms()
    units.system = "NONE"
    assert re.fullmatch(r"[\d.e-]+", rms())
    units.system = "METRIC"
    units.scale_length = 1000.0
    assert rms() != metric


def test_volume_of_closed_meshes_and_number_of_objects():
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3)
    first = bpy.context.object
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=2)
    first.select_set(True)
    bpy.ops.object.framelet_denoise()
    labels = draw(panel.VIEW3D_PT_framelet_last_run)["label"]
    assert labels[labels.index("Objects") + 1] == "2"
    assert re.fullmatch(r"-\d+\.\d{2} %", labels[labels.index("Volume") + 1])


def test_try_it_before_and_after():
    record = draw(panel.VIEW3D_PT_framelet_try_it)
    assert record["operator"] == ["object.framelet_add_noise", "object.framelet_compare"]
    assert record["label"] == []
    bpy.ops.mesh.primitive_monkey_add()
    first = bpy.context.object
    bpy.ops.mesh.primitive_monkey_add()
    bpy.ops.object.framelet_add_noise()
    first.select_set(True)
    bpy.ops.object.framelet_compare()
    labels = draw(panel.VIEW3D_PT_framelet_try_it)["label"]
    assert {"Suzanne", "Suzanne.001", "Mean Angle"} <= set(labels)
