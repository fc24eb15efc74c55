# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The button where artists are: Sculpt Mode, painting modes, masks and hidden faces."""

import bpy
import numpy as np
import pytest
from framelet.operators.mesh_io import mesh_bridge
from framelet.operators.mesh_io.mesh_bridge import read_surface as read
from meshes import noisy, triangle_torus

PAINTING = ("VERTEX_PAINT", "WEIGHT_PAINT", "TEXTURE_PAINT")


@pytest.fixture
def torus(make_object, rng):
    return make_object(noisy(triangle_torus(), rng, 0.1))


def run(**given):
    assert bpy.ops.object.framelet_denoise(preset="TRI_2", **given) == {"FINISHED"}


def refused(**given):
    with pytest.raises(RuntimeError) as caught:
        bpy.ops.object.framelet_denoise(preset="TRI_2", **given)
    return str(caught.value)


def set_mask(obj, mask):
    attribute = obj.data.attributes.new(".sculpt_mask", "FLOAT", "POINT")
    attribute.data.foreach_set("value", np.asarray(mask, np.float32))


def hide_faces(obj, hidden):
    obj.data.polygons.foreach_set("hide", hidden)
    obj.data.update()


def moved(obj, before):
    return (read(obj).vertices != before).any(axis=1)


def right_half(obj):
    return read(obj).vertices[:, 0] > 0.0


@pytest.mark.parametrize("mode", ["SCULPT", *PAINTING])
def test_the_result_is_the_same_in_every_mode(torus, mode):
    before = read(torus).vertices
    run()
    expected = read(torus).vertices
    assert (expected != before).any()
    mesh_bridge.write_vertices(torus, read(torus), before)
    bpy.ops.object.mode_set(mode=mode)
    assert torus.mode == mode
    run()
    assert torus.mode == mode
    np.testing.assert_array_equal(read(torus).vertices, expected)
    bpy.ops.object.mode_set(mode="OBJECT")
    np.testing.assert_array_equal(read(torus).vertices, expected)


@pytest.mark.parametrize("mode", ["OBJECT", "SCULPT", "WEIGHT_PAINT"])
def test_masked_vertices_stay_bit_for_bit(torus, mode):
    before, mask = read(torus).vertices, right_half(torus)
    set_mask(torus, mask)
    bpy.ops.object.mode_set(mode=mode)
    run()
    changed = moved(torus, before)
    assert not changed[mask].any()
    assert changed[~mask].mean() > 0.9


def test_a_half_mask_halves_the_way(torus):
    before = read(torus).vertices
    run(repair_folds=False)
    full = read(torus).vertices - before
    mesh_bridge.write_vertices(torus, read(torus), before)
    set_mask(torus, np.full(len(before), 0.5))
    run(repair_folds=False)
    np.testing.assert_allclose(read(torus).vertices - before, 0.5 * full, atol=1e-6)


def test_a_mask_can_be_left_out_of_account(torus):
    before, mask = read(torus).vertices, right_half(torus)
    set_mask(torus, mask)
    run(keep_mask=False)
    assert moved(torus, before)[mask].mean() > 0.9


def test_a_mask_and_a_group_both_limit(torus):
    before, mask = read(torus).vertices, right_half(torus)
    upper = before[:, 1] > 0.0
    group = torus.vertex_groups.new(name="Part")
    group.add(np.flatnonzero(upper).tolist(), 1.0, "REPLACE")
    set_mask(torus, mask)
    run(vertex_group="Part")
    changed = moved(torus, before)
    assert not changed[mask | ~upper].any()
    assert changed[upper & ~mask].mean() > 0.9


def test_where_all_is_masked_a_sentence_says_so(torus):
    set_mask(torus, np.ones(len(torus.data.vertices)))
    assert "All vertices of ‘Mesh’ that may move are masked" in refused()


@pytest.mark.parametrize("mode", ["OBJECT", "SCULPT"])
def test_hidden_faces_hold(torus, mode):
    surface = read(torus)
    centers = surface.vertices[surface.corner_vertex].reshape(-1, 3, 3).mean(axis=1)
    hidden = centers[:, 0] > 0.0
    held = np.zeros(surface.n_vertices, bool)
    held[surface.corner_vertex.reshape(-1, 3)[hidden]] = True
    bpy.ops.object.mode_set(mode=mode)
    hide_faces(torus, hidden)
    run()
    changed = moved(torus, surface.vertices)
    assert not changed[held].any()
    assert changed[~held].mean() > 0.9


def test_in_sculpt_mode_a_modifier_would_not_be_seen_and_the_mesh_itself_changes(torus):
    before = read(torus).vertices
    bpy.ops.object.mode_set(mode="SCULPT")
    run(output="MODIFIER")
    assert moved(torus, before).any()
    assert not torus.modifiers


def test_while_painting_the_modifier_is_added(torus):
    before = read(torus).vertices
    bpy.ops.object.mode_set(mode="WEIGHT_PAINT")
    run(output="MODIFIER")
    assert not moved(torus, before).any()
    assert len(torus.modifiers) == 1


def test_dyntopo_is_refused_with_the_way_out(torus):
    bpy.ops.object.mode_set(mode="SCULPT")
    bpy.ops.sculpt.dynamic_topology_toggle()
    assert torus.use_dynamic_topology_sculpting
    assert "Dyntopo; turn it off" in refused()
