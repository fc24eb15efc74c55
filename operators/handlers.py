# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is done when Blender undoes, loads, saves, or edits a mesh while Framelet works."""

from __future__ import annotations

import bpy
from bpy.app.handlers import persistent

from . import own_soon
from .bands.transforms import forget_transforms
from .colors.viewport import follow_undo
from .mesh_io import kept_original
from .modifier.cage import forget_cages
from .preview import current_preview
from .properties.own_settings import has_own
from .properties.setting_values import replace_lost
from .run.current_run import drop_current, stop_current, touch_current
from .run.outcome_memory import forget_outcomes
from .run.preparations import forget_preparations
from .run.run_memory import forget_runs, forget_sides


@persistent
def _before_undo(*_: object) -> None:
    """Drop a run: undo brings back data that it was not made for. Interrupt a preview."""
    drop_current("Undo or redo was used")
    current_preview.before_undo()


@persistent
def _after_undo(*_: object) -> None:
    """Go on with a preview, and show colors if there are some."""
    forget_cages()
    forget_sides()
    follow_undo(bpy.context)
    current_preview.after_undo()


@persistent
def _before_load(*_: object) -> None:
    """Drop a run, a preview, and what was kept of the meshes of the file before."""
    drop_current("Another file was opened")
    current_preview.leave_preview()
    forget_preparations()
    forget_runs()
    forget_outcomes()
    forget_transforms()
    forget_cages()


@persistent
def _after_load(*_: object) -> None:
    """Put right a file that Blender saved by itself while a preview was on, or that is of another version."""
    kept_original.put_all_back()
    for scene in bpy.data.scenes:
        for name in ("framelet", "framelet_bands", "framelet_equalizer", "framelet_heat_map"):
            replace_lost(getattr(scene, name))
    for obj in filter(has_own, bpy.data.objects):
        replace_lost(obj.framelet)


@persistent
def _before_save(*_: object) -> None:
    """Keep the preview out of files."""
    session = current_preview.current_preview()
    if session is not None:
        session.suspend()
    kept_original.put_all_back()


@persistent
def _after_save(*_: object) -> None:
    """Show the preview again."""
    session = current_preview.current_preview()
    if session is not None:
        session.resume()


@persistent
def _after_update(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    """Have a run or a preview look in detail at meshes that may have been edited."""
    if not depsgraph.id_type_updated("MESH"):
        return
    session = current_preview.current_preview()
    touched = {update.id.original.session_uid for update in depsgraph.updates if update.is_updated_geometry}
    forget_cages(touched)
    forget_sides(touched)
    touch_current(touched)
    if session is not None:
        session.touch(touched)


_HANDLERS = {
    "undo_pre": _before_undo,
    "redo_pre": _before_undo,
    "undo_post": _after_undo,
    "redo_post": _after_undo,
    "load_pre": _before_load,
    "load_post": _after_load,
    "save_pre": _before_save,
    "save_post": _after_save,
    "save_post_fail": _after_save,
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
    own_soon.stop()
    current_preview.stop_preview()
    forget_preparations()
    forget_outcomes()
    forget_transforms()
    forget_runs()
