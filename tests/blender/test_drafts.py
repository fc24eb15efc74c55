# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The preview of the default engine shows a draft after one pass, then the result, and how far it is."""

import threading

import bpy
import pytest
from blender_objects import noisy_monkey
from drawing import draw
from framelet.core import PRESETS, DenoiseSettings, denoise
from framelet.operators.mesh_io import mesh_bridge
from framelet.operators.mesh_io.mesh_bridge import read_positions
from framelet.operators.preview import current_preview, preview_session
from framelet.operators.preview.drafts import draft_of
from framelet.ui.panels import run_rows
from run_steps import SECONDS, expected_for, same, settle, turn_on

pytestmark = pytest.mark.usefixtures("no_thread_stays")


@pytest.fixture
def steps(monkeypatch):
    """Let each computation of a preview wait for its turn; gives the settings of those that began."""
    original, begun, turns = preview_session.compute, [], threading.Semaphore(0)
    has_begun = threading.Semaphore(0)

    def gated(job, callback=None, should_stop=None):
        begun.append(job.settings)
        has_begun.release()
        while not turns.acquire(timeout=0.005):
            if should_stop():
                break
        return original(job, callback, should_stop)

    monkeypatch.setattr(preview_session, "compute", gated)
    yield begun, turns, has_begun
    for _ in range(20):
        turns.release()


@pytest.mark.parametrize("preset", list(PRESETS))
def test_a_draft_is_one_pass_of_what_takes_more(preset):
    settings = PRESETS[preset].settings
    draft = draft_of(settings)
    assert (draft is None) == (settings.method != "AUTO")
    if draft is not None:
        assert draft == settings.with_changes(passes=1)
        assert draft_of(draft) is None  # that takes one pass itself


def test_the_draft_comes_first_and_is_no_result(settings, steps):
    begun, turns, has_begun = steps
    obj = noisy_monkey()
    surface = mesh_bridge.read_surface(obj)
    settings.preset = "AUTO"
    session = turn_on()
    assert has_begun.acquire(timeout=SECONDS) and begun == [DenoiseSettings(passes=1)]
    turns.release()
    assert has_begun.acquire(timeout=SECONDS)  # the draft is done, and the result begins
    current_preview.tick_preview()
    assert same(read_positions(obj.data), denoise(surface, begun[0]).vertices)
    assert not session.is_current and not bpy.ops.object.framelet_apply_preview.poll()
    assert session.fraction == pytest.approx(1 / 3)
    turns.release()
    settle(session)
    assert session.is_current and same(read_positions(obj.data), expected_for(surface, settings))
    assert begun[1:] == [DenoiseSettings()]


def test_a_bar_takes_the_place_of_apply(settings, steps):
    _, turns, has_begun = steps
    noisy_monkey("Bust")
    settings.preset = "AUTO"
    session = turn_on()
    assert has_begun.acquire(timeout=SECONDS)

    def rows():
        return draw(lambda drawn, context: run_rows.draw_preview(drawn.layout, context))

    assert rows()["operator"] == ["object.framelet_preview"] and rows()["progress"] == ["0%"]
    for _ in range(2):
        turns.release()
    settle(session)
    assert rows()["operator"] == ["object.framelet_preview", "object.framelet_apply_preview"]
    assert not rows()["progress"]
    assert session.name == "Bust" and session.fraction == 1.0


def test_the_sidebar_is_drawn_again_as_the_work_goes_on(settings, steps, monkeypatch):
    _, _, has_begun = steps
    noisy_monkey()
    settings.preset = "AUTO"
    session = turn_on()
    assert has_begun.acquire(timeout=SECONDS)
    current_preview.tick_preview()
    drawn = []
    monkeypatch.setattr(current_preview, "redraw_sidebars", lambda: drawn.append(session.fraction))
    current_preview.tick_preview()
    assert drawn == []
    session.fraction = 0.5
    current_preview.tick_preview()
    current_preview.tick_preview()
    assert drawn == [0.5]
