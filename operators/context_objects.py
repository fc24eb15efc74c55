# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is active, selected and edited, also where there is no window.

Timers of scripts run without one, and there Blender's context lacks all that depends on a screen.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import bpy


def active_object(context: bpy.types.Context) -> bpy.types.Object | None:
    """Return the active object; None if there is none."""
    if hasattr(context, "active_object"):
        return context.active_object
    return context.view_layer.objects.active


def selected_objects(context: bpy.types.Context) -> list[bpy.types.Object]:
    """Return the selected objects that are visible."""
    if hasattr(context, "selected_objects"):
        return list(context.selected_objects)
    return [obj for obj in context.view_layer.objects if obj.select_get() and obj.visible_get()]


def edited_objects(context: bpy.types.Context) -> list[bpy.types.Object]:
    """Return the objects in Edit Mode, one for each mesh."""
    if hasattr(context, "objects_in_mode_unique_data"):
        return list(context.objects_in_mode_unique_data)
    objects = (obj for obj in context.view_layer.objects if obj.type == "MESH" and obj.mode == "EDIT")
    return list({obj.data: obj for obj in objects}.values())
