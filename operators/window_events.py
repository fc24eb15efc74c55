# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What Framelet may take for itself of a window's events, and when it may write to meshes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy

if TYPE_CHECKING:
    from collections.abc import Iterable

OVER_THE_VIEW = frozenset({"UI", "TOOLS", "HEADER", "TOOL_HEADER", "ASSET_SHELF", "ASSET_SHELF_HEADER"})
"""Regions of a 3D View that lie over its drawing, and where a right click opens a menu."""

READERS = ("RENDER", "OBJECT_BAKE")
"""Jobs that read meshes on a thread of their own."""


def cancels(context: bpy.types.Context, event: bpy.types.Event) -> bool:
    """Tell whether an event asks to end what Framelet does: Esc or a right click in a 3D View.

    Menus, text fields and tools that were started later get their events first. Elsewhere in the window Esc
    and the right button have a meaning of their own, and so has Esc while an animation plays.
    """
    if event.value != "PRESS" or event.type not in {"ESC", "RIGHTMOUSE"}:
        return False
    screen = context.window.screen
    views = [area for area in screen.areas if area.type == "VIEW_3D"]
    view = next((area for area in views if _is_within(area, event)), None)
    if event.type == "ESC":
        # Without a 3D View there is no other way out, nor the button in its sidebar.
        return not screen.is_animation_playing and (view is not None or not views)
    return view is not None and not _is_over(view.regions, event)


def view_under_mouse(
    context: bpy.types.Context, event: bpy.types.Event
) -> tuple[bpy.types.Area, bpy.types.Region] | None:
    """Return the 3D View under the mouse and the region that it is drawn in; None elsewhere."""
    for area in context.window.screen.areas:
        if area.type == "VIEW_3D" and _is_within(area, event) and not _is_over(area.regions, event):
            region = next((each for each in area.regions if each.type == "WINDOW"), None)
            return None if region is None else (area, region)
    return None


def is_mesh_being_read() -> bool:
    """Tell whether Blender renders or bakes, while which no mesh may be written to: it may crash."""
    return any(map(is_job_running, READERS))


def is_job_running(name: str) -> bool:
    """Tell whether Blender does a job, by Blender's name for its kind."""
    return bpy.app.is_job_running(name)


def _is_over(regions: Iterable[bpy.types.Region], event: bpy.types.Event) -> bool:
    """Tell whether the mouse is over a region that covers the view."""
    return any(region.type in OVER_THE_VIEW and _is_within(region, event) for region in regions)


def _is_within(part: bpy.types.Area | bpy.types.Region, event: bpy.types.Event) -> bool:
    """Tell whether the mouse is within an area or a region."""
    x, y = event.mouse_x - part.x, event.mouse_y - part.y
    return 0 <= x < part.width and 0 <= y < part.height
