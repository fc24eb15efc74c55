# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The subpanels Mask, where vertices may move, and Constraints, how far and what is mended."""

from __future__ import annotations

import bpy
from bpy.app.translations import pgettext_iface as iface_
from bpy.app.translations import pgettext_n as n_

from ...operators.properties.own_settings import shown_settings
from .layouts import FrameletPanel, draw_value, settings_column


class VIEW3D_PT_framelet_mask(FrameletPanel, bpy.types.Panel):
    """Where vertices may move."""

    bl_label = "Mask"
    bl_parent_id = "VIEW3D_PT_framelet"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the vertex group, and what else holds vertices."""
        settings = shown_settings(context)
        column = settings_column(self.layout)
        _draw_group(column, settings, context.active_object)
        row = column.row(align=True)
        row.prop(settings, "face_set")
        row.operator("object.framelet_pick_face_set", text="", icon="EYEDROPPER")
        column.prop(settings, "keep_mask")
        column.prop(settings, "keep_hidden")


class VIEW3D_PT_framelet_region(FrameletPanel, bpy.types.Panel):
    """How far vertices may move, and what is mended."""

    bl_label = "Constraints"
    bl_parent_id = "VIEW3D_PT_framelet"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the options; those without effect as the others are stay away or are gray."""
        settings = shown_settings(context)
        column = settings_column(self.layout)
        column.prop(settings, "keep_sharp")
        column.prop(settings, "boundary")
        if settings.boundary != "FIXED":
            column.prop(settings, "straighten_borders")
        column.prop(settings, "flatten_spikes")
        column.separator()
        column.prop(settings, "limit")
        if settings.limit != "NONE":
            column.prop(settings, "max_edges" if settings.limit == "EDGES" else "max_length")
        column.prop(settings, "along_normals")
        column.separator()
        column.prop(settings, "keep_volume")
        column.prop(settings, "repair_folds")
        column.prop(settings, "weld")
        if settings.weld:
            column.prop(settings, "weld_distance")
        column.prop(settings, "together")


def draw_repairs(layout: bpy.types.UILayout, report: bpy.types.PropertyGroup) -> None:
    """Draw, as lines of the table of the last run, folded and degenerate faces and what regions did."""
    for label, name in ((n_("Folded Faces"), "folded_faces"), (n_("Degenerate"), "degenerate_faces")):
        now, before = getattr(report, name), getattr(report, f"{name}_before")
        if now or before:
            draw_value(layout, label, iface_("{:,} (before: {:,})").format(now, before))
    for label, name in (
        (n_("Damped"), "damped_vertices"),
        (n_("On Lines"), "line_vertices"),
        (n_("Welded"), "welded_vertices"),
    ):
        if getattr(report, name):
            draw_value(layout, label, f"{getattr(report, name):,}")


def _draw_group(
    column: bpy.types.UILayout, settings: bpy.types.PropertyGroup, obj: bpy.types.Object | None
) -> None:
    """Draw the choice of a vertex group, from those of the active object if it is a mesh."""
    row = column.row(align=True)
    if obj is not None and obj.type == "MESH":
        row.prop_search(settings, "vertex_group", obj, "vertex_groups")
    else:
        row.prop(settings, "vertex_group")
    button = row.row(align=True)
    button.active = bool(settings.vertex_group)
    button.prop(settings, "invert_group", text="", icon="ARROW_LEFTRIGHT")
    if obj is None or obj.type != "MESH" or not settings.vertex_group:
        return
    if settings.vertex_group not in obj.vertex_groups:
        column.label(text=iface_("‘{name}’ has no such group").format(name=obj.name), icon="ERROR")


classes = (VIEW3D_PT_framelet_mask, VIEW3D_PT_framelet_region)
