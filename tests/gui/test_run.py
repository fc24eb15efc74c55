# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""A long run: Blender stays alive, Esc and right click cancel, and all stays as it was."""

import time

import pytest
from blender_window.pixels import changed
from blender_window.sidebar import add_ball, find, press

NOISY = "result = digest('Ball')"
IS_RUNNING = "not bpy.ops.object.framelet_denoise.poll() and bpy.ops.object.framelet_cancel.poll()"
HAS_RUN = "bpy.context.window_manager.framelet_report.n_objects"
PROPERTIES = """
area = next(area for area in window().screen.areas if area.type == "PROPERTIES")
result = [area.x, area.y, area.width, area.height]
"""
SETTINGS = """
bpy.context.scene.framelet.preset = "TRI_2"
bpy.context.scene.framelet.iterations = 10000
"""


def is_running(session):
    return session.run(f"with override():\n    result = {IS_RUNNING}")


@pytest.fixture
def long_run(desk):
    """A run that would take minutes, just started by the button; gives the session and the digest before."""
    add_ball(desk, 7)
    desk.run(SETTINGS)
    desk.settle(0.5)
    noisy = desk.run(NOISY)
    press(desk, "object.framelet_denoise", seconds=0.0)
    desk.wait_for("bool(bpy.ops.object.framelet_cancel.poll())")
    desk.move(desk.middle())
    yield desk, noisy
    if is_running(desk):
        desk.key("ESC", 1.0)


def test_elsewhere_esc_and_right_clicks_are_no_matter(long_run):
    session, _ = long_run
    x, y, width, height = session.run(PROPERTIES)
    for button in ("RIGHTMOUSE", "ESC", "ESC"):
        session.click((x + width // 2, y + height // 2), button, seconds=0.5)
        assert is_running(session)
    button = find(session, "object.framelet_cancel", across=0.83)
    session.click(button, "RIGHTMOUSE", seconds=0.5)
    session.key("ESC", 0.5)  # closes the menu of the button
    assert is_running(session)


@pytest.mark.parametrize("button", ["ESC", "RIGHTMOUSE"])
def test_cancel_leaves_the_mesh_bit_for_bit(long_run, button):
    session, noisy = long_run
    session.settle(1.0)
    assert is_running(session)
    session.key(button)
    session.wait_for("not bpy.ops.object.framelet_cancel.poll()", patience=5.0)
    session.settle(1.0)
    assert session.run(NOISY) == noisy
    assert session.run(f"result = {HAS_RUN}") == 0


def test_cancel_button_in_the_sidebar(long_run):
    session, noisy = long_run
    session.click(find(session, "object.framelet_cancel", across=0.83))
    session.wait_for("not bpy.ops.object.framelet_cancel.poll()", patience=5.0)
    assert session.run(NOISY) == noisy


def test_window_is_alive_while_it_runs(long_run):
    session, _ = long_run
    session.settle(0.5)
    view = session.part()
    rotation = "result = list(view3d().spaces.active.region_3d.view_rotation)"
    before = session.run(rotation)
    start = session.run("result = [len(ticks), len(draws)]")
    x, y = session.middle()
    began = time.monotonic()
    session.drag([(x + 12 * step, y + 5 * step) for step in range(12)], "MIDDLEMOUSE")
    seconds = time.monotonic() - began
    end = session.run("result = [len(ticks), len(draws)]")
    assert is_running(session)
    # The viewport followed the mouse, and was drawn meanwhile.
    assert session.run(rotation) != before
    assert session.until(lambda: changed(view, session.part()) > 0.01)
    assert end[1] - start[1] >= 6
    # Blender got around to its timers all the time: no gap is as long as the run.
    gaps = session.run("result = [b - a for a, b in zip(ticks[n:], ticks[n + 1:])]", n=start[0])
    assert len(gaps) >= 20
    assert max(gaps) < max(1.0, 0.5 * seconds)


def test_status_bar_shows_the_progress(long_run):
    session, _ = long_run
    height = int(24 * session.scale)
    running = session.picture()[-height:]
    session.key("ESC", 1.5)
    session.settle(6.0)  # until the message of the cancel is gone
    assert changed(running, session.picture()[-height:]) > 0.01


def test_undo_is_one_step(ball):
    noisy = ball.run(NOISY)
    press(ball, "object.framelet_denoise")
    ball.wait_for(f"digest('Ball') != {noisy!r}")
    ball.settle(0.5)
    clean = ball.run(NOISY)
    ball.move(ball.middle())
    ball.key("Z", 0.5, ctrl=True)
    assert ball.run(NOISY) == noisy
    ball.key("Z", 0.5, ctrl=True, shift=True)
    assert ball.run(NOISY) == clean


def test_button_and_script_give_the_same_bits(ball):
    noisy = ball.run(NOISY)
    press(ball, "object.framelet_denoise")
    ball.wait_for(f"digest('Ball') != {noisy!r}")
    ball.settle(0.5)
    clean = ball.run(NOISY)
    ball.move(ball.middle())
    ball.key("Z", 0.5, ctrl=True)
    ball.run("with override():\n    bpy.ops.object.framelet_denoise(output='MODIFIER')")
    assert ball.run(NOISY) == clean
