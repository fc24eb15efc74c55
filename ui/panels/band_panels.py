# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The subpanels Bands and Equalizer. They draw and never compute."""

from __future__ import annotations

import bpy
from bpy.app.translations import pgettext_iface as iface_

from ...operators.analyze import OBJECT_OT_framelet_analyze, OBJECT_OT_framelet_clear
from ...operators.equalize import OBJECT_OT_framelet_equalize, OBJECT_OT_framelet_live_equalizer
from ...operators.mesh_io import band_storage, mesh_facts
from ...operators.modifier.recipes import EQUALIZER, recipe_of
from ...operators.modifier.stack import find_modifier
from ...operators.properties.band_settings import EQUALIZER_NAMES, GAIN_NAMES, SHOW_NAMES, shown_names
from ...operators.properties.own_settings import settings_of, shown_settings
from ...operators.properties.scene_units import length_text
from ...operators.properties.setting_values import all_values, copy_frame_settings, copy_values, has_effect
from ...operators.show_band import OBJECT_OT_framelet_show_band
from ...operators.synthesize import OBJECT_OT_framelet_synthesize
from .layouts import FrameletPanel, draw_frame, draw_value, settings_column
from .modifier_rows import draw_input, draw_modifier


class VIEW3D_PT_framelet_bands(FrameletPanel, bpy.types.Panel):
    """Store the bands of meshes, look at them, and rebuild meshes from them."""

    bl_label = "Bands"
    bl_parent_id = "VIEW3D_PT_framelet"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw what is stored, and what can be done with it."""
        from ...operators.bands.bands import megabytes_text

        layout, scene = self.layout, context.scene
        bands, settings = scene.framelet_bands, shown_settings(context)
        if not has_effect(settings.method, "frame"):
            column = settings_column(layout)
            draw_frame(column, settings, context.active_object)
            column.prop(settings, "levels")
        operator = layout.operator(OBJECT_OT_framelet_analyze.bl_idname, icon="MOD_MULTIRES")
        copy_frame_settings(settings, operator)
        copy_values(bands, operator, ("max_megabytes",))
        obj = context.active_object
        n_bytes = _needed_bytes(scene, obj)
        column = settings_column(layout)
        if n_bytes is not None:
            is_too_much = n_bytes > bands.max_megabytes * 1e6
            row = column.row()
            row.alert = is_too_much
            draw_value(row, "Needs", megabytes_text(n_bytes))
        column.prop(bands, "max_megabytes", text="Allowed MB")
        if obj is None or obj.type != "MESH" or not band_storage.has_traces(obj.data):
            return
        _draw_stored(layout, obj)
        column = settings_column(layout)
        for name in shown_names(bands):
            column.prop(bands, name)
        copy_values(bands, layout.operator(OBJECT_OT_framelet_show_band.bl_idname, icon="COLOR"), SHOW_NAMES)
        _draw_range(layout, context, obj)
        row = layout.row(align=True)
        row.operator(OBJECT_OT_framelet_synthesize.bl_idname, icon="FILE_REFRESH")
        row.operator(OBJECT_OT_framelet_clear.bl_idname, icon="X")


class VIEW3D_PT_framelet_equalizer(FrameletPanel, bpy.types.Panel):
    """Smooth or exaggerate the details of each scale."""

    bl_label = "Equalizer"
    bl_parent_id = "VIEW3D_PT_framelet"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the gains, the group and the buttons; of an object with the modifier, its gains and mask."""
        scene, obj = context.scene, context.active_object
        equalizer, settings = scene.framelet_equalizer, shown_settings(context)
        modifier = find_modifier(obj, EQUALIZER)
        if obj is not None and modifier is not None:
            gains = settings_column(self.layout).column(align=True)
            for term in recipe_of(modifier).terms:
                draw_input(gains, modifier, term.name)
            draw_modifier(self.layout, obj, EQUALIZER)
            return
        column = settings_column(self.layout)
        if not has_effect(settings.method, "frame"):
            draw_frame(column, settings, obj)
        column.prop(equalizer, "levels")
        gains = column.column(align=True)
        for name in GAIN_NAMES[: equalizer.levels]:
            gains.prop(equalizer, name, slider=True)
        if obj is not None and obj.type == "MESH":
            row = column.row(align=True)
            row.prop_search(equalizer, "vertex_group", obj, "vertex_groups")
            row.prop(equalizer, "invert", text="", icon="ARROW_LEFTRIGHT")
        row = self.layout.row(align=True)
        for each, icon in (
            (OBJECT_OT_framelet_equalize, "FCURVE"),
            (OBJECT_OT_framelet_live_equalizer, "MODIFIER"),
        ):
            operator = row.operator(each.bl_idname, icon=icon)
            copy_frame_settings(settings, operator, ("frame", "stencil", "boundary"))
            copy_values(equalizer, operator, EQUALIZER_NAMES)


def _needed_bytes(scene: bpy.types.Scene, obj: bpy.types.Object | None) -> int | None:
    """Return how much analyzing the active mesh would store; None if that is not known."""
    facts = mesh_facts.known_facts(obj)
    if facts is None:
        return None
    values = all_values(settings_of(obj, scene))
    frame = mesh_facts.resolve_frame(values["frame"], facts)
    return mesh_facts.stored_bytes(frame, values["stencil"], values["levels"], facts)


def _draw_stored(layout: bpy.types.UILayout, obj: bpy.types.Object) -> None:
    """Draw which bands the active mesh has."""
    column = layout.column(align=True)
    try:
        note = band_storage.read_note(obj)
    except ValueError:
        column.label(text="No bands that can be read", icon="ERROR")
        return
    draw_value(column, "Stored", mesh_facts.frame_label(note.frame, note.stencil))
    text = iface_("1 level, {bands} bands") if note.levels == 1 else iface_("{levels} levels, {bands} bands")
    draw_value(column, "", text.format(levels=note.levels, bands=sum(note.n_bands)))


def _draw_range(layout: bpy.types.UILayout, context: bpy.types.Context, obj: bpy.types.Object) -> None:
    """Draw what the colors of an object mean, if that is known."""
    shown = context.window_manager.framelet_band_range
    is_shown = not shown.quantity and band_storage.COLORS in obj.data.attributes
    if not is_shown or obj.name not in shown.objects:
        return
    column = layout.column(align=True)
    draw_value(column, "Colors", shown.title)
    lowest = f"−{length_text(context.scene, shown.maximum)}" if shown.is_signed else "0"
    draw_value(column, "Blue" if shown.is_signed else "Gray", lowest)
    draw_value(column, "Red" if shown.is_signed else "Violet", length_text(context.scene, shown.maximum))
    draw_value(column, "Within", iface_("{:.1f}% of vertices").format(shown.share))


classes = (VIEW3D_PT_framelet_bands, VIEW3D_PT_framelet_equalizer)
