# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The tab Framelet in the sidebar of the 3D View. It draws and never computes."""

from __future__ import annotations

import bpy

from ..operators.add_noise import OBJECT_OT_framelet_add_noise
from ..operators.compare import OBJECT_OT_framelet_compare
from ..operators.denoise import OBJECT_OT_framelet_denoise
from ..operators.scene_units import length_text
from ..operators.setting_values import copy_settings, has_effect

MAIN_NAMES = ("frame", "levels", "lambda_", "mu", "sigma_c", "sigma_s")
ADVANCED_NAMES = ("method", "stencil", "shrinkage", "delta", "iterations", "tolerance", "boundary", "threads")


class FrameletPanel:
    """Where all panels of Framelet are."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Framelet"


class VIEW3D_PT_framelet(FrameletPanel, bpy.types.Panel):
    """Choose an algorithm and denoise the selected meshes."""

    bl_label = "Framelet"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the preset, the button, and the settings that matter most."""
        layout = self.layout
        settings = context.scene.framelet
        layout.prop(settings, "preset", text="")
        row = layout.row()
        row.scale_y = 1.5
        copy_settings(settings, row.operator(OBJECT_OT_framelet_denoise.bl_idname, icon="MOD_SMOOTH"))
        _draw_settings(layout, settings, MAIN_NAMES)


class VIEW3D_PT_framelet_advanced(FrameletPanel, bpy.types.Panel):
    """The settings that are rarely changed."""

    bl_label = "Advanced"
    bl_parent_id = "VIEW3D_PT_framelet"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the other settings of the method."""
        _draw_settings(self.layout, context.scene.framelet, ADVANCED_NAMES)


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
        _draw_value(column, "Object" if one else "Objects", report.names if one else str(report.n_objects))
        _draw_value(column, "Moved", f"{report.n_moved:,} of {report.n_vertices:,}")
        _draw_lengths(column, context.scene, "RMS", report.displacement_rms, report.displacement_rms_edges)
        _draw_lengths(
            column, context.scene, "Largest", report.displacement_max, report.displacement_max_edges
        )
        volume = f"{report.volume_change:+.2f} %" if report.is_closed else "Open mesh"
        _draw_value(column, "Volume", volume)
        _draw_value(column, "Flipped Faces", f"{report.flipped_faces:,}")
        for label, name in (
            ("Irregular", "irregular_vertices"),
            ("Boundary", "boundary_vertices"),
            ("Non-Manifold", "non_manifold_vertices"),
            ("Loose", "loose_vertices"),
        ):
            if getattr(report, name):
                _draw_value(column, label, f"{getattr(report, name):,}")
        _draw_value(column, "Iterations", str(report.iterations))
        _draw_value(column, "Time", f"{report.seconds:.2f} s")


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
        _draw_value(column, "Object", comparison.object_name)
        _draw_value(column, "Against", comparison.other_name)
        _draw_value(column, "Mean Angle", f"{comparison.mean_angle:.3f}°")
        _draw_value(column, "Largest Angle", f"{comparison.max_angle:.3f}°")
        _draw_lengths(column, context.scene, "RMS", comparison.rms_distance, comparison.rms_distance_edges)
        _draw_lengths(
            column, context.scene, "Largest", comparison.max_distance, comparison.max_distance_edges
        )
        _draw_value(column, "Flipped Faces", f"{comparison.flipped_faces:,}")


def _draw_settings(
    layout: bpy.types.UILayout, settings: bpy.types.PropertyGroup, names: tuple[str, ...]
) -> None:
    """Draw those of the settings that the method uses."""
    column = layout.column()
    column.use_property_split = True
    column.use_property_decorate = False
    for name in names:
        if has_effect(settings.method, name):
            column.prop(settings, name)


def _draw_value(layout: bpy.types.UILayout, label: str, value: str) -> None:
    """Draw a line of a table: the name on the right of its column, as next to a property, and the value."""
    split = layout.split(factor=0.4)
    left = split.row()
    left.alignment = "RIGHT"
    left.label(text=label)
    split.label(text=value)


def _draw_lengths(
    layout: bpy.types.UILayout, scene: bpy.types.Scene, label: str, length: float, edges: float
) -> None:
    """Draw a length in scene units, and in edge lengths below it."""
    _draw_value(layout, label, length_text(scene, length))
    _draw_value(layout, "", f"{edges:.3f} edge lengths")


classes = (
    VIEW3D_PT_framelet,
    VIEW3D_PT_framelet_last_run,
    VIEW3D_PT_framelet_advanced,
    VIEW3D_PT_framelet_try_it,
)
