# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator Compare: angles and distances between two meshes of the same topology."""

import bpy
import numpy as np
import pytest
from framelet.core import compare
from framelet.operators.mesh_io import mesh_bridge


@pytest.fixture
def pair(empty_scene):
    """Return a noisy sphere, which is active, and a clean one beside it; both are selected."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3)
    clean = bpy.context.object
    clean.name = "Clean"
    noisy = bpy.data.objects.new("Noisy", clean.data.copy())
    noisy.location.x = 3
    bpy.context.collection.objects.link(noisy)
    clean.select_set(False)
    noisy.select_set(True)
    bpy.context.view_layer.objects.active = noisy
    bpy.ops.object.framelet_add_noise()
    clean.select_set(True)
    return noisy, clean


def result():
    return bpy.context.window_manager.framelet_comparison


def test_operator_equals_core(pair):
    noisy, clean = pair
    expected = compare(mesh_bridge.read_surface(noisy), mesh_bridge.read_surface(clean))
    assert bpy.ops.object.framelet_compare() == {"FINISHED"}
    assert (result().object_name, result().other_name) == ("Noisy", "Clean")
    for name in ("mean_angle", "max_angle", "rms_distance", "max_distance"):
        assert getattr(result(), name) == np.float32(getattr(expected, name)), name
    edges = expected.rms_distance / expected.mean_edge_length
    assert result().rms_distance_edges == pytest.approx(edges, rel=1e-6)
    assert 0.1 < edges < 0.3
    assert result().flipped_faces == expected.flipped_faces


def test_other_by_name(pair):
    _noisy, clean = pair
    clean.select_set(False)
    assert bpy.ops.object.framelet_compare(other="Clean") == {"FINISHED"}
    assert result().other_name == "Clean"


def test_lengths_in_scene_units(pair):
    noisy, clean = pair
    expected = compare(mesh_bridge.read_surface(noisy), mesh_bridge.read_surface(clean))
    noisy.scale = (4, 4, 4)
    bpy.context.view_layer.update()
    bpy.ops.object.framelet_compare()
    assert result().rms_distance == pytest.approx(4 * expected.rms_distance, rel=1e-5)
    assert result().mean_angle == pytest.approx(expected.mean_angle, rel=1e-5)
    edges = expected.rms_distance / expected.mean_edge_length
    assert result().rms_distance_edges == pytest.approx(edges, rel=1e-5)


def test_reads_the_edit_session(pair):
    noisy, clean = pair
    clean.select_set(False)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.transform.translate(value=(1, 0, 0))
    assert bpy.ops.object.framelet_compare(other="Clean") == {"FINISHED"}
    assert result().rms_distance > 0.9
    assert noisy.mode == "EDIT"


def test_meshes_stay(pair):
    before = [mesh_bridge.read_surface(obj).vertices.tobytes() for obj in pair]
    bpy.ops.object.framelet_compare()
    assert [mesh_bridge.read_surface(obj).vertices.tobytes() for obj in pair] == before


def test_bad_pairs_get_a_sentence(pair):
    noisy, clean = pair
    with pytest.raises(RuntimeError, match="‘Gone’ is not an object"):
        bpy.ops.object.framelet_compare(other="Gone")
    clean.select_set(False)
    with pytest.raises(RuntimeError, match="‘Noisy’ needs one other selected mesh"):
        bpy.ops.object.framelet_compare()
    bpy.ops.mesh.primitive_cube_add()
    bpy.context.object.name = "Cube"
    bpy.ops.object.light_add()
    bpy.context.object.name = "Light"
    bpy.context.view_layer.objects.active = noisy
    with pytest.raises(RuntimeError, match=r"‘Noisy’ and ‘Cube’.*topology"):
        bpy.ops.object.framelet_compare(other="Cube")
    with pytest.raises(RuntimeError, match="‘Light’ is not a mesh"):
        bpy.ops.object.framelet_compare(other="Light")
    assert result().object_name == ""


def test_poll_needs_an_active_mesh():
    assert not bpy.ops.object.framelet_compare.poll()
    bpy.ops.object.light_add()
    assert not bpy.ops.object.framelet_compare.poll()
