# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Adjusting the last operation, in its panel and by F9."""

from blender_window.menus import find_copied
from blender_window.pixels import changed
from blender_window.sidebar import press, type_into


def test_adjusting_the_amount_is_instant(ball):
    ball.run("bpy.context.scene.framelet.amount = 0.875; region('UI').tag_redraw()")
    ball.settle()
    noisy = ball.run("result = digest('Ball')")
    press(ball, "object.framelet_denoise")
    ball.wait_for(f"digest('Ball') != {noisy!r}")
    ball.settle(1.0)
    ball.click(ball.middle("HUD"), seconds=1.0)
    place = find_copied(ball, 0.875, ball.box("HUD"), across=0.7)
    type_into(ball, place, "0")
    # Nothing of the motion is left, and the sidebar has the value too.
    ball.wait_for(f"digest('Ball') == {noisy!r}", patience=5.0)
    assert ball.run("result = bpy.context.scene.framelet.amount") == 0.0


def test_f9_opens_the_settings(ball):
    noisy = ball.run("result = digest('Ball')")
    press(ball, "object.framelet_denoise")
    ball.wait_for(f"digest('Ball') != {noisy!r}")
    ball.settle(1.0)
    ball.move(ball.middle())
    ball.settle(0.5)
    before = ball.part()
    ball.key("F9", 1.0)
    assert ball.until(lambda: changed(before, ball.part()) > 0.02)
    ball.move((5, 5))
    ball.key("ESC")
