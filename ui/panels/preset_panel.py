# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The list of the user's presets behind the button in the header of the tab; Preset lists those built in."""

from __future__ import annotations

import bpy
from bl_ui.utils import PresetPanel

from ...operators.properties.presets import PRESET_FOLDER, OBJECT_OT_framelet_preset_add
from ...operators.properties.setting_values import write_quietly


class VIEW3D_PT_framelet_presets(PresetPanel, bpy.types.Panel):
    """The presets of the user."""

    bl_label = "Framelet Presets"
    bl_space_type = "VIEW_3D"
    bl_region_type = "HEADER"
    preset_subdir = PRESET_FOLDER
    preset_operator = "script.execute_preset"
    preset_add_operator = OBJECT_OT_framelet_preset_add.bl_idname

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the list of the user's presets."""
        if bpy.utils.preset_paths(PRESET_FOLDER):
            super().draw(context)
        else:
            draw_add(self.layout, context)


def draw_add(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw the row that saves a preset, for when there is no folder yet; Blender would miss the paths."""
    row = layout.row(align=True)
    row.prop(context.window_manager, "preset_name", text="")
    operator = row.operator(OBJECT_OT_framelet_preset_add.bl_idname, text="", icon="ADD")
    write_quietly(operator, "name", context.window_manager.preset_name)


classes = (VIEW3D_PT_framelet_presets,)
