# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The same again and again: undo and redo lead back to the same bits, and memory stays.

`FRAMELET_RUNS=200` denoises as often as it says; `make hunt-blender` does so.
"""

import gc
import os

import bpy
import pytest
from blender_life.world import seen
from framelet.operators.mesh_io import mesh_bridge
from framelet.operators.preview import current_preview
from framelet.operators.run import outcome_memory
from process_memory import resident_megabytes
from run_steps import assert_clean, settle, turn_on

pytestmark = pytest.mark.usefixtures("no_thread_stays")

N_STEPS = 50
N_RUNS = int(os.environ.get("FRAMELET_RUNS", "0"))
WARM_UP = 20
OUTPUTS = ("MODIFIER", "IN_PLACE", "SHAPE_KEY")


@pytest.fixture
def many_undo_steps():
    """Let Blender keep more steps than it does by default."""
    edit = bpy.context.preferences.edit
    before, edit.undo_steps = edit.undo_steps, 4 * N_STEPS
    yield
    edit.undo_steps = before


def push(history):
    bpy.ops.ed.undo_push(message=f"Step {len(history)}")
    history.append(seen(bpy.context.object))


def test_undo_and_redo_fifty_times(settings, many_undo_steps):
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3)
    history = []
    push(history)
    for number in range(N_STEPS):
        bpy.ops.object.framelet_add_noise(seed=number, sigma=0.05)
        bpy.ops.object.framelet_denoise(preset="POSITIONS", output=OUTPUTS[number % 3], from_original=True)
        push(history)
    assert len(set(history)) > N_STEPS / 2
    for back in range(N_STEPS - 1, -1, -1):
        assert bpy.ops.ed.undo() == {"FINISHED"}
        assert seen(bpy.context.object) == history[back], back
    for forth in range(1, N_STEPS + 1):
        assert bpy.ops.ed.redo() == {"FINISHED"}
        assert seen(bpy.context.object) == history[forth], forth


def test_fifty_undo_steps_of_a_preview(settings, many_undo_steps):
    """Each step holds the mesh as it was shown; none of it stays."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3)
    bpy.ops.object.framelet_add_noise(seed=1)
    bpy.ops.ed.undo_push(message="Noise")
    before = seen(bpy.context.object)
    settle(turn_on())
    for number in range(N_STEPS):
        settings.lambda_ = 0.1 + 0.02 * number
        settle(current_preview.current_preview())
        bpy.ops.ed.undo_push(message="Smoothing")
    current_preview.end_preview()
    for step in [bpy.ops.ed.undo] * N_STEPS + [bpy.ops.ed.redo] * N_STEPS:
        step()
        assert seen(bpy.context.object) == before
        assert_clean(bpy.context.object.data)


@pytest.mark.skipif(N_RUNS == 0, reason="takes minutes: `make hunt-blender` runs it")
def test_memory_stays(empty_scene, monkeypatch):
    # Outcomes are kept until they take as much as is allowed; here that is soon.
    monkeypatch.setattr(outcome_memory, "MOST_BYTES", 10 * 2 * 12 * 2562)
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=5)
    obj = bpy.context.object
    surface = mesh_bridge.read_surface(obj)

    def denoise(number, output):
        mesh_bridge.write_vertices(obj, mesh_bridge.read_surface(obj), surface.vertices)
        bpy.ops.object.framelet_add_noise(seed=number)
        assert bpy.ops.object.framelet_denoise(output=output) == {"FINISHED"}

    used = []
    for number in range(N_RUNS + WARM_UP):
        denoise(number, "IN_PLACE" if number % 2 else "MODIFIER")
        gc.collect()
        used.append(resident_megabytes())
    assert max(used[WARM_UP:]) <= 1.02 * max(used[:WARM_UP]), [round(each) for each in used[::20]]
