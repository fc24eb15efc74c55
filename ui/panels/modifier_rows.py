# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows for Framelet's modifiers: their inputs, and the buttons that end them. They draw and never compute."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...operators.edit_modifier import (
    OBJECT_OT_framelet_apply_modifier,
    OBJECT_OT_framelet_remove_modifier,
    OBJECT_OT_framelet_sculpt_mask,
    has_sculpt_mask,
)
from ...operators.modifier.cage import cage_words
from ...operators.modifier.inputs import get_input, input_property
from ...operators.modifier.node_groups import INVERT, MASK, ON
from ...operators.modifier.recipes import AMOUNT, DISPLACEMENT
from ...operators.modifier.stack import find_modifier
from ...operators.properties.setting_values import write_quietly
from .layouts import settings_column

if TYPE_CHECKING:
    import bpy


def draw_amount(
    column: bpy.types.UILayout, settings: bpy.types.PropertyGroup, obj: bpy.types.Object | None
) -> None:
    """Draw how much of the change is made: that of the modifier, where an object has it."""
    modifier = find_modifier(obj, DISPLACEMENT)
    if modifier is None:
        column.prop(settings, "amount")
    else:
        draw_input(column, modifier, AMOUNT)


def draw_modifier(layout: bpy.types.UILayout, obj: bpy.types.Object, kind: str) -> None:
    """Draw mask and switches of a modifier, what is wrong with it, and the buttons that end it."""
    modifier = find_modifier(obj, kind)
    if modifier is None:
        return
    column = settings_column(layout)
    owner, key = input_property(modifier, MASK)
    column.prop_search(owner, key, obj, "vertex_groups", text="Mask", results_are_suggestions=True)
    if has_sculpt_mask(obj):
        column.operator(OBJECT_OT_framelet_sculpt_mask.bl_idname, icon="SCULPTMODE_HLT")
    if get_input(modifier, MASK):
        draw_input(column, modifier, INVERT)
    draw_input(column, modifier, ON)
    words = cage_words(obj)
    if words:
        layout.label(text=words, translate=False, icon="ERROR")
    row = layout.row(align=True)
    operator = row.operator(OBJECT_OT_framelet_apply_modifier.bl_idname, text="Apply", icon="CHECKMARK")
    write_quietly(operator, "kind", kind)
    operator = row.operator(OBJECT_OT_framelet_remove_modifier.bl_idname, text="Remove", icon="X")
    write_quietly(operator, "kind", kind)


def draw_input(column: bpy.types.UILayout, modifier: bpy.types.Modifier, name: str) -> None:
    """Draw an input of a modifier."""
    owner, key = input_property(modifier, name)
    column.prop(owner, key, text=name)
