# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Show how far a run is: in the status bar, and in the sidebars, which draw it themselves."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy
from bpy.app.translations import pgettext_iface as iface_

if TYPE_CHECKING:
    from .denoise_run import DenoiseRun


class RunDisplay:
    """What is shown of one run until it is removed."""

    def __init__(self, context: bpy.types.Context, run: DenoiseRun) -> None:
        self._run = run
        self._workspaces: set[str] = set()
        self._shown = ""
        self.update(context)

    def update(self, context: bpy.types.Context) -> None:
        """Show the progress if it went on by a percent."""
        text = status_text(self._run)
        workspace = context.workspace
        if text == self._shown and (workspace is None or workspace.name in self._workspaces):
            return
        self._shown = text
        if workspace is not None:
            workspace.status_text_set(text)
            self._workspaces.add(workspace.name)
        redraw_sidebars()

    def remove(self) -> None:
        """Show again what was shown before."""
        for name in self._workspaces:
            workspace = bpy.data.workspaces.get(name)
            if workspace is not None:
                workspace.status_text_set(None)
        self._workspaces.clear()
        redraw_sidebars()


def progress_text(run: DenoiseRun) -> str:
    """Say what a run does and how far it is."""
    if run.fraction == 0.0:
        return iface_("{what}: preparing").format(what=run.text)
    text = f"{run.text}: {run.fraction:.0%}"
    left = run.seconds_left
    return (
        text
        if left is None
        else iface_("{progress}, {time} left").format(progress=text, time=time_text(left))
    )


def time_text(seconds: float) -> str:
    """Return a time in words, no more exact than people need it.

    Examples
    --------
    >>> time_text(0.2), time_text(41.7), time_text(130.0)
    ('1 s', '42 s', '2 min')
    """
    seconds = max(1.0, seconds)
    return f"{seconds:.0f} s" if seconds < 90.0 else f"{seconds / 60.0:.0f} min"


def status_text(run: DenoiseRun) -> str:
    """Return the line for the status bar."""
    return iface_("{progress}   |   Esc or Right Click in the View: Cancel").format(
        progress=progress_text(run)
    )


def redraw_sidebars() -> None:
    """Have the sidebars of all 3D Views drawn again."""
    for manager in bpy.data.window_managers:
        for window in manager.windows:
            for area in window.screen.areas:
                if area.type == "VIEW_3D":
                    for region in area.regions:
                        if region.type == "UI":
                            region.tag_redraw()
