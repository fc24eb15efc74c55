# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""The live preview: the mesh follows while λ is dragged; off or Esc brings back the original, bit for bit."""

import pytest
from blender_window.pixels import changed
from blender_window.sidebar import add_ball, find, press

NOISY = "result = digest('Ball')"
TOGGLE = "object.framelet_preview"


@pytest.fixture
def preview(desk):
    """The session with a preview of a ball that is on; gives the session and the digest of the original."""
    desk.run("bpy.context.scene.framelet.preset = 'TRI_2'")
    add_ball(desk)
    noisy = desk.run(NOISY)
    press(desk, TOGGLE)
    desk.wait_for(f"digest('Ball') != {noisy!r}")
    yield desk, noisy
    if desk.run(NOISY) != noisy:
        desk.key("ESC", 1.0)


def drag_lambda(session):
    """Drag λ to the right in steps; return the digests of the mesh that were seen meanwhile."""
    x, y = find(session, "framelet.lambda_", across=0.62)
    seen = []

    def look():
        session.settle(0.3)
        seen.append(session.run(NOISY))

    session.drag([(x + 6 * step, y) for step in range(10)], meanwhile=look)
    session.settle(1.0)
    return seen


def test_mesh_follows_and_comes_back(preview):
    session, noisy = preview
    view, value = session.part(), session.run("result = bpy.context.scene.framelet.lambda_")
    seen = drag_lambda(session)
    assert session.run("result = bpy.context.scene.framelet.lambda_") > value
    assert len(set(seen)) >= 3
    assert session.until(lambda: changed(view, session.part()) > 0.002)
    # While it is on the button that keeps the result stands at its right.
    session.click(find(session, TOGGLE, across=0.25))
    session.wait_for(f"digest('Ball') == {noisy!r}")


def test_escape_brings_back_the_original(preview):
    session, noisy = preview
    session.move(session.middle())
    session.key("ESC", 0.5)
    session.wait_for(f"digest('Ball') == {noisy!r}")


def test_kept_preview_is_what_the_button_gives(preview):
    session, noisy = preview
    # While it computes a bar stands in the place of the button.
    session.wait_for("bpy.ops.object.framelet_apply_preview.poll()")
    press(session, "object.framelet_apply_preview", seconds=1.0, across=0.75)
    kept = session.run(NOISY)
    assert kept != noisy
    session.move(session.middle())
    session.key("Z", 0.5, ctrl=True)
    assert session.run(NOISY) == noisy
    press(session, "object.framelet_denoise")
    session.wait_for(f"digest('Ball') == {kept!r}")
