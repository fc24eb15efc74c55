# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Make 3D Views show vertex colors, and what they showed before."""

import bpy

from ..mesh_io import band_storage


def show_vertex_colors(context: bpy.types.Context) -> None:
    """Make the 3D View show vertex colors; if the mouse is elsewhere, all 3D Views of the screen."""
    shown = context.window_manager.framelet_band_range
    for space in _views(context):
        shading = space.shading
        if (shading.type, shading.color_type) != ("SOLID", "VERTEX"):
            shown.shading_type, shown.color_type = shading.type, shading.color_type
            shading.type, shading.color_type = "SOLID", "VERTEX"


def hide_vertex_colors(context: bpy.types.Context) -> None:
    """Make the same 3D Views show what they showed before `show_vertex_colors` changed one."""
    shown = context.window_manager.framelet_band_range
    if not shown.color_type:
        return
    for space in _views(context):
        if (space.shading.type, space.shading.color_type) == ("SOLID", "VERTEX"):
            space.shading.color_type = shown.color_type
            space.shading.type = shown.shading_type
    shown.shading_type = shown.color_type = ""


def hide_unused_colors(context: bpy.types.Context) -> None:
    """Make 3D Views show what they showed before, once no mesh of the scene has colors of Framelet."""
    meshes = [obj.data for obj in context.scene.objects if obj.type == "MESH"]
    if not any(band_storage.has_colors(mesh) for mesh in meshes):
        context.window_manager.framelet_band_range.objects.clear()
        hide_vertex_colors(context)


def follow_undo(context: bpy.types.Context) -> None:
    """Make 3D Views show vertex colors if undo or redo brought them back, else what they showed before.

    Blender undoes the colors of a mesh, and not what its views show.
    """
    shown = context.window_manager.framelet_band_range
    objects = filter(None, (context.scene.objects.get(each.name) for each in shown.objects))
    if any(obj.type == "MESH" and band_storage.has_colors(obj.data) for obj in objects):
        if not shown.color_type:
            show_vertex_colors(context)
    else:
        hide_vertex_colors(context)


def _views(context: bpy.types.Context) -> list[bpy.types.SpaceView3D]:
    """Return the 3D View that an operator was called from, or else all of the screen."""
    space = context.space_data
    if space is not None and space.type == "VIEW_3D":
        return [space]
    areas = context.screen.areas if context.screen else []
    return [area.spaces.active for area in areas if area.type == "VIEW_3D"]
