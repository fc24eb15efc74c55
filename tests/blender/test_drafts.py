# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The preview of the default engine shows a draft after one pass, then the result, and how far it is."""

import threading

import bpy
import numpy as np
import pytest
from blender_objects import noisy_monkey
from drawing import draw
from framelet.core import PRESETS, DenoiseSettings, denoise
from framelet.operators.mesh_io import mesh_bridge
from framelet.operators.mesh_io.mesh_bridge import read_positions
from framelet.operators.preview import current_preview, outcomes
from framelet.operators.preview.drafts import draft_of
from framelet.operators.preview.known_results import FARTHEST, KnownResults
from framelet.operators.run import denoise_job, denoise_run
from framelet.operators.run.denoise_run import State
from framelet.ui.panels import run_rows
from run_steps import SECONDS, expected_for, same, settle, start, turn_on, until_done

pytestmark = pytest.mark.usefixtures("no_thread_stays")


@pytest.fixture
def steps(monkeypatch):
    """Let each computation of a preview wait for its turn; gives the settings of those that began."""
    original, begun, turns = outcomes.compute, [], threading.Semaphore(0)
    has_begun = threading.Semaphore(0)

    def gated(job, callback=None, should_stop=None):
        begun.append(job.settings)
        has_begun.release()
        while not turns.acquire(timeout=0.005):
            if should_stop():
                break
        return original(job, callback, should_stop)

    monkeypatch.setattr(outcomes, "compute", gated)
    yield begun, turns, has_begun
    for _ in range(20):
        turns.release()


def test_what_lies_between_known_results():
    one, auto = np.ones((4, 3), np.float32), DenoiseSettings()
    known = KnownResults(0 * one)
    assert known.between(auto) is None and known.farthest(auto) is None
    known.add(auto, 2 * one)
    assert (known.between(auto.with_changes(strength=0.5)) == 1).all()
    assert (known.between(auto.with_changes(strength=0.0)) == 0).all()
    assert (known.between(auto) == 2).all()
    assert known.between(auto.with_changes(strength=1.1)) is None  # nothing is known that is as strong
    assert (known.between(auto.with_changes(threads=3)) == 2).all()
    known.add(known.farthest(auto), 4 * one)
    assert (known.between(auto.with_changes(strength=1.5)) == 3).all() and known.farthest(auto) is None
    known.add(auto.with_changes(strength=1.4), 2 * one)
    assert (known.between(auto.with_changes(strength=1.2)) == 2).all()
    assert known.between(auto.with_changes(passes=3)) is None
    known.add(auto.with_changes(passes=3), 9 * one)
    assert known.between(auto) is None
    quick = PRESETS["TRI_2"].settings
    known.add(quick, one)
    assert known.between(quick) is None  # its result is there as soon
    assert (known.between(auto.with_changes(passes=3)) == 9).all()


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
    assert begun[1] == DenoiseSettings()


def test_a_bar_takes_the_place_of_apply(settings, steps):
    _, turns, has_begun = steps
    noisy_monkey("Bust")
    settings.preset = "AUTO"
    session = turn_on()
    assert has_begun.acquire(timeout=SECONDS)

    def rows():
        return draw(lambda drawn, _context: run_rows.draw_run(drawn.layout))

    assert rows()["operator"] == ["object.framelet_preview"] and rows()["progress"] == ["0%"]
    for _ in range(2):
        turns.release()
    settle(session)
    assert rows()["operator"] == ["object.framelet_preview", "object.framelet_apply_preview"]
    assert not rows()["progress"]
    assert session.name == "Bust" and session.fraction == 1.0


def test_the_sidebar_is_drawn_again_as_the_work_goes_on(settings, monkeypatch):
    told, goes_on = threading.Event(), threading.Semaphore(0)

    def told_slowly(job, callback=None, should_stop=None):
        for fraction in (0.0, 0.9):
            callback(fraction, 0.0)
            told.set()
            while not goes_on.acquire(timeout=0.005):
                if should_stop():
                    break
        return denoise_job.compute(job, callback, should_stop)

    monkeypatch.setattr(outcomes, "compute", told_slowly)
    noisy_monkey()
    settings.preset = "AUTO"
    session = turn_on()
    assert told.wait(SECONDS)
    current_preview.tick_preview()
    drawn = []
    monkeypatch.setattr(current_preview, "redraw_sidebars", lambda: drawn.append(session.fraction))
    current_preview.tick_preview()
    assert drawn == []
    told.clear()
    goes_on.release()
    assert told.wait(SECONDS)
    current_preview.tick_preview()
    current_preview.tick_preview()
    assert drawn == [pytest.approx(0.9 / 3)]


def test_between_known_results_there_is_a_picture_at_once(settings, steps):
    begun, turns, has_begun = steps
    obj = noisy_monkey()
    surface = mesh_bridge.read_surface(obj)
    settings.preset = "AUTO"
    session = turn_on()
    for _ in range(2):
        turns.release()
    settle(session)
    for _ in range(2):
        has_begun.acquire()
    strong = read_positions(obj.data)
    turns.release()  # what nobody has asked for yet: the end of the slider
    assert has_begun.acquire(timeout=SECONDS) and session.wait(SECONDS)
    assert begun[2] == DenoiseSettings(strength=FARTHEST, threads=1)
    current_preview.tick_preview()
    assert session.is_current and same(read_positions(obj.data), strong)  # nobody sees that

    settings.strength = 0.25
    current_preview.tick_preview()  # nothing has been computed
    half_way = surface.vertices + (strong - surface.vertices) / 4
    assert np.allclose(read_positions(obj.data), half_way, atol=1e-6) and not session.is_current
    settings.strength = 1.5
    current_preview.tick_preview()
    farthest = denoise(surface, begun[2]).vertices
    assert np.allclose(read_positions(obj.data), (strong + farthest) / 2, atol=1e-6)
    for _ in range(4):
        turns.release()
    settle(session)
    assert session.is_current and same(read_positions(obj.data), expected_for(surface, settings))
    assert all(each.passes == 2 for each in begun[2:])  # no draft where there is a picture


def test_an_answer_to_an_older_value_does_not_take_the_picture_away(settings, steps):
    _, turns, has_begun = steps
    obj = noisy_monkey()
    settings.preset = "AUTO"
    session = turn_on()
    for _ in range(3):
        turns.release()
    settle(session)
    assert session.wait(SECONDS)  # for the end of the slider
    settings.strength = 0.5
    current_preview.tick_preview()
    for _ in range(4):
        assert has_begun.acquire(timeout=SECONDS)  # that of 0.5 has begun
    settings.strength = 0.2
    current_preview.tick_preview()
    shown = read_positions(obj.data)
    turns.release()
    assert has_begun.acquire(timeout=SECONDS)  # that of 0.5 is done, that of 0.2 has begun
    current_preview.tick_preview()
    assert same(read_positions(obj.data), shown)


def test_other_settings_or_another_region_know_nothing(settings, steps):
    _, turns, _ = steps
    obj = noisy_monkey()
    settings.preset = "AUTO"
    session = turn_on()
    for _ in range(3):
        turns.release()
    settle(session)
    session.wait(SECONDS)
    before = read_positions(obj.data)
    settings.noise, settings.strength = "WIDE", 0.5
    current_preview.tick_preview()
    assert same(read_positions(obj.data), before)  # as what is known is not known of wide noise
    turns.release()
    settings.noise = "AUTO"
    group = obj.vertex_groups.new(name="Half")
    group.add(list(range(100)), 1.0, "REPLACE")
    settings.vertex_group = "Half"
    before = read_positions(obj.data)
    current_preview.tick_preview()
    assert same(read_positions(obj.data), before)


def test_what_a_run_came_to_is_shown_at_once(settings, steps):
    begun, _, _ = steps
    obj = noisy_monkey()
    surface = mesh_bridge.read_surface(obj)
    settings.preset = "AUTO"
    assert bpy.ops.object.framelet_denoise(preset="AUTO", output="MODIFIER") == {"FINISHED"}
    session = turn_on()
    assert session.wait(SECONDS)
    current_preview.tick_preview()
    assert session.is_current
    np.testing.assert_allclose(shown(obj), denoise(surface).vertices, atol=1e-6)
    assert DenoiseSettings() not in begun and DenoiseSettings(passes=1) not in begun


def test_a_run_has_what_the_preview_came_to(settings, monkeypatch):
    obj = noisy_monkey()
    surface = mesh_bridge.read_surface(obj)
    settings.preset = "AUTO"
    settle(turn_on())
    current_preview.stop_preview()

    def compute(*_given):
        raise AssertionError("it is known already")

    monkeypatch.setattr(denoise_run, "compute", compute)
    run = start(obj, settings=DenoiseSettings())
    assert until_done(run) is State.READY
    run.finish()
    assert same(read_positions(obj.data), denoise(surface).vertices)


def shown(obj):
    """Return the positions with all modifiers."""
    found = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    return read_positions(found)
