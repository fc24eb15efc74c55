# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Finds and uses the buttons of the sidebar, by moving the mouse over it and asking what is below."""

from __future__ import annotations

from .code import BALL, EMPTY, RESET
from .pixels import changed
from .session import BlenderFailed, Session

SWEEP = """
def under_mouse(kind):
    with override(kind):
        prop = bpy.context.property
        if prop is not None:
            return prop[1]
        if bpy.ops.ui.copy_python_command_button.poll():
            bpy.context.window_manager.clipboard = ""
            bpy.ops.ui.copy_python_command_button()
            return bpy.context.window_manager.clipboard.partition("(")[0].removeprefix("bpy.ops.")
    return ""

def sweep(kind, left, heights, name):
    seen = []
    for height in heights:
        simulate("MOUSEMOVE", "NOTHING", (left, height))
        yield
        yield
        found = under_mouse(kind)
        if found == name:
            # Not an answer that came too late.
            yield
            yield
            if under_mouse(kind) == name:
                return height, seen
        if found and found not in seen:
            seen.append(found)
    return None, seen

result = sweep(kind, left, heights, name)
"""
"""Finds `object.framelet...`, a button that runs an operator, or `framelet.preset`, a property."""

OPEN = """
view3d().spaces.active.show_region_ui = True
"""

CHOOSE = """
region("UI").active_panel_category = "Framelet"
region("UI").tag_redraw()
"""

STEP = 9
"""Pixels between two places that are looked at; a button is 20 pixels high."""

SCROLL = 8
"""Steps of the mouse wheel to what is further down."""


def start_fresh(session: Session, unfolded: tuple[str, ...] = ()) -> None:
    """Load Blender's startup file without its objects, and open the sidebar at our tab.

    Parameters
    ----------
    session : Session
        Whose Blender it is.
    unfolded : tuple of str
        Subpanels to unfold, as in `bands`.
    """
    session.run(RESET, unfolded=[f"VIEW3D_PT_framelet_{name}" for name in unfolded])
    session.settle(0.5)
    session.run(EMPTY)
    open_sidebar(session)
    session.move(session.middle())


def add_ball(session: Session, subdivisions: int = 5) -> None:
    """Add a noisy ball of 10 * 4**(subdivisions - 1) + 2 vertices, named Ball, and look at it."""
    session.run(BALL, subdivisions=subdivisions)
    session.settle(0.5)


def open_sidebar(session: Session) -> None:
    """Open the sidebar and choose the tab Framelet."""
    session.run(OPEN)
    # A tab can be chosen once the sidebar was drawn.
    session.settle(0.5)
    session.run(CHOOSE)
    session.settle(0.5)


def find(session: Session, name: str, kind: str = "UI", across: float = 0.6) -> tuple[int, int]:
    """Return the place of the button of an operator or property, for which the sidebar is scrolled down.

    Parameters
    ----------
    session : Session
        Whose sidebar is open.
    name : str
        As in `object.framelet_denoise` or `framelet.preset`.
    kind : str
        The region: UI, the sidebar, or HUD, where the last operation is adjusted.
    across : float
        Where to look, from the left (0) to the right (1) of the sidebar.

    Raises
    ------
    BlenderFailed
        If it is not there.
    """
    x, y, width, height = session.box(kind)
    step = int(STEP * session.scale)
    left = x + int(across * width)
    heights = list(range(y + height - step, y, -step))
    seen: list[str] = []
    while True:
        found, names = session.run(SWEEP, kind=kind, left=left, heights=heights, name=name)
        if found is not None:
            # Towards the middle of the button, whose upper edge this is.
            return left, found - step // 3
        seen += [other for other in names if other not in seen]
        before = session.part(kind)
        session.events(*[("WHEELDOWNMOUSE", "PRESS", (left, y + height // 2), {})] * SCROLL)
        session.settle(0.5)
        if changed(before, session.part(kind)) < 0.01:
            raise BlenderFailed(f"{name} is not in the region {kind}, which has {', '.join(seen)}.")


def press(session: Session, name: str, seconds: float = 0.3, across: float = 0.6) -> None:
    """Click the button of an operator or property."""
    session.click(find(session, name, across=across), seconds=seconds)


def type_into(session: Session, place: tuple[int, int], text: str) -> None:
    """Click a number and type another one."""
    session.click(place)
    session.key("A", ctrl=True)
    session.type_text(text)
    session.key("RET", 0.5)
