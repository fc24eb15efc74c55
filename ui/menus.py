# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Entries in Blender's own menus, which use the settings that the sidebar shows.

Blender's search (F3) finds what stands in menus. So every operator stands in the submenu Framelet.
"""

from __future__ import annotations

from itertools import chain

import bpy

from ..operators.add_noise import OBJECT_OT_framelet_add_noise
from ..operators.analyze import OBJECT_OT_framelet_analyze, OBJECT_OT_framelet_clear
from ..operators.before_after import OBJECT_OT_framelet_before_after
from ..operators.colors.heat_settings import HEAT_NAMES
from ..operators.compare import OBJECT_OT_framelet_compare
from ..operators.denoise import OBJECT_OT_framelet_denoise
from ..operators.edit_modifier import (
    OBJECT_OT_framelet_apply_modifier,
    OBJECT_OT_framelet_remove_modifier,
    OBJECT_OT_framelet_sculpt_mask,
)
from ..operators.equalize import OBJECT_OT_framelet_equalize, OBJECT_OT_framelet_live_equalizer
from ..operators.estimate_noise import OBJECT_OT_framelet_estimate_noise
from ..operators.heat_map import OBJECT_OT_framelet_heat_map, OBJECT_OT_framelet_hide_colors
from ..operators.outliers import classes as outlier_operators
from ..operators.properties.band_settings import EQUALIZER_NAMES, SHOW_NAMES
from ..operators.properties.own_settings import shown_settings
from ..operators.properties.setting_values import (
    copy_frame_settings,
    copy_settings,
    copy_values,
    write_quietly,
)
from ..operators.show_band import OBJECT_OT_framelet_show_band
from ..operators.synthesize import OBJECT_OT_framelet_synthesize
from .panels.see_panel import BUTTONS


class VIEW3D_MT_framelet(bpy.types.Menu):
    """All that Framelet can do with the selected meshes."""

    bl_label = "Framelet"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw an entry for each operator."""
        layout, scene = self.layout, context.scene
        operator = layout.operator(OBJECT_OT_framelet_denoise.bl_idname, icon="MOD_SMOOTH")
        copy_settings(shown_settings(context), operator)
        layout.operator(OBJECT_OT_framelet_before_after.bl_idname)
        layout.operator(OBJECT_OT_framelet_apply_modifier.bl_idname)
        layout.operator(OBJECT_OT_framelet_remove_modifier.bl_idname)
        layout.operator(OBJECT_OT_framelet_sculpt_mask.bl_idname)
        layout.separator()
        for quantity, text, _ in chain.from_iterable(BUTTONS):
            operator = layout.operator(OBJECT_OT_framelet_heat_map.bl_idname, text=text)
            write_quietly(operator, "quantity", quantity)
            copy_values(scene.framelet_heat_map, operator, HEAT_NAMES)
        layout.operator(OBJECT_OT_framelet_hide_colors.bl_idname)
        layout.separator()
        for each in (OBJECT_OT_framelet_equalize, OBJECT_OT_framelet_live_equalizer):
            operator = layout.operator(each.bl_idname)
            copy_frame_settings(shown_settings(context), operator, ("frame", "stencil", "boundary"))
            copy_values(scene.framelet_equalizer, operator, EQUALIZER_NAMES)
        operator = layout.operator(OBJECT_OT_framelet_analyze.bl_idname)
        copy_frame_settings(shown_settings(context), operator)
        copy_values(scene.framelet_bands, operator, ("max_megabytes",))
        operator = layout.operator(OBJECT_OT_framelet_show_band.bl_idname)
        copy_values(scene.framelet_bands, operator, SHOW_NAMES)
        layout.operator(OBJECT_OT_framelet_synthesize.bl_idname)
        layout.operator(OBJECT_OT_framelet_clear.bl_idname)
        layout.separator()
        for each in outlier_operators:
            layout.operator(each.bl_idname)
        layout.separator()
        layout.operator(OBJECT_OT_framelet_estimate_noise.bl_idname)
        layout.operator(OBJECT_OT_framelet_add_noise.bl_idname)
        layout.operator(OBJECT_OT_framelet_compare.bl_idname)


def _draw_denoise(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    """Draw one entry at the end of a menu, while there is a mesh that it could be for."""
    obj = context.active_object
    if obj is None or obj.type != "MESH":
        return
    self.layout.separator()
    operator = self.layout.operator(
        OBJECT_OT_framelet_denoise.bl_idname, text="Denoise (Framelet)", icon="MOD_SMOOTH"
    )
    copy_settings(shown_settings(context), operator)


def _draw_submenu(self: bpy.types.Menu, _context: bpy.types.Context) -> None:
    """Draw the submenu at the end of a menu."""
    self.layout.separator()
    self.layout.menu(VIEW3D_MT_framelet.__name__)


ENTRIES = (
    ("VIEW3D_MT_object", _draw_submenu),
    ("VIEW3D_MT_edit_mesh", _draw_submenu),
    ("VIEW3D_MT_edit_mesh_clean", _draw_denoise),
    ("VIEW3D_MT_edit_mesh_vertices", _draw_denoise),
    ("VIEW3D_MT_object_context_menu", _draw_denoise),
    ("VIEW3D_MT_edit_mesh_context_menu", _draw_denoise),
)
"""Menus of Blender, and what is drawn at their ends."""

classes = (VIEW3D_MT_framelet,)


def register() -> None:
    """Add the entries."""
    for name, draw in ENTRIES:
        getattr(bpy.types, name).append(draw)


def unregister() -> None:
    """Take the entries away."""
    for name, draw in reversed(ENTRIES):
        getattr(bpy.types, name).remove(draw)
