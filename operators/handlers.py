# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is done when Blender undoes, loads, saves, or edits a mesh while Framelet works."""

from __future__ import annotations

import bpy
from bpy.app.handlers import persistent

from .current_run import drop_current, stop_current, touch_current
from .preparations import forget_preparations
from .run_memory import forget_runs


@persistent
def _before_undo(*_: object) -> None:
    """Drop a run: undo brings back data that it was not made for."""
    drop_current("Undo or redo was used")


@persistent
def _before_load(*_: object) -> None:
    """Drop a run, and what was kept of the meshes of the file before."""
    drop_current("Another file was opened")
    forget_preparations()
    forget_runs()


@persistent
def _after_update(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    """Look in detail after an edit of a mesh."""
    if depsgraph.id_type_updated("MESH"):
        touch_current()


_HANDLERS = {
    "undo_pre": _before_undo,
    "redo_pre": _before_undo,
    "load_pre": _before_load,
    "depsgraph_update_post": _after_update,
}


def register() -> None:
    """Add the handlers."""
    for name, handler in _HANDLERS.items():
        getattr(bpy.app.handlers, name).append(handler)


def unregister() -> None:
    """Take the handlers away, and stop what is going on."""
    for name, handler in _HANDLERS.items():
        getattr(bpy.app.handlers, name).remove(handler)
    stop_current()
    forget_preparations()
    forget_runs()
