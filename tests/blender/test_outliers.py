# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Spikes are selected and flattened, small islands selected."""

import bpy
import numpy as np
import pytest

# isort: split
# This module exists once bpy was imported.
import bmesh
from framelet.operators.mesh_io import mesh_bridge
from framelet.operators.outliers import flatten_spikes
from meshes import triangle_grid, union

SIZE = 16
SINGLE, CLUSTER = 5 * SIZE + 5, [10 * SIZE + 10, 10 * SIZE + 11]


@pytest.fixture
def spiky(make_object):
    points = np.stack((*np.divmod(np.arange(SIZE**2), SIZE), np.zeros(SIZE**2)), axis=1).astype(float)
    points[SINGLE, 2] = 6.0
    points[CLUSTER, 2] = -5.0
    return make_object(triangle_grid(SIZE, SIZE).with_vertices(points), "Terrain")


def heights(obj):
    return mesh_bridge.read_surface(obj).vertices[:, 2]


def selected(obj):
    return [vert.index for vert in bmesh.from_edit_mesh(obj.data).verts if vert.select]


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT", "SCULPT"])
def test_spikes_are_selected_in_edit_mode(spiky, mode):
    bpy.ops.object.mode_set(mode=mode)
    assert bpy.ops.object.framelet_select_spikes() == {"FINISHED"}
    assert spiky.mode == "EDIT"
    assert selected(spiky) == [SINGLE, *CLUSTER]
    assert heights(spiky).max() == 6.0


def test_the_largest_cluster_is_a_setting(spiky):
    assert bpy.ops.object.framelet_select_spikes(most=1) == {"FINISHED"}
    assert selected(spiky) == [SINGLE]


@pytest.mark.parametrize("mode", ["OBJECT", "SCULPT", "WEIGHT_PAINT"])
def test_flattened_spikes_lie_in_the_surface_and_all_else_stays(spiky, mode):
    before = mesh_bridge.read_surface(spiky).vertices
    bpy.ops.object.mode_set(mode=mode)
    assert bpy.ops.object.framelet_flatten_spikes() == {"FINISHED"}
    after = mesh_bridge.read_surface(spiky).vertices
    moved = (after != before).any(axis=1)
    assert np.flatnonzero(moved).tolist() == [SINGLE, *CLUSTER]
    np.testing.assert_allclose(after[:, 2], 0.0, atol=1e-5)


def test_in_edit_mode_the_selected_spikes_are_flattened(spiky):
    bpy.ops.object.framelet_select_spikes(most=1)
    bpy.ops.object.framelet_flatten_spikes()
    found = heights(spiky)
    assert found[SINGLE] == pytest.approx(0.0, abs=1e-6)
    assert (found[CLUSTER] == -5.0).all()


def test_a_masked_spike_stays(spiky):
    mask = np.zeros(SIZE**2, np.float32)
    mask[SINGLE] = 1.0
    spiky.data.attributes.new(".sculpt_mask", "FLOAT", "POINT").data.foreach_set("value", mask)
    assert flatten_spikes(spiky) == 2
    assert heights(spiky)[SINGLE] == 6.0


def test_a_mesh_with_the_modifier_of_a_run_is_refused(spiky):
    bpy.ops.object.framelet_denoise(preset="TRI_2", output="MODIFIER")
    with pytest.raises(RuntimeError, match="‘Terrain’ has the modifier of a run"):
        bpy.ops.object.framelet_flatten_spikes()


def test_small_islands_are_selected_and_the_largest_part_is_not(make_object):
    obj = make_object(union(triangle_grid(12, 12), triangle_grid(3, 3), triangle_grid(6, 6)))
    assert bpy.ops.object.framelet_select_islands(most=9) == {"FINISHED"}
    assert selected(obj) == list(range(144, 153))
    assert bpy.ops.object.framelet_select_islands(most=1000) == {"FINISHED"}
    assert selected(obj) == list(range(144, 189))


OPERATORS = ("framelet_select_spikes", "framelet_select_islands")


@pytest.mark.parametrize("name", OPERATORS)
def test_a_linked_mesh_is_told(spiky, tmp_path, name):
    """Blender refused Edit Mode, with a traceback."""
    bpy.data.libraries.write(str(tmp_path / "rocks.blend"), {spiky})
    with bpy.data.libraries.load(str(tmp_path / "rocks.blend"), link=True) as (there, here):
        here.objects = there.objects
    (rock,) = here.objects
    bpy.context.collection.objects.link(rock)
    spiky.select_set(False)
    rock.select_set(True)
    bpy.context.view_layer.objects.active = rock
    with pytest.raises(RuntimeError, match="uses a mesh linked from") as error:
        getattr(bpy.ops.object, name)()
    assert "Traceback" not in str(error.value)


@pytest.mark.parametrize("name", OPERATORS)
def test_an_active_camera_is_told(spiky, name):
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    bpy.context.collection.objects.link(camera)
    bpy.context.view_layer.objects.active = camera
    with pytest.raises(RuntimeError, match="‘Camera’ is not a mesh") as error:
        getattr(bpy.ops.object, name)()
    assert "Traceback" not in str(error.value)
