# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The subpanels with measurements: Last Run, Noise and Sample Data. They draw and never compute."""

from __future__ import annotations

import bpy
from bpy.app.translations import pgettext_iface as iface_
from bpy.app.translations import pgettext_n as n_

from ...operators.add_noise import OBJECT_OT_framelet_add_noise
from ...operators.compare import OBJECT_OT_framelet_compare
from ...operators.estimate_noise import OBJECT_OT_framelet_estimate_noise
from ...operators.properties.scene_units import LEAST_WIDTH, range_text
from .layouts import FrameletPanel, draw_lengths, draw_text, draw_value
from .region_panel import draw_repairs

MUCH_VOLUME = 5.0
"""Change of the volume in percent from which it is shown in red: noise has none, so that shape was taken."""


class VIEW3D_PT_framelet_last_run(FrameletPanel, bpy.types.Panel):
    """What the last run did."""

    bl_label = "Last Run"
    bl_parent_id = "VIEW3D_PT_framelet_see"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the report of the last run as a table."""
        report = context.window_manager.framelet_report
        column = self.layout.column(align=True)
        if report.n_objects == 0:
            column.label(text="Nothing was denoised yet")
            return
        one = report.n_objects == 1
        if one and report.names not in bpy.data.objects:
            column.label(text="The object is gone", icon="INFO")
            return
        for hint in report.hints.splitlines():
            draw_text(column, context, hint)
        draw_value(column, "Object" if one else "Objects", report.names if one else str(report.n_objects))
        draw_value(column, "Moved", iface_("{:,} of {:,}").format(report.n_moved, report.n_vertices))
        draw_lengths(column, context.scene, "RMS", report.displacement_rms, report.displacement_rms_edges)
        draw_lengths(column, context.scene, "Largest", report.displacement_max, report.displacement_max_edges)
        volume = f"{report.volume_change:+.2f}%"
        row = column.row()
        row.alert = report.is_closed and abs(report.volume_change) > MUCH_VOLUME
        draw_value(row, "Volume", volume if report.is_closed else "Open mesh")
        draw_value(column, "Flipped Faces", f"{report.flipped_faces:,}")
        draw_repairs(column, report)
        for label, name in (
            (n_("Irregular"), "irregular_vertices"),
            (n_("Boundary"), "boundary_vertices"),
            (n_("Non-Manifold"), "non_manifold_vertices"),
            (n_("Loose"), "loose_vertices"),
        ):
            if getattr(report, name):
                draw_value(column, label, f"{getattr(report, name):,}")
        if report.has_belief:
            draw_belief(column, context.scene, n_("Noise"), report)
        elif report.has_noise:
            draw_lengths(column, context.scene, "Noise", report.noise_sigma, report.noise_sigma_edges)
            if report.is_impulsive:
                draw_value(column, "", "Impulsive")
        if report.parameters:
            draw_value(column, n_("From Noise"), report.parameters)
        draw_value(column, "Passes" if report.has_belief else "Iterations", str(report.iterations))
        draw_value(column, "Time", f"{report.seconds:.2f} s")


def draw_belief(
    column: bpy.types.UILayout, scene: bpy.types.Scene, label: str, found: bpy.types.PropertyGroup
) -> None:
    """Draw, as lines of a table, what automatic denoising took for noise; `found` has a `BeliefMixin`."""
    if found.is_off or found.is_clean:
        draw_value(column, label, n_("Strength is 0") if found.is_off else n_("Clean already"))
        return
    draw_value(column, label, range_text(found.sigma_low, found.sigma_high, scene))
    edges = range_text(found.sigma_low_edges, found.sigma_high_edges)
    draw_value(column, "", iface_("{range} edges").format(range=edges))
    if found.width > LEAST_WIDTH:
        draw_value(column, "Width", iface_("about {:.1f} edges").format(found.width))
    if found.wide:
        draw_value(column, "Wide", f"{found.wide:.3g}%")
    if found.along_edges:
        draw_value(column, "Along Surface", iface_("{:.2g} edges").format(found.along_edges))
    if found.spikes:
        draw_value(column, "Spikes", f"{found.spikes:.2g}%")
    if found.clean:
        draw_value(column, "Clean", iface_("{:.3g}% stayed").format(found.clean))


class VIEW3D_PT_framelet_noise(FrameletPanel, bpy.types.Panel):
    """How noisy the active mesh is."""

    bl_label = "Noise"
    bl_parent_id = "VIEW3D_PT_framelet_see"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the button, and what was measured for the active object."""
        self.layout.operator(OBJECT_OT_framelet_estimate_noise.bl_idname, icon="RNDCURVE")
        obj = context.active_object
        entry = obj and context.window_manager.framelet_estimate.objects.get(obj.name)
        if not entry:
            return
        column = self.layout.column(align=True)
        label = n_("Noise Before") if entry.is_denoised else n_("Noise")
        if entry.has_belief:
            draw_belief(column, context.scene, label, entry)
            return
        draw_lengths(column, context.scene, label, entry.sigma, entry.sigma_edges)
        if entry.is_impulsive:
            draw_value(column, "", "Impulsive")


class VIEW3D_PT_framelet_try_it(FrameletPanel, bpy.types.Panel):
    """Make noise, and measure what denoising left of it."""

    bl_label = "Sample Data"
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


classes = (VIEW3D_PT_framelet_last_run, VIEW3D_PT_framelet_noise)
"""Those within Result."""

sample_classes = (VIEW3D_PT_framelet_try_it,)
