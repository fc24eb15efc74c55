# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The tab Framelet in the sidebar of the 3D View. It draws and never computes."""

from __future__ import annotations

import bpy

from ..operators import mesh_facts
from ..operators.add_noise import OBJECT_OT_framelet_add_noise
from ..operators.compare import OBJECT_OT_framelet_compare
from ..operators.denoise import OBJECT_OT_framelet_denoise
from ..operators.estimate_noise import OBJECT_OT_framelet_estimate_noise
from ..operators.setting_values import copy_settings, has_effect
from . import band_panels, output_panel
from .layouts import FrameletPanel, draw_lengths, draw_settings, draw_value
from .run_rows import draw_preview, draw_progress

MAIN_NAMES = (
    "method",
    "strength",
    "tuning",
    "frame",
    "levels",
    "lambda_",
    "mu",
    "normal_threshold",
    "sigma_n",
    "average_steps",
    "sigma_c",
    "sigma_s",
    "iterations",
)
ADVANCED_NAMES = (
    "stencil",
    "shrinkage",
    "delta",
    "sharpness",
    "passes",
    "vertex_steps",
    "tolerance",
    "boundary",
    "threads",
)


class VIEW3D_PT_framelet(FrameletPanel, bpy.types.Panel):
    """Choose an algorithm and denoise the selected meshes."""

    bl_label = "Framelet"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the preset, the buttons, the noise, and the settings that matter most."""
        layout = self.layout
        settings = context.scene.framelet
        layout.prop(settings, "preset", text="")
        row = layout.row()
        row.scale_y = 1.5
        copy_settings(settings, row.operator(OBJECT_OT_framelet_denoise.bl_idname, icon="MOD_SMOOTH"))
        draw_progress(layout)
        draw_preview(layout)
        layout.operator(OBJECT_OT_framelet_estimate_noise.bl_idname, icon="RNDCURVE")
        _draw_noise(layout, context)
        draw_settings(layout, settings, MAIN_NAMES, context.active_object)


class VIEW3D_PT_framelet_advanced(FrameletPanel, bpy.types.Panel):
    """The settings that are rarely changed."""

    bl_label = "Advanced"
    bl_parent_id = "VIEW3D_PT_framelet"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the other settings of the method."""
        settings = context.scene.framelet
        draw_settings(self.layout, settings, ADVANCED_NAMES)
        facts = mesh_facts.known_facts(context.active_object)
        if facts and has_effect(settings.method, "frame"):
            for line in mesh_facts.unfit_frames(facts):
                self.layout.label(text=line, icon="INFO")


class VIEW3D_PT_framelet_last_run(FrameletPanel, bpy.types.Panel):
    """What the last run did."""

    bl_label = "Last Run"
    bl_parent_id = "VIEW3D_PT_framelet"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the report of the last run as a table."""
        report = context.window_manager.framelet_report
        column = self.layout.column(align=True)
        if report.n_objects == 0:
            column.label(text="Nothing was denoised yet")
            return
        one = report.n_objects == 1
        draw_value(column, "Object" if one else "Objects", report.names if one else str(report.n_objects))
        draw_value(column, "Moved", f"{report.n_moved:,} of {report.n_vertices:,}")
        draw_lengths(column, context.scene, "RMS", report.displacement_rms, report.displacement_rms_edges)
        draw_lengths(column, context.scene, "Largest", report.displacement_max, report.displacement_max_edges)
        volume = f"{report.volume_change:+.2f} %" if report.is_closed else "Open mesh"
        draw_value(column, "Volume", volume)
        draw_value(column, "Flipped Faces", f"{report.flipped_faces:,}")
        for label, name in (
            ("Irregular", "irregular_vertices"),
            ("Boundary", "boundary_vertices"),
            ("Non-Manifold", "non_manifold_vertices"),
            ("Loose", "loose_vertices"),
        ):
            if getattr(report, name):
                draw_value(column, label, f"{getattr(report, name):,}")
        if report.has_noise:
            draw_lengths(column, context.scene, "Noise", report.noise_sigma, report.noise_sigma_edges)
            if report.is_impulsive:
                draw_value(column, "", "Impulsive")
        for label, text in (("Chosen", report.recipe), ("From Noise", report.parameters)):
            if text:
                draw_value(column, label, text)
        draw_value(column, "Iterations", str(report.iterations))
        draw_value(column, "Time", f"{report.seconds:.2f} s")


class VIEW3D_PT_framelet_try_it(FrameletPanel, bpy.types.Panel):
    """Make noise, and measure what denoising left of it."""

    bl_label = "Try It"
    bl_parent_id = "VIEW3D_PT_framelet"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the two buttons and the last comparison."""
        column = self.layout.column()
        column.operator(OBJECT_OT_framelet_add_noise.bl_idname, icon="RNDCURVE")
        column.operator(OBJECT_OT_framelet_compare.bl_idname, icon="ARROW_LEFTRIGHT")
        comparison = context.window_manager.framelet_comparison
        if not comparison.object_name:
            return
        column = self.layout.column(align=True)
        draw_value(column, "Object", comparison.object_name)
        draw_value(column, "Against", comparison.other_name)
        draw_value(column, "Mean Angle", f"{comparison.mean_angle:.3f}°")
        draw_value(column, "Largest Angle", f"{comparison.max_angle:.3f}°")
        draw_lengths(column, context.scene, "RMS", comparison.rms_distance, comparison.rms_distance_edges)
        draw_lengths(column, context.scene, "Largest", comparison.max_distance, comparison.max_distance_edges)
        draw_value(column, "Flipped Faces", f"{comparison.flipped_faces:,}")


def _draw_noise(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw the noise of the active object, if it was measured, and what was chosen for it."""
    obj = context.active_object
    entry = obj and context.window_manager.framelet_estimate.objects.get(obj.name)
    if not entry:
        return
    column = layout.column(align=True)
    label = "Noise Before" if entry.is_denoised else "Noise"
    draw_lengths(column, context.scene, label, entry.sigma, entry.sigma_edges)
    if entry.is_impulsive:
        draw_value(column, "", "Impulsive")
    if entry.recipe and context.scene.framelet.method == "AUTO":
        draw_value(column, "Chosen", entry.recipe)


classes = (
    VIEW3D_PT_framelet,
    VIEW3D_PT_framelet_last_run,
    *output_panel.classes,
    VIEW3D_PT_framelet_advanced,
    *band_panels.classes,
    VIEW3D_PT_framelet_try_it,
)
