# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Everything is in Blender's menus, with the settings of the scene, and so its search finds it."""

import bpy
import pytest
from drawing import draw
from framelet.operators import registration
from framelet.ui import menus

OPERATORS = [
    each.bl_idname
    for each in registration.classes
    if issubclass(each, bpy.types.Operator) and "INTERNAL" not in each.bl_options
]


def test_every_operator_is_in_the_submenu():
    assert sorted(set(draw(menus.VIEW3D_MT_framelet)["operator"])) == sorted(OPERATORS)


def test_the_submenu_is_in_the_menus_that_the_search_walks_through():
    for name in ("VIEW3D_MT_object", "VIEW3D_MT_edit_mesh"):
        assert menus._draw_submenu in getattr(bpy.types, name)._dyn_ui_initialize()
    assert draw(menus._draw_submenu)["menu"] == ["VIEW3D_MT_framelet"]
    assert menus.VIEW3D_MT_framelet.is_registered


@pytest.mark.parametrize(
    "name",
    [
        "VIEW3D_MT_edit_mesh_clean",
        "VIEW3D_MT_edit_mesh_vertices",
        "VIEW3D_MT_object_context_menu",
        "VIEW3D_MT_edit_mesh_context_menu",
    ],
)
def test_denoise_is_where_people_look(name):
    assert menus._draw_denoise in getattr(bpy.types, name)._dyn_ui_initialize()
    assert draw(menus._draw_denoise)["operator"] == []
    bpy.ops.object.camera_add()
    assert draw(menus._draw_denoise)["operator"] == []
    bpy.ops.mesh.primitive_cube_add()
    assert draw(menus._draw_denoise)["operator"] == ["object.framelet_denoise"]


def test_entries_carry_the_scene_settings():
    scene = bpy.context.scene
    scene.framelet.preset = "TRI_1"
    scene.framelet.mu, scene.framelet.boundary = 4.0, "FREE"
    scene.framelet_bands.level, scene.framelet_bands.max_megabytes = 2, 7.0
    scene.framelet_equalizer.gain_2 = 1.5
    scene.framelet_heat_map.range_rule = "MAXIMUM"
    bpy.ops.mesh.primitive_cube_add()
    for record in (draw(menus.VIEW3D_MT_framelet), draw(menus._draw_denoise)):
        values = record["object.framelet_denoise"]
        assert (values.preset, values.mu, values.boundary) == ("TRI_1", 4.0, "FREE")
    record = draw(menus.VIEW3D_MT_framelet)
    assert record["object.framelet_analyze"].frame == "BOX_SPLINE_111"
    assert record["object.framelet_analyze"].max_megabytes == 7.0
    assert record["object.framelet_show_band"].level == 2
    assert record["object.framelet_equalize"].gain_2 == 1.5
    assert record["object.framelet_equalize"].boundary == "FREE"
    assert record["object.framelet_heat_map"].range_rule == "MAXIMUM"
