# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The tab Framelet in the sidebar of the 3D View: the button, and the settings that matter most.

It draws and never computes.
"""

from __future__ import annotations

import bpy
from bpy.app.translations import pgettext_iface as iface_
from bpy.app.translations import pgettext_n as n_

from ...core.settings import replaced_by
from ...operators.denoise import OBJECT_OT_framelet_denoise
from ...operators.mesh_io import mesh_facts
from ...operators.own_soon import begin_soon
from ...operators.properties.own_settings import shown_settings
from ...operators.properties.scene_units import range_text
from ...operators.properties.setting_values import copy_settings, has_effect, write_quietly
from ...operators.run.run_memory import shows_result
from .layouts import FrameletPanel, draw_settings, draw_value, settings_column
from .modifier_rows import draw_amount
from .preset_panel import VIEW3D_PT_framelet_presets
from .run_rows import draw_message, draw_run

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

N_SCALES = 4
"""Scales of the net; `core.learned`, which needs NumPy, is not loaded to draw."""


class VIEW3D_PT_framelet(FrameletPanel, bpy.types.Panel):
    """Choose how to clean, and denoise the selected meshes."""

    bl_label = "Framelet"

    def draw_header_preset(self, _context: bpy.types.Context) -> None:
        """Draw the button with the list of presets."""
        VIEW3D_PT_framelet_presets.draw_panel_header(self.layout)

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the button, preset and engine, strength, noise, amount, and the settings that matter most."""
        layout = self.layout
        settings = shown_settings(context)
        begin_soon(context.active_object)
        _draw_buttons(layout, context)
        draw_run(layout)
        column = settings_column(layout)
        for name in ("preset", "method", "strength", "noise"):
            if has_effect(settings.method, name):
                column.prop(settings, name, slider=name == "strength")
        draw_amount(column, settings, context.active_object)
        if settings.method == "AUTO":
            _draw_learned(layout, context)
        else:
            layout.separator()
            draw_settings(layout, settings, MAIN_NAMES, context.active_object)
            if replaced_by(settings, "lambda_"):
                _draw_chosen(layout, context)
        draw_message(layout, context)


class VIEW3D_PT_framelet_advanced(FrameletPanel, bpy.types.Panel):
    """The settings that are rarely changed."""

    bl_label = "Advanced"
    bl_parent_id = "VIEW3D_PT_framelet"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the other settings of the engine."""
        settings = shown_settings(context)
        draw_settings(self.layout, settings, ADVANCED_NAMES)
        facts = mesh_facts.known_facts(context.active_object)
        if facts and has_effect(settings.method, "frame"):
            for line in mesh_facts.unfit_frames(facts):
                self.layout.label(text=line, icon="INFO")


def _draw_buttons(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw the button that denoises, from the original where the mesh is a result, and one that goes on."""
    settings, obj = shown_settings(context), context.active_object
    row = layout.row(align=True)
    row.scale_y = 1.8
    is_again = shows_result(obj)
    text = n_("Denoise Again", "Operator") if is_again else n_("Denoise", "Operator")
    copy_settings(settings, row.operator(OBJECT_OT_framelet_denoise.bl_idname, text=text, icon="MOD_SMOOTH"))
    if is_again:
        operator = row.operator(OBJECT_OT_framelet_denoise.bl_idname, text="", icon="FORWARD")
        copy_settings(settings, operator)
        write_quietly(operator, "from_original", False)


def _draw_learned(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw, grayed, what stands for the paper's parameters with Automatic, a row each.

    Its frame is on the normals of faces, has the scales of the net, and shrinks by what it takes for noise at
    each place; vertices are fitted in one step, without a penalty.
    """
    obj = context.active_object
    entry = obj and context.window_manager.framelet_estimate.objects.get(obj.name)
    column = layout.column(align=True)
    column.active = False
    draw_value(column, iface_("Frame", "Framelet"), n_("Learned, on face normals"))
    draw_value(column, n_("Levels"), str(N_SCALES))
    draw_value(column, n_("Smoothing λ"), _noise_words(entry))
    draw_value(column, n_("Penalty μ"), n_("None, fitted at once"))


def _noise_words(entry: bpy.types.PropertyGroup | None) -> str:
    """Say in one line what a run took for noise on an object, and removed."""
    if not entry or not entry.is_denoised or not entry.has_belief:
        return n_("By local noise")
    if entry.is_off or entry.is_clean:
        return n_("Strength is 0") if entry.is_off else n_("Clean already")
    edges = range_text(entry.sigma_low_edges, entry.sigma_high_edges)
    return iface_("{range} edges").format(range=edges)


def _draw_chosen(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw, grayed, what the last run took from the noise of the active object."""
    obj = context.active_object
    entry = obj and context.window_manager.framelet_estimate.objects.get(obj.name)
    column = layout.column(align=True)
    column.active = False
    for label, name in CHOSEN:
        draw_value(column, label, (getattr(entry, name) if entry else "") or UNKNOWN)
