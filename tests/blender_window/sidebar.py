# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Finds and uses the buttons of the sidebar, by moving the mouse over it and asking what is below."""

from __future__ import annotations

from .session import BlenderFailed, Session

UNDER_MOUSE = """
result = ""
with override("UI"):
    prop = bpy.context.property
    if prop is not None:
        result = prop[1]
    elif bpy.ops.ui.copy_python_command_button.poll():
        bpy.context.window_manager.clipboard = ""
        bpy.ops.ui.copy_python_command_button()
        result = bpy.context.window_manager.clipboard.partition("(")[0]
"""
"""Gives `object.framelet...` of a button that runs an operator and the path of a property, as in `framelet.preset`."""

OPEN = """
view3d().spaces.active.show_region_ui = True
"""

CHOOSE = """
region("UI").active_panel_category = "Framelet"
region("UI").tag_redraw()
"""

STEP = 9
"""Pixels between two places that are looked at; a button is 20 pixels high."""


def open_sidebar(session: Session) -> None:
    """Open the sidebar and choose the tab Framelet."""
    session.run(OPEN)
    # A tab can be chosen once the sidebar was drawn.
    session.settle(0.5)
    session.run(CHOOSE)
    session.settle(0.5)


def under_mouse(session: Session) -> str:
    """Return which operator or property the mouse is over; empty if none."""
    return session.run(UNDER_MOUSE).removeprefix("bpy.ops.")


def find(session: Session, name: str, across: float = 0.6) -> tuple[int, int]:
    """Return the place of the button of an operator or property, looked for from the top.

    Parameters
    ----------
    session : Session
        Whose sidebar is open.
    name : str
        As in `object.framelet_denoise` or `framelet.preset`.
    across : float
        Where to look, from the left (0) to the right (1) of the sidebar.

    Raises
    ------
    BlenderFailed
        If it is not there.
    """
    x, y, width, height = session.box("UI")
    step = int(STEP * session.scale)
    seen = []
    left = x + int(across * width)
    for bottom in range(y + height - step, y, -step):
        session.move((left, bottom))
        found = under_mouse(session)
        if found == name:
            # Into the middle of the button, whose upper edge this is.
            return left, bottom - step // 3
        if found and found not in seen:
            seen.append(found)
    raise BlenderFailed(f"{name} is not in the sidebar, which has {', '.join(seen)}.")


def press(session: Session, name: str, seconds: float = 0.3) -> None:
    """Click the button of an operator or property."""
    session.click(find(session, name), seconds=seconds)
