# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""The tab in the sidebar, and the button Denoise."""

import time

import pytest
from blender_window.pixels import changed
from blender_window.sidebar import find, press

OTHER_TAB = """
region("UI").active_panel_category = "View"
region("UI").tag_redraw()
"""


def test_extension_is_the_installed_one(desk):
    modules = desk.run(
        "result = [name for name in bpy.context.preferences.addons.keys() if 'framelet' in name]"
    )
    assert modules == ["bl_ext.user_default.framelet"]


def test_tab_is_there(desk):
    assert desk.run("result = region('UI').active_panel_category") == "Framelet"
    ours = desk.part("UI")
    assert find(desk, "object.framelet_denoise")
    desk.run(OTHER_TAB)
    desk.settle()
    assert changed(ours, desk.part("UI")) > 0.05


@pytest.mark.parametrize("preset", ["AUTO", "TRI_2"])
def test_blender_rests_while_the_tab_is_open(ball, preset):
    ball.run("bpy.context.scene.framelet.preset = preset", preset=preset)
    ball.settle(1.0)
    before = ball.run("result = [len(ticks), len(draws)]")
    time.sleep(2.0)
    after = ball.run("result = [len(ticks), len(draws)]")
    assert after[0] > before[0]
    assert after[1] - before[1] <= 1


def test_denoise_changes_the_mesh_and_undo_brings_it_back(ball):
    noisy, view = ball.run("result = digest('Ball')"), ball.part()
    press(ball, "object.framelet_denoise")
    ball.wait_for(f"digest('Ball') != {noisy!r}")
    ball.settle()
    assert ball.until(lambda: changed(view, ball.part()) > 0.01)
    report = ball.run("r = bpy.context.window_manager.framelet_report\nresult = [r.n_moved, r.n_objects]")
    assert report == [2562, 1]
    ball.move(ball.middle())
    ball.key("Z", ctrl=True)
    assert ball.run("result = digest('Ball')") == noisy
    ball.settle()
    assert ball.until(lambda: changed(view, ball.part()) < 0.002)


def test_without_a_mesh_the_button_does_nothing(desk):
    place = find(desk, "object.framelet_denoise")
    gray = desk.part("UI")
    desk.click(place)
    assert desk.run("result = bpy.context.window_manager.framelet_report.n_objects") == 0
    desk.run("add_ball('Ball', 3)")
    desk.move(desk.middle())
    desk.settle()
    assert changed(gray, desk.part("UI"), 40) > 0.001
