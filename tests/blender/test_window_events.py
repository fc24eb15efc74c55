# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which events end a run, told by made-up windows; and that a run waits until meshes are not read."""

from types import SimpleNamespace

import bpy
import pytest
from blender_objects import noisy_monkey, read
from framelet.operators import window_events
from framelet.operators.denoise import OBJECT_OT_framelet_denoise as Denoise
from run_steps import SECONDS, start

VIEW, PROPERTIES = (0, 100, 800, 600), (800, 100, 200, 600)
SIDEBAR, HEADER = (600, 100, 200, 570), (0, 670, 800, 30)


def part(kind, place, *regions):
    x, y, width, height = place
    return SimpleNamespace(type=kind, x=x, y=y, width=width, height=height, regions=regions)


def window(*areas, playing=False):
    screen = SimpleNamespace(areas=areas, is_animation_playing=playing)
    return SimpleNamespace(window=SimpleNamespace(screen=screen))


FULL = (
    part("VIEW_3D", VIEW, part("WINDOW", VIEW), part("UI", SIDEBAR), part("HEADER", HEADER)),
    part("PROPERTIES", PROPERTIES, part("WINDOW", PROPERTIES)),
)


def event(kind, place=(300, 300), value="PRESS"):
    return SimpleNamespace(type=kind, value=value, mouse_x=place[0], mouse_y=place[1])


@pytest.mark.parametrize(
    ("kind", "place", "expected"),
    [
        ("ESC", (300, 300), True),
        ("RIGHTMOUSE", (300, 300), True),
        ("ESC", (900, 300), False),
        ("RIGHTMOUSE", (900, 300), False),
        ("ESC", (700, 300), True),
        ("RIGHTMOUSE", (700, 300), False),
        ("RIGHTMOUSE", (300, 680), False),
        ("RIGHTMOUSE", (300, 50), False),
        ("LEFTMOUSE", (300, 300), False),
        ("TIMER", (300, 300), False),
    ],
)
def test_esc_and_right_clicks_count_in_the_view(kind, place, expected):
    assert window_events.cancels(window(*FULL), event(kind, place)) == expected
    assert not window_events.cancels(window(*FULL), event(kind, place, "RELEASE"))


def test_esc_ends_an_animation_first_and_counts_where_there_is_no_view():
    assert not window_events.cancels(window(*FULL, playing=True), event("ESC"))
    assert window_events.cancels(window(*FULL, playing=True), event("RIGHTMOUSE"))
    assert window_events.cancels(window(FULL[1]), event("ESC", (900, 300)))
    assert not window_events.cancels(window(FULL[1]), event("RIGHTMOUSE", (900, 300)))


class Modal:
    """What the modal operator keeps, without Blender's window."""

    def __init__(self, run):
        self._run, self.ended = run, False
        self._display = SimpleNamespace(update=lambda _context: None)

    def _end(self, _context):
        self.ended = True

    def _finish(self, _context):
        self._run.finish()
        return {"FINISHED"}


@pytest.mark.usefixtures("no_thread_stays")
def test_a_run_is_written_once_blender_has_rendered(monkeypatch):
    obj = noisy_monkey()
    before = read(obj).tobytes()
    modal = Modal(start(obj))
    assert modal._run.wait(SECONDS)
    jobs = {"RENDER"}
    monkeypatch.setattr(window_events, "is_job_running", lambda name: name in jobs)
    context = window(*FULL)
    for _ in range(3):
        assert Denoise.modal(modal, context, event("TIMER")) == {"PASS_THROUGH"}
    assert read(obj).tobytes() == before and not modal.ended
    jobs.clear()
    assert Denoise.modal(modal, context, event("TIMER")) == {"FINISHED"}
    assert read(obj).tobytes() != before and modal.ended


@pytest.mark.usefixtures("no_thread_stays")
def test_a_click_elsewhere_does_not_cancel(gate):
    modal = Modal(start(noisy_monkey()))
    assert Denoise.modal(modal, window(*FULL), event("RIGHTMOUSE", (900, 300))) == {"PASS_THROUGH"}
    assert Denoise.modal(modal, window(*FULL), event("ESC", (900, 300))) == {"PASS_THROUGH"}
    assert modal._run.is_active
    modal.report = lambda *_: None
    modal._finish = lambda _context: {"CANCELLED"}
    assert Denoise.modal(modal, window(*FULL), event("ESC")) == {"CANCELLED"}
    assert not modal._run.is_active


def test_blender_knows_the_jobs():
    for name in window_events.READERS:
        assert bpy.app.is_job_running(name) is False
