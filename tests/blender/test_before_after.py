# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Before/After flips meshes bit by bit, survives undo, and refuses what was changed meanwhile."""

import bpy
import meshes
import numpy as np
import pytest
from checks import assert_same_bits
from framelet.operators.before_after import OBJECT_OT_framelet_before_after as Operator
from framelet.operators.mesh_io import mesh_bridge
from framelet.operators.run import run_memory


@pytest.fixture(autouse=True)
def no_memory():
    run_memory.forget_runs()
    yield
    run_memory.forget_runs()


@pytest.fixture
def torus(make_object, rng):
    return make_object(meshes.noisy(meshes.triangle_torus(), rng), "Torus")


def positions(obj):
    return mesh_bridge.read_surface(obj).vertices


def select(*objects):
    bpy.ops.object.select_all(action="DESELECT")
    for obj in objects:
        obj.select_set(True)
    bpy.context.view_layer.objects.active = objects[0]


def denoise(**options):
    assert bpy.ops.object.framelet_denoise(preset="TRI_2", **options) == {"FINISHED"}


def flip():
    assert bpy.ops.object.framelet_before_after() == {"FINISHED"}


def test_flipping_is_exact_and_repeats(torus, capfd):
    # A negative zero shows whether bits are kept.
    torus.data.vertices[3].co.z = -0.0
    before = positions(torus)
    denoise()
    after = positions(torus)
    assert not np.array_equal(before, after)
    for _ in range(2):
        flip()
        assert_same_bits(positions(torus), before)
        assert "Showing ‘Torus’ before denoising" in capfd.readouterr().out
        flip()
        assert_same_bits(positions(torus), after)
        assert "Showing ‘Torus’ after denoising" in capfd.readouterr().out


def test_nothing_but_positions_is_stored(torus):
    names = {item.name for item in torus.data.attributes}
    denoise()
    flip()
    assert {item.name for item in torus.data.attributes} == names and not torus.data.keys()


def test_flipping_in_edit_mode(torus):
    before = positions(torus)
    bpy.ops.object.mode_set(mode="EDIT")
    denoise()
    after = positions(torus)
    flip()
    assert_same_bits(positions(torus), before)
    bpy.ops.object.mode_set(mode="OBJECT")
    assert_same_bits(positions(torus), before)
    flip()
    assert_same_bits(positions(torus), after)


def test_shape_keys_that_follow_are_exact_too(torus, rng):
    torus.shape_key_add(name="Basis")
    for name in ("One", "Two"):
        key = torus.shape_key_add(name=name)
        points = positions(torus) + rng.normal(0, 0.37, (len(key.points), 3)).astype(np.float32)
        key.points.foreach_set("co", points.reshape(-1))
    torus.data.shape_keys.key_blocks["Two"].relative_key = torus.data.shape_keys.key_blocks["One"]

    def everything():
        found = {key.name: np.array([point.co[:] for point in key.points]) for key in keys}
        return found | {"mesh": np.array([vertex.co[:] for vertex in torus.data.vertices])}

    keys = torus.data.shape_keys.key_blocks
    for active in (0, 1):
        torus.active_shape_key_index = active
        before = everything()
        denoise()
        after = everything()
        assert (before["Two"] != after["Two"]).any()
        for expected in (before, after, before):
            flip()
            for name, points in everything().items():
                assert np.array_equal(points, expected[name]), (active, name)


def test_a_follower_that_was_edited_keeps_its_edit(torus):
    torus.shape_key_add(name="Basis")
    key = torus.shape_key_add(name="Key")
    torus.active_shape_key_index = 0
    denoise()
    key.points[5].co.x += 2.0
    edited = np.array([point.co[:] for point in key.points])
    flip()
    assert (
        abs(key.points[5].co.x - edited[5, 0]) < 1.0
        and key.points[5].co.x > 1.0 + torus.data.vertices[5].co.x
    )
    flip()
    assert np.allclose([point.co[:] for point in key.points], edited, atol=1e-6)


def test_undoing_the_run_leaves_a_way_forward(torus):
    bpy.ops.ed.undo_push(message="Before")
    before = positions(torus)
    denoise()
    bpy.ops.ed.undo_push(message="Denoise")
    after = positions(torus)
    bpy.ops.ed.undo()
    obj = bpy.data.objects["Torus"]
    assert_same_bits(positions(obj), before)
    select(obj)
    flip()
    assert_same_bits(positions(obj), after)


def test_flipping_is_one_undo_step(torus):
    denoise()
    after = positions(torus)
    bpy.ops.ed.undo_push(message="Denoise")
    flip()
    bpy.ops.ed.undo_push(message="Flip")
    bpy.ops.ed.undo()
    assert_same_bits(positions(bpy.data.objects["Torus"]), after)
    assert Operator.bl_options == {"REGISTER", "UNDO"}


def test_several_meshes_go_to_the_same_side(torus, make_object, rng):
    second = make_object(meshes.noisy(meshes.quad_torus(), rng), "Second")
    before = positions(torus), positions(second)
    select(torus, second)
    denoise()
    select(second)
    flip()
    select(torus, second)
    flip()
    for obj, expected in zip((torus, second), before, strict=True):
        assert_same_bits(positions(obj), expected)


@pytest.mark.parametrize(
    "change",
    [
        lambda mesh: setattr(mesh.vertices[0], "co", (9, 9, 9)),
        lambda mesh: mesh.vertices.add(1),
        lambda mesh: mesh.transform(((2, 0, 0, 0), (0, 2, 0, 0), (0, 0, 2, 0), (0, 0, 0, 1))),
    ],
    ids=["a vertex moved", "a vertex added", "all scaled"],
)
def test_a_mesh_that_was_changed_gets_a_sentence(torus, change):
    denoise()
    change(torus.data)
    present = positions(torus)
    with pytest.raises(
        RuntimeError, match=r"‘Torus’ was changed since it was denoised.*; denoise it again\."
    ):
        bpy.ops.object.framelet_before_after()
    assert_same_bits(positions(torus), present)


def test_meshes_that_were_not_denoised_are_named(torus, make_object, rng, capfd):
    denoise()
    other = make_object(meshes.triangle_grid(), "Other")
    select(torus, other)
    flip()
    assert "Warning: ‘Other’ was not denoised since this file was opened" in capfd.readouterr().out


def test_poll_says_why_not(torus):
    with pytest.raises(RuntimeError, match="Denoise a selected mesh first"):
        bpy.ops.object.framelet_before_after()
    denoise()
    assert bpy.ops.object.framelet_before_after.poll()
    torus.select_set(False)
    with pytest.raises(RuntimeError, match="Select at least one mesh object"):
        bpy.ops.object.framelet_before_after()
    torus.select_set(True)
    bpy.ops.object.mode_set(mode="SCULPT")
    assert bpy.ops.object.framelet_before_after.poll()


def test_opening_a_file_forgets(torus):
    denoise()
    assert run_memory.is_remembered(torus)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    assert run_memory._runs == {}
    assert not run_memory.is_remembered(None)


def test_the_oldest_are_forgotten_first(make_object, rng, monkeypatch):
    objects = []
    monkeypatch.setattr(run_memory, "MOST_BYTES", 2 * 24 * meshes.triangle_torus().n_vertices)
    for name in "ABC":
        objects.append(make_object(meshes.noisy(meshes.triangle_torus(), rng), name))
        denoise()
    assert [run_memory.is_remembered(obj) for obj in objects] == [False, True, True]
    monkeypatch.setattr(run_memory, "MOST_BYTES", 0)
    denoise()
    assert [run_memory.is_remembered(obj) for obj in objects] == [False, False, True]


def test_a_run_that_moves_nothing_can_be_flipped(make_object):
    obj = make_object(meshes.triangle_torus(), "Clean")
    bpy.ops.object.framelet_denoise(preset="POSITIONS", lambda_=0.0)
    present = positions(obj)
    flip()
    assert_same_bits(positions(obj), present)
