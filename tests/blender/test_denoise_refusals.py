# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bad input gets one sentence and stays as it is; good meshes beside it are denoised."""

import bpy
import pytest
from blender_objects import noisy_monkey, read, select_only
from framelet.core import DEFAULT_PRESET, PRESETS, denoise
from framelet.operators.mesh_io import mesh_bridge


def last_report():
    return bpy.context.window_manager.framelet_report


def make_object(name, vertices, faces):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices, [], faces)
    obj = bpy.data.objects.new(name, mesh)
    bpy.context.collection.objects.link(obj)
    return obj


BAD_MESHES = {
    "Empty": ([], []),
    "No Faces": ([(0, 0, 0), (1, 0, 0)], []),
    "Point": ([(1, 1, 1)] * 3, [(0, 1, 2)]),
    "Not Finite": ([(0, 0, 0), (1, 0, 0), (0, 1, float("nan"))], [(0, 1, 2)]),
    "Infinite": ([(0, 0, 0), (1, 0, 0), (0, 1, float("inf"))], [(0, 1, 2)]),
}


@pytest.mark.parametrize("name", BAD_MESHES)
def test_bad_meshes_get_a_sentence_and_stay(name):
    obj = make_object(name, *BAD_MESHES[name])
    select_only(obj)
    before = read(obj)
    with pytest.raises(RuntimeError, match=f"‘{name}’") as caught:
        bpy.ops.object.framelet_denoise()
    assert str(caught.value).strip().endswith(".")
    assert read(obj).tobytes() == before.tobytes()
    assert last_report().n_objects == 0


def test_nothing_selected_in_edit_mode_gets_a_sentence():
    noisy_monkey()
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="DESELECT")
    with pytest.raises(RuntimeError, match="‘Monkey’ has no selected vertices"):
        bpy.ops.object.framelet_denoise()


def test_good_meshes_are_denoised_beside_bad_ones(capfd):
    good = noisy_monkey("Good")
    bad = make_object("Bad", *BAD_MESHES["Not Finite"])
    expected = denoise(mesh_bridge.read_surface(good), PRESETS[DEFAULT_PRESET].settings)
    select_only(bad, good)
    assert bpy.ops.object.framelet_denoise() == {"FINISHED"}
    assert read(good).tobytes() == expected.vertices.tobytes()
    assert last_report().names == "Good"
    output = capfd.readouterr().out
    assert "Warning: ‘Bad’" in output
    assert "Denoised ‘Good’" in output


def test_linked_meshes_are_refused(tmp_path):
    noisy_monkey("Rock")
    path = str(tmp_path / "rocks.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    with bpy.data.libraries.load(path, link=True) as (_source, target):
        target.objects = ["Rock"]
    obj = bpy.data.objects["Rock"]
    bpy.context.collection.objects.link(obj)
    select_only(obj)
    before = read(obj)
    with pytest.raises(RuntimeError, match=r"‘Rock’ uses a mesh linked from .*rocks\.blend"):
        bpy.ops.object.framelet_denoise()
    assert read(obj).tobytes() == before.tobytes()


def test_poll_says_no_without_a_mesh_or_in_other_modes():
    assert not bpy.ops.object.framelet_denoise.poll()
    obj = noisy_monkey()
    assert bpy.ops.object.framelet_denoise.poll()
    bpy.ops.object.armature_add()
    armature = bpy.context.object
    bpy.ops.object.mode_set(mode="EDIT")
    assert not bpy.ops.object.framelet_denoise.poll()
    with pytest.raises(RuntimeError, match="Object Mode"):
        bpy.ops.object.framelet_denoise()
    bpy.ops.object.mode_set(mode="OBJECT")
    armature.select_set(False)
    obj.select_set(False)
    with pytest.raises(RuntimeError, match="Select at least one mesh"):
        bpy.ops.object.framelet_denoise()
