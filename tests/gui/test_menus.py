# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Where else people look: menus, search, right click."""

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


def use_entry(session, before):
    """Click the entry Denoise of the menu that was opened since a picture was taken."""
    session.settle(0.5)
    session.click(find_entry(session, "object.framelet_denoise", before))


def test_own_menu(ball):
    noisy, before = ball.run(NOISY), ball.still_picture()
    ball.run(CALL, name="VIEW3D_MT_framelet")
    use_entry(ball, before)
    ball.wait_for(f"digest('Ball') != {noisy!r}")


def test_menu_of_edit_mode(ball):
    noisy = ball.run(NOISY)
    ball.run(EDIT)
    ball.settle()
    before = ball.still_picture()
    ball.run(CALL, name="VIEW3D_MT_edit_mesh_clean")
    use_entry(ball, before)
    ball.wait_for("bpy.context.window_manager.framelet_report.n_moved == 2562")
    ball.run(LEAVE)
    assert ball.run(NOISY) != noisy


def test_right_click(ball):
    noisy, before = ball.run(NOISY), ball.still_picture()
    ball.click(ball.middle(), "RIGHTMOUSE")
    use_entry(ball, before)
    ball.wait_for(f"digest('Ball') != {noisy!r}")


def test_search(ball):
    before = ball.run(NOISY)
    ball.move(ball.middle())
    ball.key("F3", 1.0)
    ball.type_text("denoise")
    ball.settle(1.0)
    ball.key("RET", 1.0)
    ball.wait_for(f"digest('Ball') != {before!r}")
