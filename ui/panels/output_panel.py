# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The subpanel Output: where the result goes."""

from __future__ import annotations

import bpy
from bpy.app.translations import pgettext_n as n_

from ...operators.modifier.recipes import DISPLACEMENT
from ...operators.properties.output_choices import MODIFIER, NEW_OBJECT, SHAPE_KEY
from ...operators.properties.own_settings import shown_settings
from .layouts import FrameletPanel, settings_column
from .modifier_rows import draw_modifier

_HINTS = {
    SHAPE_KEY: n_("Its value is the amount"),
    NEW_OBJECT: n_("The original stays as it is"),
    MODIFIER: n_("Amount and mask stay adjustable"),
}


class VIEW3D_PT_framelet_output(FrameletPanel, bpy.types.Panel):
    """Where the denoised surface goes."""

    bl_label = "Output"
    bl_parent_id = "VIEW3D_PT_framelet"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the choice and what it is good for, and the modifier of the active object, if it has one."""
        settings = shown_settings(context)
        column = settings_column(self.layout)
        column.prop(settings, "output")
        if context.mode == "SCULPT" and settings.output == MODIFIER:
            column.label(text="In Sculpt Mode: in place", icon="INFO")
        elif settings.output in _HINTS:
            column.label(text=_HINTS[settings.output], icon="INFO")
            if context.mode != "OBJECT" and settings.output != MODIFIER:
                column.label(text="Needs Object Mode", icon="ERROR")
        draw_modifier(self.layout, context.active_object, DISPLACEMENT)


classes = (VIEW3D_PT_framelet_output,)
