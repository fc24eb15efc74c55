# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Finds entries of an open menu, by moving the mouse over it and copying what is below with Ctrl C."""

from __future__ import annotations

import numpy as np

from .pixels import changed_box
from .session import BlenderFailed, Session

STEP = 9
"""Pixels between two places that are looked at; an entry is 20 pixels high."""


SWEEP = """
def sweep_menu(left, heights, name):
    seen = []
    for height in heights:
        bpy.context.window_manager.clipboard = ""
        simulate("MOUSEMOVE", "NOTHING", (left, height))
        yield
        yield
        simulate("C", "PRESS", (left, height), ctrl=True)
        yield
        simulate("C", "RELEASE", (left, height), ctrl=True)
        yield
        copied = bpy.context.window_manager.clipboard
        found = copied.partition("(")[0].removeprefix("bpy.ops.") if copied.startswith("bpy.ops.") else ""
        if found == name:
            return height, seen
        if found and found not in seen:
            seen.append(found)
    return None, seen

result = sweep_menu(left, heights, name)
"""


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
    heights = list(range(bottom + height, bottom, -int(STEP * session.scale)))
    place = left + width // 2
    found, seen = session.run(SWEEP, left=place, heights=heights, name=name)
    if found is None:
        raise BlenderFailed(f"{name} is not in the menu, which has {', '.join(seen)}.")
    return place, found
