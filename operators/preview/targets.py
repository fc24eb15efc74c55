# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which objects an operator works on, and running over them with progress and words for people."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

import bpy
from bpy.app.translations import pgettext_n as n_
from bpy.app.translations import pgettext_rpt as rpt_

from ..context_objects import active_object, edited_objects, selected_objects
from ..mesh_io.band_storage import has_note
from ..shortage import shortage_told
from .current_preview import end_preview

MODES = frozenset({"OBJECT", "EDIT_MESH", "SCULPT", "PAINT_VERTEX", "PAINT_WEIGHT", "PAINT_TEXTURE"})
"""Modes, by the context's names, that have meshes to work on."""

Result = TypeVar("Result")
Progress = Callable[[float, float], bool]


def poll_reason(context: bpy.types.Context, *, in_object_mode: bool = False) -> str | None:
    """Say why there is nothing to work on, or not in this mode; None if there is."""
    if in_object_mode and context.mode != "OBJECT":
        return n_("Switch to Object Mode")
    if context.mode not in MODES:
        return n_("Switch to Object Mode, or to Edit Mode or Sculpt Mode of a mesh")
    if not target_objects(context):
        return n_("Select at least one mesh object")
    return None


def band_poll_reason(context: bpy.types.Context) -> str | None:
    """Say why there are no stored bands to work on; None if there are."""
    reason = poll_reason(context, in_object_mode=True)
    if reason is None and not any(has_note(obj.data) for obj in target_objects(context)):
        return n_("Analyze a selected mesh first: none has stored bands")
    return reason


def allows(operator: type[bpy.types.Operator], reason: str | None) -> bool:
    """Return whether there is no reason against an operator; otherwise let its gray button say the reason."""
    if reason is not None:
        operator.poll_message_set(rpt_(reason))
    return reason is None


def target_objects(context: bpy.types.Context) -> list[bpy.types.Object]:
    """Return the objects to work on, one for each mesh.

    In Edit Mode these are the objects in it, when sculpting or painting the active object, in Object Mode the
    selected mesh objects. Of objects that share a mesh the active one stands for all, since its active shape
    key is the one that the user sees.
    """
    if context.mode == "EDIT_MESH":
        return edited_objects(context)
    active = active_object(context)
    if context.mode != "OBJECT":
        return [] if active is None or active.type != "MESH" else [active]
    selected = [obj for obj in selected_objects(context) if obj.type == "MESH"]
    selected.sort(key=lambda obj: obj != active)
    return list({obj.data: obj for obj in reversed(selected)}.values())[::-1]


def run_on_targets(
    operator: bpy.types.Operator,
    context: bpy.types.Context,
    run: Callable[[bpy.types.Object, Progress], Result],
) -> dict[str, Result]:
    """Run a function on every target, show progress, and report what failed.

    Parameters
    ----------
    operator : bpy.types.Operator
        Gets an error if all failed, and a warning that names the failed if some did.
    context : bpy.types.Context
        Says what the targets are.
    run : callable
        `run(obj, progress)`; raises ValueError with a sentence that names the object.

    Returns
    -------
    dict
        The results by object name; empty if nothing was done.
    """
    end_preview()  # what it shows is not what the mesh is
    objects = target_objects(context)
    results: dict[str, Result] = {}
    failures: list[str] = []
    manager = context.window_manager
    manager.progress_begin(0.0, float(len(objects)))
    try:
        for number, obj in enumerate(objects):

            def progress(fraction: float, _change: float, number: int = number) -> bool:
                manager.progress_update(number + fraction)
                return False

            try:
                with shortage_told(obj.name):
                    results[obj.name] = run(obj, progress)
            except ValueError as error:
                failures.append(str(error))
    finally:
        manager.progress_end()
    if failures:
        operator.report({"WARNING"} if results else {"ERROR"}, " ".join(failures))
    return results


def names_text(names: list[str]) -> str:
    """Return the names of objects for a line of text: one by name, several by number."""
    return f"‘{names[0]}’" if len(names) == 1 else rpt_("{number} objects").format(number=len(names))
