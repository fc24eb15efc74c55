# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Several objects at once in Edit Mode, and presets of the user's own."""

from blender_window.menus import find_entry
from blender_window.pixels import changed
from blender_window.sidebar import press

TWO = """
for name, place in (("One", -1.5), ("Two", 1.5)):
    add_ball(name, 4, (place, 0.0, 0.0), 0.1 if name == "One" else 0.3)
with override():
    for name in ("One", "Two"):
        bpy.data.objects[name].select_set(True)
    bpy.ops.view3d.view_selected()
result = [digest("One"), digest("Two")]
"""
ENTER = """
with override():
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
remember("Made")
"""
LEAVE = """
with override():
    bpy.ops.object.mode_set(mode="OBJECT")
result = [digest("One"), digest("Two")]
"""
SAVED = """
import os
folder = bpy.utils.user_resource("SCRIPTS", path="presets/framelet")
result = os.listdir(folder) if os.path.isdir(folder) else []
"""


def test_edit_mode_of_two_meshes(desk):
    noisy = desk.run(TWO)
    desk.run(ENTER)
    desk.settle(0.5)
    view = desk.part()
    press(desk, "object.framelet_denoise")
    desk.wait_for("report()[0] == 2")
    desk.settle(0.5)
    assert desk.until(lambda: changed(view, desk.part()) > 0.01)
    estimates = "bpy.context.window_manager.framelet_estimate.objects"
    small, large = desk.run(f"result = [{estimates}[name].sigma_edges for name in ('One', 'Two')]")
    assert small < 0.15 < 0.2 < large
    clean = desk.run(LEAVE)
    assert clean[0] != noisy[0]
    assert clean[1] != noisy[1]


def test_presets_of_ones_own(ball):
    assert ball.run(SAVED) == []
    x, y, width, height = ball.box("UI")
    before = ball.still_picture()
    # The button in the panel's header, left of the grip.
    ball.click((x + int(0.767 * width), y + height - int(16 * ball.scale)), seconds=0.7)
    opened = ball.picture()
    assert changed(before, opened) > 0.005
    ball.click(find_entry(ball, "object.framelet_preset_add", before, across=0.91), seconds=0.7)
    # It asks for a name; Enter accepts the one that it offers.
    ball.key("RET", 0.7)
    assert len(ball.run(SAVED)) == 1
