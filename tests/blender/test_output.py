# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Results as a shape key and as a new object: right positions, and nothing else touched."""

import bpy
import numpy as np
import pytest
from blender_objects import noisy_monkey, select_only
from framelet.core import PRESETS, add_noise, denoise
from framelet.operators.mesh_io import mesh_bridge
from framelet.operators.run.denoise_object import denoise_object

QUICK = "POSITIONS"
SETTINGS = PRESETS[QUICK].settings


def run(output, **values):
    return bpy.ops.object.framelet_denoise(preset=QUICK, output=output, **values)


def mesh_points(mesh):
    points = np.empty((len(mesh.vertices), 3), np.float32)
    mesh.vertices.foreach_get("co", points.reshape(-1))
    return points


def key_points(key):
    points = np.empty((len(key.data), 3), np.float32)
    key.data.foreach_get("co", points.reshape(-1))
    return points


def shown(obj):
    """Return the positions that the scene shows, shape keys mixed."""
    return mesh_points(obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).data)


def test_the_default_is_in_place():
    obj = noisy_monkey()
    expected = denoise(mesh_bridge.read_surface(obj), SETTINGS).vertices
    bpy.ops.object.framelet_denoise(preset=QUICK)
    assert mesh_points(obj.data).tobytes() == expected.tobytes()
    assert obj.data.shape_keys is None and len(bpy.data.objects) == 1
    assert bpy.context.scene.framelet.output == "MODIFIER"


def test_a_shape_key_is_a_slider():
    obj = noisy_monkey()
    noisy = mesh_bridge.read_surface(obj)
    expected = denoise(noisy, SETTINGS).vertices
    assert run("SHAPE_KEY") == {"FINISHED"}
    basis, key = obj.data.shape_keys.key_blocks
    assert (basis.name, key.name, key.value, key.relative_key) == ("Basis", "Denoised", 1.0, basis)
    assert obj.active_shape_key == key
    assert key_points(basis).tobytes() == mesh_points(obj.data).tobytes() == noisy.vertices.tobytes()
    assert key_points(key).tobytes() == expected.tobytes()
    for amount in (1.0, 0.25, 0.0):
        key.value = amount
        assert np.allclose(shown(obj), noisy.vertices + amount * (expected - noisy.vertices), atol=1e-6)
    key.value = 0.5
    assert key.keyframe_insert("value", frame=1)


def test_a_shape_key_is_relative_to_the_key_that_was_denoised(rng):
    obj = noisy_monkey()
    obj.shape_key_add(name="Basis")
    smile = obj.shape_key_add(name="Smile", from_mix=False)
    other = obj.shape_key_add(name="Other", from_mix=False)
    for key in (smile, other):
        points = key_points(key) + rng.normal(0, 0.02, (len(key.data), 3)).astype(np.float32)
        key.data.foreach_set("co", points.reshape(-1))
    smile.value, other.value = 1.0, 0.5
    obj.active_shape_key_index = 1
    before = {key.name: key_points(key) for key in obj.data.shape_keys.key_blocks}
    mixed = shown(obj)
    surface = mesh_bridge.read_surface(obj)
    assert surface.vertices.tobytes() == before["Smile"].tobytes()
    expected = denoise(surface, SETTINGS).vertices
    run("SHAPE_KEY")
    keys = obj.data.shape_keys.key_blocks
    assert keys["Denoised"].relative_key == smile
    assert key_points(keys["Denoised"]).tobytes() == expected.tobytes()
    for name, points in before.items():
        assert key_points(keys[name]).tobytes() == points.tobytes()
    assert np.allclose(shown(obj) - mixed, expected - before["Smile"], atol=1e-6)


def test_a_second_shape_key_has_a_name_of_its_own():
    obj = noisy_monkey()
    run("SHAPE_KEY")
    run("SHAPE_KEY")
    keys = obj.data.shape_keys.key_blocks
    assert [key.name for key in keys] == ["Basis", "Denoised", "Denoised.001"]
    assert keys[2].relative_key == keys[1]
    assert np.allclose(shown(obj), key_points(keys[2]), atol=1e-6)


def test_a_locked_key_is_only_read_for_a_shape_key():
    obj = noisy_monkey()
    obj.shape_key_add(name="Basis").lock_shape = True
    with pytest.raises(RuntimeError, match="locked"):
        run("IN_PLACE")
    assert run("SHAPE_KEY") == {"FINISHED"}


def test_a_new_object_leaves_the_original():
    obj = noisy_monkey()
    extra = bpy.data.collections.new("Extra")
    bpy.context.scene.collection.children.link(extra)
    extra.objects.link(obj)
    obj.modifiers.new("Mirror", "MIRROR")
    obj.location = (1, 2, 3)
    noisy = mesh_bridge.read_surface(obj)
    assert run("NEW_OBJECT") == {"FINISHED"}
    new = bpy.data.objects["Monkey.denoised"]
    assert mesh_points(obj.data).tobytes() == noisy.vertices.tobytes()
    assert mesh_points(new.data).tobytes() == denoise(noisy, SETTINGS).vertices.tobytes()
    assert new.data != obj.data and new.data.name == "Monkey.denoised"
    assert new.data.users == obj.data.users == 1
    assert set(new.users_collection) == set(obj.users_collection) and len(new.users_collection) == 2
    assert [modifier.type for modifier in new.modifiers] == ["MIRROR"]
    assert tuple(new.location) == (1, 2, 3)
    assert bpy.context.selected_objects == [new] and bpy.context.active_object == new
    assert bpy.context.window_manager.framelet_report.names == "Monkey.denoised"


def test_a_new_object_has_the_shape_keys_too():
    obj = noisy_monkey()
    obj.shape_key_add(name="Basis")
    obj.shape_key_add(name="Wide", from_mix=False)
    obj.active_shape_key_index = 1
    before = mesh_bridge.read_surface(obj)
    run("NEW_OBJECT")
    new = bpy.data.objects["Monkey.denoised"]
    assert new.data.shape_keys != obj.data.shape_keys
    assert key_points(obj.data.shape_keys.key_blocks["Wide"]).tobytes() == before.vertices.tobytes()
    expected = denoise(before, SETTINGS).vertices
    assert key_points(new.data.shape_keys.key_blocks["Wide"]).tobytes() == expected.tobytes()


@pytest.mark.parametrize("output", ["IN_PLACE", "SHAPE_KEY", "NEW_OBJECT"])
def test_several_objects_and_shared_meshes(output):
    first, second = noisy_monkey("A"), noisy_monkey("B", (3, 0, 0))
    mesh_bridge.write_vertices(second, mesh_bridge.read_surface(second), mesh_points(second.data) * 2)
    twin = bpy.data.objects.new("Twin", first.data)
    bpy.context.collection.objects.link(twin)
    expected = [denoise(mesh_bridge.read_surface(obj), SETTINGS).vertices for obj in (first, second)]
    select_only(first, second, twin)
    assert run(output) == {"FINISHED"}
    n_new = 2 if output == "NEW_OBJECT" else 0
    assert len(bpy.data.objects) == 3 + n_new
    assert first.data == twin.data and first.data.users == 2
    results = [bpy.data.objects[f"{obj.name}.denoised"] if n_new else obj for obj in (first, second)]
    assert [mesh_bridge.read_surface(obj).vertices.tobytes() for obj in results] == [
        vertices.tobytes() for vertices in expected
    ]
    if output == "SHAPE_KEY":
        assert [len(obj.data.shape_keys.key_blocks) for obj in (first, second)] == [2, 2]
    if n_new:
        assert set(bpy.context.selected_objects) == {*results, twin}
        assert bpy.context.active_object == results[0]


def test_each_object_has_its_own_noise():
    quiet, loud = noisy_monkey("Quiet"), noisy_monkey("Loud", (3, 0, 0))
    surface = mesh_bridge.read_surface(loud)
    mesh_bridge.write_vertices(loud, surface, add_noise(surface, 0.3, 2))
    select_only(quiet, loud)
    bpy.ops.object.framelet_denoise(preset="POSITIONS", tuning="NOISE")
    found = {item.name: item.sigma for item in bpy.context.window_manager.framelet_estimate.objects}
    assert found["Loud"] > 1.2 * found["Quiet"] > 0


@pytest.mark.parametrize("output", ["SHAPE_KEY", "NEW_OBJECT"])
def test_edit_mode_is_refused_where_undo_would_not_reach(output):
    obj = noisy_monkey()
    before = mesh_points(obj.data)
    bpy.ops.object.mode_set(mode="EDIT")
    with pytest.raises(RuntimeError, match="in Object Mode only; leave the mode or set Output to In Place"):
        run(output)
    bpy.ops.object.mode_set(mode="OBJECT")
    assert mesh_points(obj.data).tobytes() == before.tobytes()
    assert obj.data.shape_keys is None and len(bpy.data.objects) == 1


def test_absolute_shape_keys_are_refused():
    obj = noisy_monkey()
    obj.shape_key_add(name="Basis")
    obj.data.shape_keys.use_relative = False
    with pytest.raises(RuntimeError, match="The shape keys of ‘Monkey’ are not relative; turn on Relative"):
        run("SHAPE_KEY")
    assert len(obj.data.shape_keys.key_blocks) == 1


@pytest.fixture
def linked(tmp_path):
    """Give an object whose mesh lives in another file."""
    path = str(tmp_path / "library.blend")
    noisy_monkey("Linked")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    with bpy.data.libraries.load(path, link=True) as (_, target):
        target.objects = ["Linked"]
    obj = target.objects[0]
    bpy.context.scene.collection.objects.link(obj)
    select_only(obj)
    return obj


@pytest.mark.parametrize("output", ["IN_PLACE", "SHAPE_KEY"])
def test_linked_meshes_are_refused(linked, output):
    with pytest.raises(RuntimeError, match="make it local first"):
        run(output)


def test_a_new_object_can_be_made_of_a_linked_one(linked):
    expected = denoise(mesh_bridge.read_surface(linked), SETTINGS).vertices
    assert run("NEW_OBJECT") == {"FINISHED"}
    new = bpy.context.active_object
    assert new.name == "Linked.denoised"
    assert new.library is None and new.data.library is None and linked.data.library is not None
    assert mesh_points(new.data).tobytes() == expected.tobytes()


@pytest.mark.parametrize("output", ["SHAPE_KEY", "NEW_OBJECT"])
def test_undo_takes_the_output_away(output):
    obj = noisy_monkey()
    before = mesh_points(obj.data)
    bpy.ops.ed.undo_push(message="Before")
    run(output)
    bpy.ops.ed.undo_push(message="Denoise")
    bpy.ops.ed.undo()
    assert list(bpy.data.objects.keys()) == ["Monkey"]
    mesh = bpy.data.objects["Monkey"].data
    assert mesh.shape_keys is None and mesh_points(mesh).tobytes() == before.tobytes()
    bpy.ops.ed.redo()
    assert bpy.data.objects["Monkey"].data.shape_keys or "Monkey.denoised" in bpy.data.objects


def test_the_function_for_scripts_has_the_output_too():
    obj = noisy_monkey()
    denoise_object(obj, SETTINGS, output="SHAPE_KEY")
    assert obj.data.shape_keys.key_blocks["Denoised"].value == 1.0
    report = denoise_object(obj, SETTINGS, lambda *_: True, "NEW_OBJECT")
    assert report.is_stopped and len(bpy.data.objects) == 1
