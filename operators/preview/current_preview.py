# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The one preview that may be on, and the timer that keeps it up to date."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy

from ..mesh_io import kept_original
from ..properties.own_settings import settings_of
from ..properties.region_values import to_region_options
from ..properties.setting_values import to_settings
from ..run.run_display import redraw_sidebars
from ..window_events import is_mesh_being_read

if TYPE_CHECKING:
    from ..run.run_guard import Mark
    from .preview_session import PreviewSession

TICK = 0.03
"""Seconds between two looks at the settings."""

MOST_VERTICES = 500_000
"""Above this a change takes a second and more to be seen, and pressing Denoise serves better."""

_session: PreviewSession | None = None

_ending: list[PreviewSession] = []
"""Previews that are over, whose threads may not have noticed yet."""

_message = ""
"""What the last preview said when it ended."""

_drawn = (False, "", 0.0)
"""What sidebars show: whether the preview is current, its message, and how much is done."""

_resumed: Mark | None = None


def current_preview() -> PreviewSession | None:
    """Return the preview that is on, or None."""
    global _session, _message
    if _session is not None and not _session.is_on:
        _ending.append(_session)
        _message, _session = _session.message, None
    if _ending:
        _ending[:] = [ended for ended in _ending if not ended.has_ended]
    return _session


def is_too_large(obj: bpy.types.Object) -> bool:
    """Return whether an object has more vertices than a preview can follow."""
    return len(obj.data.vertices) > MOST_VERTICES


def preview_message() -> str:
    """Return why nothing is shown, or why the last preview ended; empty if there is nothing to say."""
    session = current_preview()
    return _message if session is None else session.message


def start_preview(obj: bpy.types.Object, scene: bpy.types.Scene) -> PreviewSession:
    """Turn the preview of an object on, and that of any other off.

    Raises
    ------
    ValueError
        In one sentence, if there can be none.
    """
    from .preview_session import begin_preview

    global _session, _message
    end_preview()
    current_preview()
    _message = ""
    if is_too_large(obj):
        raise ValueError(
            f"‘{obj.name}’ has {len(obj.data.vertices):,} vertices, too many for a preview, which goes up to "
            f"{MOST_VERTICES:,}; press Denoise."
        )
    values = settings_of(obj, scene)
    _session = begin_preview(obj, to_settings(values), to_region_options(values))
    tick_preview()
    if not bpy.app.timers.is_registered(_on_timer):
        bpy.app.timers.register(_on_timer, first_interval=TICK)
    return _session


def tick_preview() -> bool:
    """Bring the preview up to date with the settings of its object; return whether it is on.

    While Blender reads meshes to render or bake them the preview stays as it is.
    """
    global _drawn
    session = current_preview()
    if session is None:
        return False
    if is_mesh_being_read():
        return True
    values = settings_of(session.find_object(), bpy.context.scene)
    try:
        is_on = session.tick(to_settings(values), to_region_options(values))
    except ValueError as error:  # settings that a script made no numbers of
        session.end(str(error))
        is_on = False
    state = (session.is_current, session.message, round(session.fraction, 1))
    if state != _drawn or not is_on:
        _drawn = state
        redraw_sidebars()
    return is_on


def end_preview() -> None:
    """Turn the preview off, if it is on; the mesh gets its original positions."""
    session = current_preview()
    if session is not None:
        session.end()
        redraw_sidebars()


def stop_preview() -> None:
    """Turn the preview off and wait until its thread has ended."""
    end_preview()
    current_preview()
    while _ending:
        _ending.pop().join()
    _remove_timer()


def leave_preview() -> None:
    """Forget the preview of a file that is being closed."""
    session = current_preview()
    if session is not None:
        session.leave()
        current_preview()
    # Blender 4 crashes on exit if it has to remove a timer of Python when it opens a file.
    _remove_timer()


def _remove_timer() -> None:
    """Take the timer away, if it is there."""
    if bpy.app.timers.is_registered(_on_timer):
        bpy.app.timers.unregister(_on_timer)


def before_undo() -> None:
    """Give the mesh its original positions before Blender goes back or forth."""
    global _resumed
    session = current_preview()
    _resumed = None
    if session is not None:
        _resumed = session.mark
        session.end()


def after_undo() -> None:
    """Put right what came back, and turn the preview on again."""
    global _resumed
    kept_original.put_all_back()
    mark, _resumed = _resumed, None
    if mark is None:
        return
    obj = next((each for each in bpy.data.objects if each.name == mark.name), None)
    if obj is None or obj.type != "MESH" or obj.mode != "OBJECT":
        redraw_sidebars()
        return
    try:
        start_preview(obj, bpy.context.scene)
    except ValueError:
        redraw_sidebars()  # what came back can have no preview, which its button says


def _on_timer() -> float | None:
    """Tick; an error ends the preview, since a timer that fails is not called again."""
    try:
        return TICK if tick_preview() else None
    except Exception:
        end_preview()
        raise
