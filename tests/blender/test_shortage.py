# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where memory ends there is one sentence, and the mesh is as it was.

Each large array that NumPy is asked for fails in turn; and a Blender of its own gets less and less memory.
"""

import re
import signal
import subprocess
import sys
from pathlib import Path

import bpy
import numpy as np
import pytest
from framelet.operators.mesh_io import mesh_bridge
from framelet.operators.preview import current_preview
from framelet.operators.run import denoise_run, outcome_memory, preparations
from run_steps import assert_clean, framelet_threads, settle, turn_on

pytestmark = pytest.mark.usefixtures("no_thread_stays")

ROOT = Path(__file__).resolve().parents[2]
LARGE = 4000
"""Bytes; the mesh has 642 vertices."""

MAKERS = ("empty", "zeros", "ones", "full", "empty_like", "zeros_like", "ones_like", "full_like")
MOST_TRIES = 12
SENTENCE = re.compile(r"Error: There is not enough memory for [^.]*\.\s*")

OPERATIONS = {
    "denoise": lambda: bpy.ops.object.framelet_denoise(),
    "modifier": lambda: bpy.ops.object.framelet_denoise(preset="POSITIONS", output="MODIFIER"),
    "shape key": lambda: bpy.ops.object.framelet_denoise(preset="BILATERAL", output="SHAPE_KEY"),
    "new object": lambda: bpy.ops.object.framelet_denoise(preset="POSITIONS", output="NEW_OBJECT"),
    "again": lambda: bpy.ops.object.framelet_denoise(preset="POSITIONS", from_original=True),
    "equalize": lambda: bpy.ops.object.framelet_equalize(gain_1=0.5),
    "live equalizer": lambda: bpy.ops.object.framelet_live_equalizer(gain_1=0.5),
    "analyze": lambda: bpy.ops.object.framelet_analyze(levels=2),
    "noise": lambda: bpy.ops.object.framelet_add_noise(seed=5),
    "estimate": lambda: bpy.ops.object.framelet_estimate_noise(),
    "spikes": lambda: bpy.ops.object.framelet_flatten_spikes(length=1.2),
    "heat map": lambda: bpy.ops.object.framelet_heat_map(),
}


class Door:
    """All of NumPy that makes large arrays; what is asked for at `closed_at` is not given."""

    def __init__(self, monkeypatch):
        self.n_asked, self.closed_at = 0, 0
        for name in MAKERS:
            monkeypatch.setattr(np, name, self._guarded(getattr(np, name)))

    def _guarded(self, make):
        def made(*args, **options):
            array = make(*args, **options)
            if array.nbytes >= LARGE:
                self.n_asked += 1
                if self.n_asked == self.closed_at:
                    raise MemoryError(f"Unable to allocate {array.nbytes} bytes")
            return array

        return made


@pytest.fixture
def ball(empty_scene):
    """A ball that was denoised and has noise again."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=4)
    bpy.ops.object.framelet_add_noise(seed=1)
    bpy.ops.object.framelet_denoise(preset="POSITIONS")
    return bpy.context.object


def state(obj):
    """Return all that no operator may touch where it fails."""
    attributes = {
        item.name: [tuple(each.vector) for each in item.data]
        for item in obj.data.attributes
        if item.data_type == "FLOAT_VECTOR"
    }
    modifiers = [item.name for item in obj.modifiers]
    return attributes, modifiers, obj.data.shape_keys, sorted(bpy.data.objects.keys())


@pytest.mark.parametrize("name", OPERATIONS)
def test_each_large_array_that_is_not_given(name, ball, monkeypatch):
    operation = OPERATIONS[name]
    bpy.ops.ed.undo_push(message="Before")
    before = state(ball)
    door = Door(monkeypatch)
    assert operation() == {"FINISHED"}
    n_arrays, n_refused = door.n_asked, 0
    assert n_arrays > 0
    for at in np.unique(np.linspace(1, n_arrays, MOST_TRIES).astype(int)):
        door.closed_at = 0
        bpy.ops.ed.undo_push(message="After")
        bpy.ops.ed.undo()
        preparations.forget_preparations()
        outcome_memory.forget_outcomes()
        obj = bpy.context.object
        assert state(obj) == before
        door.n_asked, door.closed_at = 0, at
        try:
            assert operation() == {"FINISHED"}, at
        except RuntimeError as error:
            n_refused += 1
            assert SENTENCE.fullmatch(str(error)), f"{at} of {n_arrays}: {error}"
            assert state(obj) == before, f"{at} of {n_arrays}"
        assert framelet_threads() == []
    assert n_refused > 0


def test_no_memory_to_write(ball, monkeypatch):
    before = state(ball)

    def refuse(_):
        raise MemoryError

    monkeypatch.setattr(denoise_run, "reserve_for_writing", refuse)
    with pytest.raises(RuntimeError, match="There is not enough memory for ‘Icosphere’"):
        bpy.ops.object.framelet_denoise(preset="POSITIONS", output="SHAPE_KEY")
    assert state(ball) == before


def test_a_preview_ends_in_a_sentence(ball, settings, monkeypatch):
    before = mesh_bridge.read_positions(ball.data)
    session = turn_on()
    settle(session)

    def refuse(*_):
        raise MemoryError

    monkeypatch.setattr(mesh_bridge, "with_moved", refuse)
    settings.lambda_ = 3.0
    settle(session)
    assert current_preview.current_preview() is None
    words = "There is not enough memory for ‘Icosphere’, so that the preview ended."
    assert current_preview.preview_message() == words
    assert np.array_equal(mesh_bridge.read_positions(ball.data), before)
    assert_clean(ball.data)


PROGRAM = """
import resource, sys
sys.path.insert(0, {tests!r})
from conftest import load_package
load_package()
import bpy, framelet
import numpy as np
from framelet.operators.mesh_io.mesh_bridge import read_positions
bpy.ops.wm.read_factory_settings(use_empty=True)
framelet.register()
bpy.ops.mesh.primitive_grid_add(x_subdivisions=250, y_subdivisions=250)
bpy.ops.object.framelet_add_noise(seed=1)
mesh = bpy.context.object.data
before = read_positions(mesh)
used = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
for megabytes in (300, 150, 75, 40, 25, 15, 8, 4):
    resource.setrlimit(resource.RLIMIT_AS, (used + megabytes * 1000000, resource.RLIM_INFINITY))
    try:
        found = bpy.ops.object.framelet_denoise(preset="POSITIONS", threads=1)
    except RuntimeError as error:
        found = str(error)
    resource.setrlimit(resource.RLIMIT_AS, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
    same = np.array_equal(read_positions(mesh), before)
    print("FOUND", megabytes, same, found, flush=True)
    mesh.attributes["position"].data.foreach_set("vector", before.reshape(-1))
framelet.unregister()
"""


@pytest.mark.skipif(sys.platform != "linux", reason="needs limits of memory and /proc, as Linux has them")
def test_less_and_less_memory():
    command = [sys.executable, "-c", PROGRAM.format(tests=str(ROOT / "tests"))]
    done = subprocess.run(command, capture_output=True, text=True, timeout=240, check=False)
    assert "Traceback" not in done.stdout + done.stderr, done.stdout + done.stderr
    lines = [line for line in done.stdout.splitlines() if line.startswith("FOUND")]
    # With less than what a call itself takes, Blender may end: no sentence is possible there.
    if done.returncode == 0:
        assert len(lines) == 8, done.stdout
    else:
        assert done.returncode in (-signal.SIGSEGV, -signal.SIGABRT), done.stdout + done.stderr
        assert len(lines) >= 6, done.stdout + done.stderr
    for line in lines:
        is_same = line.split()[2] == "True"
        assert is_same != ("FINISHED" in line), line
        assert "FINISHED" in line or "memory" in line, line
    assert any("memory" in line for line in lines)
