# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Finds entries of an open menu, by moving the mouse over it and copying what is below with Ctrl C."""

from __future__ import annotations

import numpy as np

from .pixels import changed_box
from .session import BlenderFailed, Session

STEP = 9
"""Pixels between two places that are looked at; an entry is 20 pixels high."""

SMALLEST = 40
"""Pixels that a menu is wide and high, at least."""

ROUNDS = 30
"""How often the screen is looked at until a menu must be there."""


SWEEP = """
def as_number(text):
    try:
        return float(text)
    except ValueError:
        return None

def sweep_copies(left, heights, wanted):
    seen, places = [], []
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
        found = copied.partition("(")[0].removeprefix("bpy.ops.") if copied.startswith("bpy.ops.") else copied
        number = as_number(found)
        if found == wanted or (number is not None and wanted == round(number, 4)):
            places.append(height)
            continue
        if places:
            break
        if found and found not in seen:
            seen.append(found)
    # The first entry is active before the mouse is over it, the last one still when the mouse is below it.
    return (places[-2:] or [None])[0], seen

result = sweep_copies(left, heights, wanted)
"""


def find_copied(
    session: Session, wanted: str | float, box: tuple[int, int, int, int], across: float = 0.5
) -> tuple[int, int]:
    """Return the place of an entry or a field of what is open in a box, looked for from its top.

    Parameters
    ----------
    session : Session
        Where a menu or another panel is open.
    wanted : str or float
        An operator, as in `object.framelet_denoise`, or the value of a field.
    box : (int, int, int, int)
        Left, bottom, width and height in pixels.
    across : float
        Where to look, from the left (0) to the right (1).

    Raises
    ------
    BlenderFailed
        If it is not there.
    """
    left, bottom, width, height = box
    place = left + int(across * width)
    step = int(STEP * session.scale)
    inside = range(bottom + height - 3, bottom, -step)
    found, seen = session.run(SWEEP, left=place, heights=list(inside), wanted=wanted)
    if found is None:
        # Over a bar as dark as the menu its last entry changes nothing that is seen.
        below = range(max(bottom - 1, 1), max(bottom - 3 * step, 0), -step)
        found, _ = session.run(SWEEP, left=place, heights=list(below), wanted=wanted)
    if found is None:
        raise BlenderFailed(f"{wanted} is not in the box, which has {', '.join(seen)}.")
    return place, found


def find_entry(session: Session, name: str, before: np.ndarray, across: float = 0.5) -> tuple[int, int]:
    """Return the place of an entry of the menu that was opened since a picture of the screen was taken."""
    return find_copied(session, name, opened_box(session, before), across)


def opened_box(session: Session, before: np.ndarray) -> tuple[int, int, int, int]:
    """Wait until something has been opened and drawn since a picture was taken, and return its box."""
    last = (0, 0, 0, 0)
    for _ in range(ROUNDS):
        session.settle(0.3)
        box = changed_box(before, session.picture())
        if box == last and min(box[2:]) > SMALLEST * session.scale:
            return box
        last = box
    raise BlenderFailed(f"Nothing was opened on the screen; what has changed is {last}.")
