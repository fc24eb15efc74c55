# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Where else people look: menus, search, right click."""

import pytest
from blender_window.menus import find_entry

CALL = """
with override():
    bpy.ops.wm.call_menu(name=name)
"""

EDIT = """
with override():
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
"""

NOISY = "result = digest('Ball')"
LEAVE = """
with override():
    bpy.ops.object.mode_set(mode="OBJECT")
"""


def use_entry(session, place):
    """Click the entry Denoise of the open menu, which has the place in it, and wait for the mesh to change."""
    before = session.run(NOISY)
    session.settle(0.5)
    entry = find_entry(session, "object.framelet_denoise", place[0] + 20, session.size[1] - 10, 10)
    session.click(entry)
    return before


@pytest.mark.parametrize("name", ["VIEW3D_MT_object"])
def test_menu_of_object_mode(ball, name):
    ball.move(ball.middle())
    ball.run(CALL, name=name)
    before = use_entry(ball, ball.middle())
    ball.wait_for(f"digest('Ball') != {before!r}")


def test_menu_of_edit_mode(ball):
    ball.run(EDIT)
    ball.move(ball.middle())
    ball.run(CALL, name="VIEW3D_MT_edit_mesh_clean")
    before = use_entry(ball, ball.middle())
    ball.settle(3.0)
    ball.run(LEAVE)
    ball.wait_for(f"digest('Ball') != {before!r}")


def test_right_click(ball):
    place = ball.middle()
    ball.click(place, "RIGHTMOUSE")
    before = use_entry(ball, place)
    ball.wait_for(f"digest('Ball') != {before!r}")


def test_search(ball):
    before = ball.run(NOISY)
    ball.move(ball.middle())
    ball.key("F3", 1.0)
    ball.type_text("denoise")
    ball.settle(1.0)
    ball.key("RET", 1.0)
    ball.wait_for(f"digest('Ball') != {before!r}")
