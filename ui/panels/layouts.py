# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What all panels of Framelet share: where they are, and how settings, values and lengths look."""

from __future__ import annotations

import textwrap

import bpy
from bpy.app.translations import pgettext_iface as iface_

from ...core.settings import replaced_by
from ...operators.mesh_io import mesh_facts
from ...operators.properties.scene_units import length_text
from ...operators.properties.setting_values import has_effect

LETTER = 6.2
"""Width of a letter in units of the interface, on average."""


class FrameletPanel:
    """Where all panels of Framelet are."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Framelet"


def settings_column(layout: bpy.types.UILayout) -> bpy.types.UILayout:
    """Return a column whose properties have their names on the left."""
    column = layout.column()
    column.use_property_split = True
    column.use_property_decorate = False
    return column


def draw_settings(
    layout: bpy.types.UILayout,
    settings: bpy.types.PropertyGroup,
    names: tuple[str, ...],
    obj: bpy.types.Object | None = None,
) -> None:
    """Draw those of the settings that the method uses, and whether the frame fits an object.

    Those that another one replaces are grayed.
    """
    column = settings_column(layout)
    for name in names:
        if not has_effect(settings.method, name):
            continue
        if name == "frame":
            draw_frame(column, settings, obj)
        else:
            row = column.row()
            row.active = replaced_by(settings, name) is None
            row.prop(settings, name)


def draw_frame(
    column: bpy.types.UILayout, settings: bpy.types.PropertyGroup, obj: bpy.types.Object | None
) -> None:
    """Draw the choice of a frame and, if it does not fit the mesh of an object, why."""
    column.prop(settings, "frame")
    facts = mesh_facts.known_facts(obj)
    misfit = facts and mesh_facts.misfit(settings.frame, settings.stencil, facts)
    if misfit:
        icon, reason = misfit
        column.label(text=reason, icon=icon)


def draw_value(layout: bpy.types.UILayout, label: str, value: str) -> None:
    """Draw a line of a table: the name on the right of its column, as next to a property, and the value."""
    split = layout.split(factor=0.4)
    left = split.row()
    left.alignment = "RIGHT"
    left.label(text=label)
    split.label(text=value)


def draw_text(layout: bpy.types.UILayout, context: bpy.types.Context, text: str) -> None:
    """Draw a sentence in as many lines as the width of the sidebar asks for; labels are cut off."""
    width = (
        260 if context.region is None else context.region.width / (context.preferences.system.ui_scale or 1.0)
    )
    lines = textwrap.wrap(text[:1].upper() + text[1:], max(int(width / LETTER) - 8, 16))
    for number, line in enumerate(lines):
        layout.label(text=line, translate=False, icon="BLANK1" if number else "INFO")


def draw_lengths(
    layout: bpy.types.UILayout, scene: bpy.types.Scene, label: str, length: float, edges: float
) -> None:
    """Draw a length in scene units, and in edge lengths below it."""
    draw_value(layout, label, length_text(scene, length))
    draw_value(layout, "", iface_("{:.3f} edge lengths").format(edges))
