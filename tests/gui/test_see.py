# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""The heat map with its legend, and before and after."""

import pytest
from blender_window.pixels import changed, saturated
from blender_window.sidebar import add_ball, find, press, start_fresh

NOISY = "result = digest('Ball')"
OVERLAYS = "view3d().spaces.active.overlay.show_overlays = shown\nview3d().tag_redraw()"
ONLY_OURS = """
space = view3d().spaces.active
space.show_gizmo = False
for name in ("show_axis_x", "show_axis_y", "show_floor", "show_ortho_grid", "show_text", "show_cursor"):
    setattr(space.overlay, name, False)
"""
"""Hides all colors of the viewport but those of the mesh and the legend."""
AWAY = "view3d().spaces.active.region_3d.view_location.x += 1e4"
"""Looks elsewhere: the legend stays as long as the mesh is not hidden."""


@pytest.fixture
def denoised(desk):
    """The session with a denoised ball and the subpanel See It unfolded."""
    start_fresh(desk, ("see",))
    add_ball(desk)
    desk.run(ONLY_OURS)
    noisy = desk.run(NOISY)
    press(desk, "object.framelet_denoise")
    desk.wait_for(f"digest('Ball') != {noisy!r}")
    desk.settle(0.5)
    return desk


def test_heat_map_colors_the_mesh_and_draws_a_legend(denoised):
    plain = denoised.part()
    press(denoised, "object.framelet_heat_map", seconds=1.0, across=0.25)
    denoised.move((5, 5))
    denoised.settle(0.5)
    assert denoised.until(lambda: saturated(denoised.part()) > saturated(plain) + 0.05)
    with_both = denoised.part()
    denoised.run(OVERLAYS, shown=False)
    denoised.settle(0.5)
    assert denoised.until(lambda: changed(with_both, denoised.part()) > 0.003)
    # Without the mesh only the legend is left.
    denoised.run(AWAY)
    denoised.settle(0.5)
    assert denoised.until(lambda: saturated(denoised.part()) == 0.0)
    denoised.run(OVERLAYS, shown=True)
    denoised.settle(0.5)
    assert denoised.until(lambda: 0.0005 < saturated(denoised.part()) < 0.05)


def test_heat_map_goes_away(denoised):
    plain = denoised.part()
    press(denoised, "object.framelet_heat_map", seconds=1.0, across=0.25)
    assert denoised.until(lambda: saturated(denoised.part()) > saturated(plain) + 0.05)
    press(denoised, "object.framelet_hide_colors", seconds=1.0, across=0.25)
    denoised.move((5, 5))
    denoised.settle(0.5)
    # The panel of the last operation has gone too, so that pixels are not compared one by one.
    assert denoised.until(lambda: saturated(denoised.part()) < saturated(plain) + 0.01)


def test_before_and_after_in_turn(denoised):
    clean, view = denoised.run(NOISY), denoised.part()
    before, after = (find(denoised, "object.framelet_before_after", across=at) for at in (0.25, 0.75))
    denoised.click(before, seconds=1.0)
    assert denoised.run(NOISY) != clean
    assert denoised.until(lambda: changed(view, denoised.part()) > 0.01)
    denoised.click(before, seconds=1.0)
    assert denoised.run(NOISY) != clean
    denoised.click(after, seconds=1.0)
    assert denoised.run(NOISY) == clean
