# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What happens to the objects while a run goes on: it is dropped where it must be, and only there."""

import bpy
import pytest
from blender_objects import noisy_monkey, read
from framelet.operators.mesh_io import mesh_bridge
from framelet.operators.run import current_run, preparations
from framelet.operators.run.denoise_run import State
from run_steps import framelet_threads, start, until_done

pytestmark = pytest.mark.usefixtures("no_thread_stays")


def change_mode():
    bpy.ops.object.mode_set(mode="EDIT")


def delete():
    bpy.ops.object.delete()


def move_a_vertex():
    bpy.context.object.data.vertices[5].co.z += 0.25


def flip_the_faces():
    bpy.context.object.data.flip_normals()


def replace_the_mesh():
    bpy.context.object.data = bpy.context.object.data.copy()


def add_a_shape_key():
    bpy.context.object.shape_key_add(name="Basis")


def subdivide():
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.subdivide()
    bpy.ops.object.mode_set(mode="OBJECT")


@pytest.mark.parametrize(
    ("edit", "sentence"),
    [
        (change_mode, "The mode of ‘Monkey’ was changed"),
        (delete, "‘Monkey’ was deleted"),
        (move_a_vertex, "The mesh of ‘Monkey’ was edited"),
        (flip_the_faces, "The mesh of ‘Monkey’ was edited"),
        (replace_the_mesh, "‘Monkey’ got another mesh"),
        (add_a_shape_key, "Another shape key of ‘Monkey’ became active"),
        (subdivide, "The mesh of ‘Monkey’ was edited"),
    ],
)
def test_what_happens_meanwhile_drops_the_run(edit, sentence, gate):
    obj = noisy_monkey()
    other = noisy_monkey("Other", (3, 0, 0))
    others_before = read(other)
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)
    other.select_set(False)
    run = start(obj, other)
    edit()
    after_edit = read(obj) if edit is not delete else None
    gate.set()
    assert until_done(run) is State.FAILED
    assert (
        run.reason
        == f"{sentence} while Framelet was running, so that the run was dropped; nothing was changed."
    )
    if after_edit is not None:
        assert read(obj).tobytes() == after_edit.tobytes()
    assert read(other).tobytes() == others_before.tobytes(), "all objects or none"
    assert current_run.current_run() is None


def test_an_edit_is_noticed_before_the_run_is_done(gate):
    obj = noisy_monkey()
    run = start(obj)
    assert run.tick() is State.RUNNING
    move_a_vertex()
    obj.data.update()
    bpy.context.view_layer.update()
    assert run.tick() is State.FAILED and "was edited" in run.reason


def test_edits_of_other_meshes_are_not_looked_at(gate, monkeypatch):
    obj, other = noisy_monkey(), noisy_monkey("Other")
    run = start(obj)
    monkeypatch.setattr(mesh_bridge, "read_surface", lambda _: pytest.fail("it was read in detail"))
    other.data.vertices[5].co.z += 0.25
    other.data.update()
    bpy.context.view_layer.update()
    assert run.tick() is State.RUNNING


def test_renaming_and_moving_the_object_are_no_matter(gate):
    obj = noisy_monkey()
    run = start(obj)
    obj.name = "Renamed"
    obj.location.x += 3
    noisy_monkey("Monkey")
    gate.set()
    assert until_done(run) is State.READY
    assert run.finish()[0].obj == obj


def test_undo_drops_the_run(gate):
    obj = noisy_monkey()
    bpy.ops.ed.undo_push(message="Before")
    obj.location.x = 1
    bpy.ops.ed.undo_push(message="Moved")
    before = read(obj)
    run = start(obj)
    bpy.ops.ed.undo()
    assert run.tick() is State.FAILED
    assert run.reason.startswith("Undo or redo was used while Framelet was running")
    assert read(bpy.data.objects["Monkey"]).tobytes() == before.tobytes()


def test_opening_a_file_drops_the_run(gate):
    run = start(noisy_monkey())
    bpy.ops.wm.read_factory_settings(use_empty=True)
    assert run.tick() is State.FAILED
    assert run.reason.startswith("Another file was opened while Framelet was running")
    assert len(preparations.preparations()) == 0


def test_unregistering_stops_a_run(gate):
    import framelet

    obj = noisy_monkey()
    before = read(obj)
    run = start(obj)
    framelet.unregister()
    try:
        assert run.state is State.CANCELED and framelet_threads() == []
        assert read(obj).tobytes() == before.tobytes()
    finally:
        framelet.register()
