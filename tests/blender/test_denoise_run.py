# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A run on a thread: same bits as without, nothing written unless all is well, and no thread stays."""

import re

import bpy
import numpy as np
import pytest

# isort: split
# This module exists once bpy was imported.
import bmesh
from blender_objects import noisy_monkey, read
from framelet.core import PRESETS
from framelet.operators.mesh_io import mesh_bridge
from framelet.operators.run import current_run, denoise_job, denoise_run, preparations
from framelet.operators.run.denoise_object import denoise_object
from framelet.operators.run.denoise_run import State, begin_run
from framelet.operators.run.run_display import progress_text, status_text
from run_steps import QUICK, SECONDS, start, until_done

pytestmark = pytest.mark.usefixtures("no_thread_stays")


@pytest.mark.parametrize("preset", ["AUTO", "TRI_1", "TRI_2", "FREE_FORM", "BILATERAL"])
def test_threads_and_scripts_give_the_same_bits(preset):
    settings = PRESETS[preset].settings
    first, second = noisy_monkey("First"), noisy_monkey("Second")
    noisy = read(first)
    run = start(first, settings=settings)
    assert until_done(run) is State.READY
    assert read(first).tobytes() == noisy.tobytes(), "nothing is written before `finish`"
    (written,) = run.finish()
    assert (written.original, written.obj) == (first, first)
    assert not run.is_active and current_run.current_run() is None
    bpy.ops.object.select_all(action="DESELECT")
    second.select_set(True)
    bpy.context.view_layer.objects.active = second
    bpy.ops.object.framelet_denoise(preset=preset)
    assert read(first).tobytes() == read(second).tobytes() != noisy.tobytes()


def test_edit_mode_on_a_thread_moves_the_selected_vertices():
    obj = noisy_monkey()
    bpy.ops.object.mode_set(mode="EDIT")
    edit_mesh = bmesh.from_edit_mesh(obj.data)
    for vert in edit_mesh.verts:
        vert.select = vert.index < 100
    before = read(obj)
    run = start(obj)
    # What is selected counts as it was when the run began.
    bpy.ops.mesh.select_all(action="SELECT")
    assert until_done(run) is State.READY
    run.finish()
    moved = (read(obj) != before).any(axis=1)
    assert moved[:100].any() and not moved[100:].any()


def test_several_objects_are_written_together(gate):
    objects = [noisy_monkey("A"), noisy_monkey("B", (3, 0, 0))]
    before = [read(obj) for obj in objects]
    run = start(*objects, output="NEW_OBJECT")
    assert run.tick() is State.RUNNING
    assert run.text == "Denoising ‘A’ (1 of 2)"
    assert progress_text(run) == "Denoising ‘A’ (1 of 2): preparing"
    gate.set()
    assert until_done(run) is State.READY
    assert run.fraction == 1.0
    assert status_text(run) == "Denoising ‘B’ (2 of 2): 100%   |   Esc or Right Click in the View: Cancel"
    written = run.finish()
    assert [item.obj.name for item in written] == ["A.denoised", "B.denoised"]
    assert [read(obj).tobytes() for obj in objects] == [vertices.tobytes() for vertices in before]


@pytest.mark.parametrize("when", ["at once", "computing", "ready"])
def test_cancel_leaves_all_as_it_was(when, gate):
    obj = noisy_monkey()
    before = read(obj)
    run = start(obj)
    if when == "ready":
        gate.set()
        assert until_done(run) is State.READY
    elif when == "computing":
        assert run.tick() is State.RUNNING
    run.cancel()
    assert run.tick() is State.CANCELED
    assert run.wait(SECONDS), "the thread ends by itself"
    assert read(obj).tobytes() == before.tobytes()
    with pytest.raises(RuntimeError, match="cannot be finished"):
        run.finish()
    run.drop("‘Monkey’ was deleted")
    assert run.state is State.CANCELED


def test_cancel_within_the_solver_and_a_new_run_after_it():
    obj = noisy_monkey()
    slow = QUICK.with_changes(iterations=10000)
    before = read(obj)
    run = start(obj, settings=slow)
    while run.fraction == 0.0:
        assert not run.wait(0.001), "a run that long is not over at once"
    assert 0.0 < run.fraction < 1.0
    run.cancel()
    # The thread of the canceled one may still be there: the new one waits for it.
    again = start(obj)
    assert until_done(again) is State.READY
    again.finish()
    expected = noisy_monkey("Expected")
    denoise_object(expected, QUICK)
    assert read(obj).tobytes() == read(expected).tobytes() != before.tobytes()


def test_an_interrupted_script_leaves_no_run(monkeypatch):
    obj = noisy_monkey()
    before = read(obj)

    def compute(*_):
        raise KeyboardInterrupt

    with monkeypatch.context() as patched:
        patched.setattr(denoise_run, "compute", compute)
        with pytest.raises((KeyboardInterrupt, RuntimeError)):
            bpy.ops.object.framelet_denoise()
    assert current_run.current_run() is None
    assert read(obj).tobytes() == before.tobytes()
    assert bpy.ops.object.framelet_denoise(preset="POSITIONS") == {"FINISHED"}


def test_one_run_at_a_time(gate):
    obj = noisy_monkey()
    run = start(obj)
    with pytest.raises(RuntimeError, match="press Esc"):
        bpy.ops.object.framelet_denoise(preset="POSITIONS")
    with pytest.raises(ValueError, match="Framelet is running; press Esc"):
        current_run.set_current(begin_run([obj], QUICK))
    assert bpy.ops.object.framelet_cancel() == {"FINISHED"}
    assert run.tick() is State.CANCELED
    assert not bpy.ops.object.framelet_cancel.poll()
    gate.set()
    assert bpy.ops.object.framelet_denoise(preset="POSITIONS") == {"FINISHED"}


def test_objects_that_cannot_be_denoised_do_not_stop_the_others():
    good = noisy_monkey("Good")
    flat = bpy.data.objects.new("Flat", bpy.data.meshes.new("Flat"))
    broken = noisy_monkey("Broken", (3, 0, 0))
    broken.data.vertices[3].co.x = float("nan")
    run = start(good, flat, broken)
    assert until_done(run) is State.READY
    assert [item.obj for item in run.finish()] == [good]
    assert len(run.failures) == 2
    assert "‘Flat’ has no faces" in run.failures[0] and run.failures[1].startswith("‘Broken’: ")
    run = start(broken)
    assert until_done(run) is State.FAILED and run.reason.startswith("‘Broken’: ")
    with pytest.raises(ValueError, match="has no faces"):
        begin_run([flat], QUICK)


@pytest.mark.parametrize(
    ("error", "sentence"),
    [
        (KeyError("gone"), "An unexpected error stopped the run (KeyError: 'gone'); nothing was changed."),
        (MemoryError(), "There is not enough memory for this mesh; nothing was changed."),
    ],
)
def test_errors_become_sentences(error, sentence, monkeypatch, capfd):
    obj = noisy_monkey()
    before = read(obj)

    def compute(*_):
        raise error

    monkeypatch.setattr(denoise_run, "compute", compute)
    run = start(obj)
    assert until_done(run) is State.FAILED
    assert run.reason.startswith(sentence)
    assert read(obj).tobytes() == before.tobytes()
    with pytest.raises(RuntimeError, match=sentence.split("(")[0]):
        bpy.ops.object.framelet_denoise()
    assert current_run.current_run() is None


def test_a_run_that_waits_can_be_canceled():
    obj = noisy_monkey()
    with preparations.borrowed_preparations():
        run = start(obj)
        assert not run.wait(0.2), "it waits for what another run works with"
        run.cancel()
        assert run.wait(SECONDS)
    job = denoise_job.DenoiseJob("X", mesh_bridge.read_surface(obj), QUICK, np.eye(3))
    assert not denoise_job.compute(job).measured.report.is_stopped


def test_the_cache_serves_runs_on_threads(monkeypatch):
    obj = noisy_monkey()
    preparations.forget_preparations()
    noisy = read(obj)
    for lambda_ in (0.1, 0.2):
        mesh_bridge.write_vertices(obj, mesh_bridge.read_surface(obj), noisy)
        run = start(obj, settings=QUICK.with_changes(lambda_=lambda_))
        assert until_done(run) is State.READY
        run.finish()
        kept = preparations.preparations()._kept
        assert len(kept) == 1
        if lambda_ == 0.1:
            first = kept[0]
    assert kept[0] is first


def test_the_time_that_is_left_stands_beside_the_percent_once_it_is_known(gate, monkeypatch):
    run = start(noisy_monkey("A"))
    began = denoise_run.monotonic()
    monkeypatch.setattr(denoise_run, "monotonic", lambda: began + 10.0)
    assert run.seconds_left is None  # nothing is done yet
    run._worker.fraction = 0.2
    assert run.seconds_left == pytest.approx(40.0, abs=1.0)
    assert re.fullmatch(r"Denoising ‘A’: 20%, (39|40|41) s left", progress_text(run))
    run._worker.fraction = 1.0
    assert progress_text(run) == "Denoising ‘A’: 100%"
    monkeypatch.setattr(denoise_run, "monotonic", lambda: began + 1.0)
    run._worker.fraction = 0.2
    assert progress_text(run) == "Denoising ‘A’: 20%"
    gate.set()
    until_done(run)
