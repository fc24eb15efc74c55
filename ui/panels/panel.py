# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The tab Framelet in the sidebar of the 3D View: the button, and the settings that matter most.

It draws and never computes.
"""

from __future__ import annotations

import bpy
from bpy.app.translations import pgettext_n as n_

from ...operators.denoise import OBJECT_OT_framelet_denoise
from ...operators.mesh_io import mesh_facts
from ...operators.modifier.recipes import DISPLACEMENT
from ...operators.modifier.stack import find_modifier
from ...operators.properties.setting_values import copy_settings, has_effect, is_replaced, write_quietly
from ...operators.run.run_memory import known_side
from .layouts import FrameletPanel, draw_settings, draw_value, settings_column
from .modifier_rows import draw_amount
from .preset_panel import VIEW3D_PT_framelet_presets
from .run_rows import draw_preview, draw_progress

MAIN_NAMES = (
    "tuning",
    "frame",
    "levels",
    "lambda_",
    "mu",
    "sigma_c",
    "sigma_s",
)
ADVANCED_NAMES = (
    "stencil",
    "shrinkage",
    "delta",
    "iterations",
    "tolerance",
    "passes",
    "threads",
)
CHOSEN = ((n_("Smoothing λ"), "chosen_lambda"), (n_("Penalty μ"), "chosen_mu"))
"""What a run took from the noise of an object: labels, and properties of `FrameletNoise`."""

UNKNOWN = "–"


class VIEW3D_PT_framelet(FrameletPanel, bpy.types.Panel):
    """Choose how to clean, and denoise the selected meshes."""

    bl_label = "Framelet"

    def draw_header_preset(self, _context: bpy.types.Context) -> None:
        """Draw the button with the list of presets."""
        VIEW3D_PT_framelet_presets.draw_panel_header(self.layout)

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the button, preset and engine, strength, noise, amount, and the settings that matter most."""
        layout = self.layout
        settings = context.scene.framelet
        _draw_buttons(layout, context)
        draw_progress(layout)
        draw_preview(layout)
        column = settings_column(layout)
        for name in ("preset", "method", "strength", "noise"):
            if has_effect(settings.method, name):
                column.prop(settings, name)
        draw_amount(column, settings, context.active_object)
        layout.separator()
        draw_settings(layout, settings, MAIN_NAMES, context.active_object)
        if is_replaced(settings.method, settings.tuning, "lambda_"):
            _draw_chosen(layout, context)


class VIEW3D_PT_framelet_advanced(FrameletPanel, bpy.types.Panel):
    """The settings that are rarely changed."""

    bl_label = "Advanced"
    bl_parent_id = "VIEW3D_PT_framelet"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the other settings of the engine."""
        settings = context.scene.framelet
        draw_settings(self.layout, settings, ADVANCED_NAMES)
        facts = mesh_facts.known_facts(context.active_object)
        if facts and has_effect(settings.method, "frame"):
            for line in mesh_facts.unfit_frames(facts):
                self.layout.label(text=line, icon="INFO")


def _draw_buttons(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw the button that denoises, from the original where the mesh is a result, and one that goes on."""
    settings, obj = context.scene.framelet, context.active_object
    row = layout.row(align=True)
    row.scale_y = 1.8
    is_again = known_side(obj) == "AFTER"
    text = n_("Denoise Again", "Operator") if is_again else n_("Denoise", "Operator")
    copy_settings(settings, row.operator(OBJECT_OT_framelet_denoise.bl_idname, text=text, icon="MOD_SMOOTH"))
    if is_again and find_modifier(obj, DISPLACEMENT) is None:
        operator = row.operator(OBJECT_OT_framelet_denoise.bl_idname, text="", icon="FORWARD")
        copy_settings(settings, operator)
        write_quietly(operator, "from_original", False)


def _draw_chosen(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw, grayed, what the last run took from the noise of the active object."""
    obj = context.active_object
    entry = obj and context.window_manager.framelet_estimate.objects.get(obj.name)
    column = layout.column(align=True)
    column.active = False
    for label, name in CHOSEN:
        draw_value(column, label, (getattr(entry, name) if entry else "") or UNKNOWN)
