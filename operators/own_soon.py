# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Gives the object that the sidebar shows settings of its own, before anything can be changed there.

Panels may not write, and a slider that turned into that of other data under the mouse would be let go. So the
panel asks, and it is done as soon as the drawing is over, once for each object.
"""

from __future__ import annotations

import bpy

from .properties.own_settings import has_own, remember_settings
from .run.run_display import redraw_sidebars

_asked: set[str] = set()


def begin_soon(obj: bpy.types.Object | None) -> None:
    """Ask for settings of an object's own; for panels."""
    if obj is None or obj.type != "MESH" or has_own(obj) or not obj.is_editable or bpy.app.background:
        return
    _asked.add(obj.name)
    if not bpy.app.timers.is_registered(_begin):
        bpy.app.timers.register(_begin, first_interval=0.0)


def stop() -> None:
    """Forget what was asked for."""
    _asked.clear()
    if bpy.app.timers.is_registered(_begin):
        bpy.app.timers.unregister(_begin)


def _begin() -> None:
    """Do what was asked for."""
    scene = bpy.context.scene
    for name in _asked:
        obj = scene.objects.get(name)
        if obj is not None and obj.type == "MESH" and not has_own(obj):
            remember_settings(obj, scene.framelet)
    _asked.clear()
    redraw_sidebars()
