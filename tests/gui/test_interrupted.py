# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Whatever happens while a run or a preview is on: no error, no thread that stays, and the mesh as it was."""

import pytest
from blender_window.sidebar import add_ball

NOISY = "result = digest('Ball')"
SETTINGS = """
bpy.context.scene.framelet.preset = "TRI_2"
bpy.context.scene.framelet.iterations = iterations
bpy.context.scene.framelet.output = "IN_PLACE"
"""
MODULE = "bl_ext.user_default.framelet"
IS_OVER = """
import threading
names = [thread.name for thread in threading.enumerate() if thread.name.startswith("framelet")]
hidden = [mesh.name for mesh in bpy.data.meshes if ".framelet_original" in mesh.attributes]
result = not names and not hidden
"""
DELETE = """
with override():
    bpy.ops.object.delete()
"""
MODE = """
with override():
    bpy.ops.object.mode_set(mode="EDIT")
"""
UNDO = """
with override():
    bpy.ops.ed.undo_push(message="Meanwhile")
    bpy.ops.ed.undo()
"""
OTHER_FILE = """
with bpy.context.temp_override(window=window()):
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=False)
"""
DISABLE = f"""
bpy.ops.preferences.addon_disable(module={MODULE!r})
"""
ENABLE = f"""
if {MODULE!r} not in bpy.context.preferences.addons:
    bpy.ops.preferences.addon_enable(module={MODULE!r})
"""
RENDER = """
scene = bpy.context.scene
scene.render.engine, scene.cycles.samples = "CYCLES", 4
scene.render.resolution_x = scene.render.resolution_y = 64
if scene.camera is None:
    scene.camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.collection.objects.link(scene.camera)
bpy.context.preferences.view.render_display_type = "NONE"
with override():
    bpy.ops.render.render("INVOKE_DEFAULT")
"""
IS_RENDERED = "not bpy.app.is_job_running('RENDER')"

EVENTS = {"delete": DELETE, "mode": MODE, "undo": UNDO, "other file": OTHER_FILE, "disable": DISABLE}


def errors(session):
    """Return how many errors Blender has printed."""
    return (session.folder / "blender.log").read_text(errors="replace").count("Traceback")


@pytest.fixture
def noisy(desk):
    """The session with a noisy ball; gives the session and the digest, and enables the extension again."""
    add_ball(desk, 6)
    before = errors(desk)
    yield desk, desk.run(NOISY)
    desk.run(ENABLE)
    assert errors(desk) == before, desk._log()


def begin_run(session, window="window()"):
    """Start a run that takes minutes."""
    session.run(SETTINGS, iterations=10000)
    code = f"with bpy.context.temp_override(window={window}):\n"
    session.run(
        code + "    bpy.ops.object.framelet_denoise('INVOKE_DEFAULT', preset='TRI_2', iterations=10000)"
    )
    session.wait_for("bool(bpy.ops.object.framelet_cancel.poll())")


def begin_preview(session, digest):
    """Turn the preview on, and wait until it shows something."""
    session.run(SETTINGS, iterations=5)
    session.run("with override():\n    bpy.ops.object.framelet_preview('INVOKE_DEFAULT')")
    session.wait_for(f"digest('Ball') != {digest!r}")


def assert_over(session, digest):
    """Nothing goes on any more, and the ball is as it was, if it is there."""
    assert session.until(lambda: session.run(IS_OVER))
    if session.run("result = 'Ball' in bpy.data.objects"):
        session.run("if bpy.context.mode != 'OBJECT':\n    bpy.ops.object.mode_set(mode='OBJECT')")
        assert session.run(NOISY) == digest


@pytest.mark.parametrize("event", EVENTS)
def test_while_it_runs(noisy, event):
    session, digest = noisy
    begin_run(session)
    session.settle(0.5)
    session.run(EVENTS[event])
    assert_over(session, digest)


@pytest.mark.parametrize("event", ["delete", "mode", "other file", "disable"])
def test_while_a_preview_is_on(noisy, event):
    session, digest = noisy
    begin_preview(session, digest)
    session.run(EVENTS[event])
    assert_over(session, digest)


def test_a_render_while_it_runs(noisy):
    session, digest = noisy
    begin_run(session)
    session.run(RENDER)
    session.wait_for(IS_RENDERED)
    assert session.run(NOISY) == digest
    session.run("bpy.ops.object.framelet_cancel()")
    assert_over(session, digest)


def test_a_render_while_a_preview_is_on(noisy):
    session, digest = noisy
    begin_preview(session, digest)
    session.run(RENDER)
    session.wait_for(IS_RENDERED)
    session.run("with override():\n    bpy.ops.object.framelet_preview()")
    assert_over(session, digest)


def test_the_window_of_a_run_closes(noisy):
    session, digest = noisy
    session.run("with override():\n    bpy.ops.wm.window_new()")
    second = "list(bpy.context.window_manager.windows)[-1]"
    session.wait_for("len(bpy.context.window_manager.windows) == 2")
    begin_run(session, second)
    session.run(f"with bpy.context.temp_override(window={second}):\n    bpy.ops.wm.window_close()")
    session.wait_for("len(bpy.context.window_manager.windows) == 1")
    assert_over(session, digest)
    session.run("with override():\n    bpy.ops.object.framelet_denoise(preset='TRI_2')")
    assert session.run(NOISY) != digest


def test_a_preview_is_seen_in_two_windows_and_outlives_the_second(noisy):
    session, digest = noisy
    begin_preview(session, digest)
    session.run("with override():\n    bpy.ops.wm.window_new()")
    session.wait_for("len(bpy.context.window_manager.windows) == 2")
    second = "list(bpy.context.window_manager.windows)[-1]"
    session.run(f"with bpy.context.temp_override(window={second}):\n    bpy.ops.wm.window_close()")
    session.settle(0.5)
    assert session.run(NOISY) != digest
    session.run("with override():\n    bpy.ops.object.framelet_preview()")
    assert_over(session, digest)
