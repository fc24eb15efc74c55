# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Finds entries of an open menu, by moving the mouse over it and copying what is below with Ctrl C."""

from __future__ import annotations

import numpy as np

from .pixels import changed_box
from .session import BlenderFailed, Session

STEP = 9
"""Pixels between two places that are looked at; an entry is 20 pixels high."""


def entry_under_mouse(session: Session) -> str:
    """Return the operator of the entry that the mouse is over, as in `object.framelet_denoise`; empty if none."""
    session.run("bpy.context.window_manager.clipboard = ''")
    session.key("C", 0.0, ctrl=True)
    copied = session.run("result = bpy.context.window_manager.clipboard")
    return copied.partition("(")[0].removeprefix("bpy.ops.") if copied.startswith("bpy.ops.") else ""


def find_entry(session: Session, name: str, before: np.ndarray) -> tuple[int, int]:
    """Return the place of an entry of the open menu, looked for from its top.

    Parameters
    ----------
    session : Session
        Where a menu is open.
    name : str
        As in `object.framelet_denoise`.
    before : ndarray, shape (height, width, 3)
        What was on the screen before the menu was opened: the menu is where that has changed.

    Raises
    ------
    BlenderFailed
        If it is not there.
    """
    left, bottom, width, height = changed_box(before, session.picture())
    seen = []
    for y in range(bottom + height, bottom, -int(STEP * session.scale)):
        session.move((left + width // 2, y))
        found = entry_under_mouse(session)
        if found == name:
            return left + width // 2, y
        if found and found not in seen:
            seen.append(found)
    raise BlenderFailed(f"{name} is not in the menu, which has {', '.join(seen)}.")
