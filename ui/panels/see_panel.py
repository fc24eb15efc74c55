# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The subpanel Result: what the last run changed. It draws and never computes."""

from __future__ import annotations

import bpy
from bpy.app.translations import pgettext_n as n_

from ...operators.before_after import OBJECT_OT_framelet_before_after
from ...operators.colors.heat_settings import HEAT_NAMES, shown_heat_names
from ...operators.heat_map import OBJECT_OT_framelet_heat_map, OBJECT_OT_framelet_hide_colors
from ...operators.mesh_io import band_storage
from ...operators.properties.setting_values import copy_values, write_quietly
from ...operators.run.run_memory import known_side
from .layouts import FrameletPanel, settings_column

SIDES = (("BEFORE", n_("Before", "Operator")), ("AFTER", n_("After", "Operator")))
"""The two sides of a run, with words."""

BUTTONS = (
    (
        ("NORMAL", n_("Heat Map", "Operator"), "COLOR"),
        ("ANGLE", n_("Angle Change", "Operator"), "DRIVER_ROTATIONAL_DIFFERENCE"),
    ),
    (
        ("NOISE", n_("Noise Map", "Operator"), "RNDCURVE"),
        ("WIDTH", n_("Noise Width", "Operator"), "ARROW_LEFTRIGHT"),
    ),
)
"""Rows of quantities that have a button of their own, with words and icons."""


class VIEW3D_PT_framelet_see(FrameletPanel, bpy.types.Panel):
    """Look at what the last run changed."""

    bl_label = "Result"
    bl_parent_id = "VIEW3D_PT_framelet"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the buttons, pressed if what they show is shown, and the range of the colors."""
        layout, heat = self.layout, context.scene.framelet_heat_map
        row, side = layout.row(align=True), known_side(context.active_object)
        idname = OBJECT_OT_framelet_before_after.bl_idname
        for name, text in SIDES:
            operator = row.operator(idname, text=text, depress=name == side)
            write_quietly(operator, "side", name)
        shown = _shown_quantity(context)
        column = layout.column(align=True)
        for buttons in BUTTONS:
            row = column.row(align=True)
            for quantity, text, icon in buttons:
                if quantity == shown:
                    row.operator(OBJECT_OT_framelet_hide_colors.bl_idname, text=text, icon=icon, depress=True)
                    text, icon = "", "FILE_REFRESH"  # for another range
                operator = row.operator(OBJECT_OT_framelet_heat_map.bl_idname, text=text, icon=icon)
                write_quietly(operator, "quantity", quantity)
                copy_values(heat, operator, HEAT_NAMES)
        column = settings_column(layout)
        for name in shown_heat_names(heat, shown or heat.quantity):
            column.prop(heat, name)


def _shown_quantity(context: bpy.types.Context) -> str:
    """Return which heat map the active object shows; empty for none."""
    obj, shown = context.active_object, context.window_manager.framelet_band_range
    if obj is None or obj.type != "MESH" or obj.name not in shown.objects:
        return ""
    return shown.quantity if obj.data.attributes.active_color_name == band_storage.HEAT_COLORS else ""


classes = (VIEW3D_PT_framelet_see,)
