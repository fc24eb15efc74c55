# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""A result that stays adjustable, by the mouse: the amount beside the strength, and the way out."""

import pytest
from blender_window.pixels import changed
from blender_window.sidebar import add_ball, find, press, start_fresh, type_into

NOISY = "result = digest('Ball')"
AMOUNT = """
from bpy.app import version
modifier = bpy.data.objects["Ball"].modifiers[0]
socket = next(s for s in modifier.node_group.interface.items_tree if s.name == "Amount").identifier
path = f'modifiers["{modifier.name}"]'
result = f"{path}.properties.inputs.{socket}.value" if version >= (5, 2) else f'{path}["{socket}"]'
"""
SHARE = """
import numpy as np
ball = bpy.data.objects["Ball"]
before = np.empty(3 * len(ball.data.vertices), np.float32)
ball.data.attributes["position"].data.foreach_get("vector", before)
moved = np.empty_like(before)
ball.data.attributes["framelet_displacement"].data.foreach_get("vector", moved)
shown = positions("Ball") - before
result = float(shown @ moved / (moved @ moved))
"""


@pytest.fixture
def denoised(desk):
    """The session with a ball that has the modifier, and the digest of the noisy one."""
    start_fresh(desk, ("output",))
    add_ball(desk)
    noisy = desk.run(NOISY)
    press(desk, "object.framelet_denoise")
    desk.wait_for(f"digest('Ball') != {noisy!r}")
    desk.settle(0.5)
    return desk, noisy


def test_the_amount_answers_at_once(denoised):
    session, _ = denoised
    assert session.run(SHARE) == pytest.approx(1.0, abs=1e-4)
    view = session.part()
    type_into(session, find(session, session.run(AMOUNT)), "0.5")
    assert session.until(lambda: changed(view, session.part()) > 0.01)
    assert session.run(SHARE) == pytest.approx(0.5, abs=1e-3)
    session.move(session.middle())
    session.key("Z", 0.5, ctrl=True)
    assert session.run(SHARE) == pytest.approx(1.0, abs=1e-4), "one undo step"


def test_remove_and_apply_by_their_buttons(denoised):
    session, noisy = denoised
    clean = session.run(NOISY)
    press(session, "object.framelet_apply_modifier", seconds=0.5, across=0.25)
    assert session.run("result = len(bpy.data.objects['Ball'].modifiers)") == 0
    assert session.run(NOISY) == clean
    session.move(session.middle())
    session.key("Z", 0.5, ctrl=True)
    press(session, "object.framelet_remove_modifier", seconds=0.5, across=0.8)
    assert session.run(NOISY) == noisy
