# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""One face set alone is denoised, in every mode where sets exist; it is picked or set by its number."""

import bpy
import numpy as np
import pytest

# isort: split
# This module exists once bpy was imported.
from blender_objects import edit
from framelet.core import PRESETS, Region, denoise
from framelet.operators.mesh_io import face_sets, mesh_bridge
from framelet.operators.mesh_io.mesh_bridge import read_surface as read
from mathutils import Vector
from meshes import faces_of, noisy, triangle_torus


@pytest.fixture
def torus(make_object, rng):
    return make_object(noisy(triangle_torus(), rng, 0.1))


@pytest.fixture
def inside(torus):
    """Give set 7 to the faces with x > 0 and set 3 to the others; the vertices of set 7 are returned."""
    faces = np.array(faces_of(read(torus)))
    right = (read(torus).vertices[faces][..., 0] > 0).all(axis=1)
    set_face_sets(torus, np.where(right, 7, 3))
    return np.isin(np.arange(len(torus.data.vertices)), faces[right])


def set_face_sets(obj, numbers):
    attribute = obj.data.attributes.new(face_sets.FACE_SET, "INT", "FACE")
    attribute.data.foreach_set("value", np.asarray(numbers, np.int32))


def run(**given):
    assert bpy.ops.object.framelet_denoise(preset="TRI_2", **given) == {"FINISHED"}


def moved(obj, before):
    return (read(obj).vertices != before).any(axis=1)


@pytest.mark.parametrize("mode", ["OBJECT", "SCULPT", "WEIGHT_PAINT"])
def test_only_the_set_moves(mode, torus, inside):
    surface = read(torus)
    expected = denoise(surface, PRESETS["TRI_2"].settings, movable=inside).vertices
    bpy.ops.object.mode_set(mode=mode)
    run(face_set=7)
    np.testing.assert_array_equal(read(torus).vertices, expected)
    assert not moved(torus, surface.vertices)[~inside].any()
    assert moved(torus, surface.vertices)[inside].mean() > 0.9


def test_in_edit_mode_the_selection_of_the_set_moves(torus, inside):
    before = read(torus).vertices
    chosen = before[:, 1] > 0
    edit(torus, select=chosen)
    run(face_set=7)
    changed = moved(torus, before)
    assert not changed[~(inside & chosen)].any()
    assert changed[inside & chosen].mean() > 0.9


def test_both_sets_one_after_the_other_clean_all(torus, inside):
    """Vertices on the border belong to both, so that no noise stays between the sets."""
    before = read(torus).vertices
    run(face_set=7)
    run(face_set=3)
    assert moved(torus, before).all()


def test_masked_and_hidden_vertices_of_the_set_stay(torus, inside):
    before = read(torus).vertices
    hidden = np.zeros(len(torus.data.polygons), bool)
    hidden[:40] = True
    torus.data.polygons.foreach_set("hide", hidden)
    torus.data.update()
    run(face_set=7)
    of_hidden = np.isin(np.arange(len(before)), np.array(faces_of(read(torus)))[hidden])
    changed = moved(torus, before)
    assert not changed[of_hidden | ~inside].any()
    assert changed[inside & ~of_hidden].mean() > 0.9


def test_a_set_that_is_not_there_is_refused_with_those_that_are(torus, inside):
    before = read(torus).vertices
    with pytest.raises(RuntimeError, match=r"‘Mesh’ has no face set 5; pick one .* or choose one of 3, 7."):
        bpy.ops.object.framelet_denoise(preset="TRI_2", face_set=5)
    assert not moved(torus, before).any()


def test_a_mesh_without_sets_is_one_set(torus):
    before = read(torus).vertices
    run(face_set=face_sets.DEFAULT)
    assert moved(torus, before).all()
    with pytest.raises(RuntimeError, match=r"has no face set 2; .* choose one of 1."):
        bpy.ops.object.framelet_denoise(preset="TRI_2", face_set=2)


def test_a_hidden_set_has_nothing_that_may_move(torus, inside):
    numbers = face_sets.read_face_sets(torus.data)
    torus.data.polygons.foreach_set("hide", numbers == 7)
    torus.data.update()
    with pytest.raises(RuntimeError, match="No vertex of face set 7 of ‘Mesh’ may move"):
        bpy.ops.object.framelet_denoise(preset="TRI_2", face_set=7)


@pytest.mark.parametrize("mode", ["OBJECT", "SCULPT"])
def test_the_set_under_the_mouse(mode, torus, inside):
    torus.location, torus.scale = (1, 2, 3), (2, 1, 0.5)
    bpy.ops.object.mode_set(mode=mode)
    bpy.context.view_layer.update()
    graph = bpy.context.evaluated_depsgraph_get()
    for x, number in ((3.0, 7), (-3.0, 3), (0.2, None)):
        origin = torus.matrix_world @ Vector((x, 0.2, 9.0))
        assert face_sets.face_set_under(torus, graph, origin, Vector((0, 0, -1))) == number


def test_the_set_under_the_mouse_is_seen_through_modifiers(torus, inside):
    torus.modifiers.new("Subdivision", "SUBSURF").levels = 1
    graph = bpy.context.evaluated_depsgraph_get()
    for x, number in ((3.0, 7), (-3.0, 3)):
        found = face_sets.face_set_under(torus, graph, Vector((x, 0.2, 9.0)), Vector((0, 0, -1)))
        assert found == number


def test_a_mesh_without_sets_shows_the_only_one(torus):
    graph = bpy.context.evaluated_depsgraph_get()
    found = face_sets.face_set_under(torus, graph, Vector((3.0, 0.2, 9.0)), Vector((0, 0, -1)))
    assert found == face_sets.DEFAULT


def test_spikes_come_down_with_the_switch(torus):
    vertices = read(torus).vertices.copy()
    vertices[50] *= 4.0
    mesh_bridge.write_vertices(torus, read(torus), vertices)
    surface, settings = read(torus), PRESETS["TRI_2"].settings
    expected = denoise(surface, settings, region=Region(flatten_spikes=True)).vertices
    assert np.linalg.norm(expected[50] - denoise(surface, settings).vertices[50]) > 0.5
    run(flatten_spikes=True)
    np.testing.assert_array_equal(read(torus).vertices, expected)
