# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The output Modifier: the mesh stays, what is moved is an attribute, and nodes add it."""

import subprocess
import sys

import bpy
import numpy as np
import pytest
from blender_objects import edit, noisy_monkey, read, select_only
from drawing import draw
from framelet.operators.mesh_io.mesh_bridge import read_positions
from framelet.operators.modifier import cage, node_groups
from framelet.operators.modifier.attributes import CAGE
from framelet.operators.modifier.inputs import get_input, input_property, set_input
from framelet.operators.modifier.offsets import offset_of
from framelet.operators.modifier.recipes import DISPLACEMENT, OURS
from framelet.operators.modifier.stack import find_modifier
from framelet.operators.run import run_memory
from framelet.operators.run.denoise_object import denoise_object
from framelet.ui.panels import output_panel, panel
from run_steps import QUICK, settle, turn_on


def shown(obj):
    """Return the positions of an object with its modifiers, shape (N, 3)."""
    graph = bpy.context.evaluated_depsgraph_get()
    return read_positions(obj.evaluated_get(graph).data)


def run(obj, **options):
    select_only(obj)
    found = {"preset": "POSITIONS", "output": "MODIFIER"} | options
    assert bpy.ops.object.framelet_denoise(**found) == {"FINISHED"}
    return find_modifier(obj, DISPLACEMENT)


@pytest.fixture
def pair():
    """A noisy object with the modifier, its positions, and those of the same one denoised in place."""
    twin = noisy_monkey("Twin")
    denoise_object(twin, QUICK)
    obj = noisy_monkey()
    before = read(obj)
    run(obj)
    return obj, before, read(twin)


def assert_no_trace(obj):
    mesh = obj.data
    assert not obj.modifiers and not bpy.data.node_groups and not mesh.keys()
    assert not [item.name for item in mesh.attributes if OURS.fullmatch(item.name)]


def test_the_mesh_stays_and_the_modifier_shows_the_result(pair):
    obj, before, after = pair
    assert read(obj).tobytes() == before.tobytes()
    assert np.allclose(shown(obj), after, atol=1e-6) and not np.allclose(after, before, atol=1e-3)
    assert np.array_equal(before + offset_of(obj, DISPLACEMENT), shown(obj))


def test_a_modifier_and_its_copy_are_applied_as_they_show(pair):
    obj, before, after = pair
    with bpy.context.temp_override(object=obj):
        bpy.ops.object.modifier_copy(modifier=find_modifier(obj, DISPLACEMENT).name)
    set_input(find_modifier(obj, DISPLACEMENT), "Amount", 0.5)
    both = shown(obj)
    assert np.allclose(both, before + 1.5 * (after - before), atol=1e-6)
    bpy.ops.object.framelet_apply_modifier()
    assert np.allclose(read(obj), both, atol=1e-6)
    assert_no_trace(obj)


@pytest.mark.parametrize("amount", [0.0, 0.3, 2.0])
def test_the_amount_is_linear_and_can_be_keyed(pair, amount):
    obj, before, after = pair
    modifier = find_modifier(obj, DISPLACEMENT)
    set_input(modifier, "Amount", amount)
    assert np.allclose(shown(obj), before + amount * (after - before), atol=1e-6)
    owner, key = input_property(modifier, "Amount")
    assert owner.keyframe_insert(key, frame=1)
    set_input(modifier, "Amount", 1.0)
    assert owner.keyframe_insert(key, frame=11)
    for frame, value in ((1, amount), (11, 1.0)):
        bpy.context.scene.frame_set(frame)
        assert np.allclose(shown(obj), before + value * (after - before), atol=1e-6)
    set_input(modifier, "On", False)
    assert np.array_equal(shown(obj), before)


def add_group(obj):
    group = obj.vertex_groups.new(name="Mask")
    group.add(list(range(100)), 0.25, "REPLACE")
    return np.repeat([0.25, 0.0], [100, 407])


def add_attribute(obj, kind="FLOAT", values=None):
    values = np.linspace(0, 1, 507) if values is None else values
    obj.data.attributes.new("Mask", kind, "POINT").data.foreach_set("value", values)
    return values


@pytest.mark.parametrize("make", [add_group, add_attribute])
@pytest.mark.parametrize("is_inverted", [False, True])
def test_masks_are_vertex_groups_or_attributes(pair, make, is_inverted):
    obj, before, after = pair
    modifier = find_modifier(obj, DISPLACEMENT)
    weights = make(obj)
    set_input(modifier, "Mask", "Mask")
    set_input(modifier, "Invert", is_inverted)
    share = (1 - weights if is_inverted else weights)[:, None]
    assert np.allclose(shown(obj), before + share * (after - before), atol=1e-6)
    assert np.allclose(before + offset_of(obj, DISPLACEMENT), shown(obj), atol=1e-7)
    set_input(modifier, "Mask", "None of these")
    assert np.allclose(shown(obj), after, atol=1e-6)


@pytest.mark.parametrize("kind", ["INT", "BOOLEAN"])
def test_masks_of_whole_numbers(pair, kind):
    obj, before, _ = pair
    add_attribute(obj, kind, np.arange(507) % 2)
    set_input(find_modifier(obj, DISPLACEMENT), "Mask", "Mask")
    assert np.allclose(before + offset_of(obj, DISPLACEMENT), shown(obj), atol=1e-7)
    assert np.array_equal(shown(obj)[::2], before[::2]) and not np.array_equal(shown(obj), before)


def test_the_mask_of_sculpt_mode_is_copied(pair):
    obj, before, after = pair
    with pytest.raises(RuntimeError, match="no mask of Sculpt Mode"):
        bpy.ops.object.framelet_sculpt_mask()
    values = np.linspace(0, 1, 507)
    obj.data.attributes.new(".sculpt_mask", "FLOAT", "POINT").data.foreach_set("value", values)
    assert "object.framelet_sculpt_mask" in draw(output_panel.VIEW3D_PT_framelet_output)["operator"]
    assert bpy.ops.object.framelet_sculpt_mask() == {"FINISHED"}
    assert np.allclose(shown(obj), before + (1 - values)[:, None] * (after - before), atol=1e-6)
    bpy.ops.object.framelet_clear()
    assert_no_trace(obj)


def test_a_mask_that_python_cannot_read_is_named(pair):
    obj, _, _ = pair
    obj.data.attributes.new("Mask", "FLOAT_COLOR", "POINT")
    set_input(find_modifier(obj, DISPLACEMENT), "Mask", "Mask")
    before = read(obj).tobytes()
    with pytest.raises(RuntimeError, match="The mask ‘Mask’ of ‘Monkey’ is not numbers at the vertices"):
        bpy.ops.object.framelet_apply_modifier()
    assert read(obj).tobytes() == before and find_modifier(obj, DISPLACEMENT)


def test_apply_leaves_the_result_and_nothing_else(pair):
    obj, _, _ = pair
    set_input(find_modifier(obj, DISPLACEMENT), "Amount", 0.5)
    expected = shown(obj)
    assert bpy.ops.object.framelet_apply_modifier() == {"FINISHED"}
    assert np.array_equal(read(obj), expected)
    assert_no_trace(obj)
    with pytest.raises(RuntimeError, match="no modifier of Framelet"):
        bpy.ops.object.framelet_apply_modifier()


@pytest.mark.parametrize("name", ["framelet_remove_modifier", "framelet_clear"])
def test_remove_and_clear_leave_the_mesh_as_it_was(pair, name):
    obj, before, _ = pair
    assert getattr(bpy.ops.object, name)() == {"FINISHED"}
    assert read(obj).tobytes() == before.tobytes()
    assert_no_trace(obj)


def test_clear_finds_what_is_left_of_a_modifier_that_was_deleted_by_hand(pair):
    obj, _, _ = pair
    obj.modifiers.clear()
    assert bpy.ops.object.framelet_clear() == {"FINISHED"}
    assert CAGE not in obj.data and not [i.name for i in obj.data.attributes if OURS.fullmatch(i.name)]


def test_groups_are_shared_and_go_with_the_last_user():
    first, second = noisy_monkey("A"), noisy_monkey("B")
    for obj in (first, second):
        run(obj)
    assert len(bpy.data.node_groups) == 1 and bpy.data.node_groups[0].users == 2
    select_only(first)
    bpy.ops.object.framelet_remove_modifier()
    assert len(bpy.data.node_groups) == 1
    select_only(second)
    bpy.ops.object.framelet_apply_modifier()
    assert not bpy.data.node_groups


def test_groups_of_other_versions_are_replaced_and_inputs_stay(pair, monkeypatch):
    obj, _before, _after = pair
    modifier = find_modifier(obj, DISPLACEMENT)
    old = modifier.node_group
    set_input(modifier, "Amount", 0.5)
    monkeypatch.setattr(node_groups, "VERSION", node_groups.VERSION + 1)
    assert find_modifier(obj, DISPLACEMENT) == modifier
    old_name = old.name
    run(obj, lambda_=0.2)
    assert [group.name for group in bpy.data.node_groups] != [old_name]
    assert len(bpy.data.node_groups) == 1 and get_input(find_modifier(obj, DISPLACEMENT), "Amount") == 0.5


def test_all_objects_of_a_mesh_get_it_and_lose_it():
    obj = noisy_monkey()
    twin = bpy.data.objects.new("Twin", obj.data)
    bpy.context.collection.objects.link(twin)
    run(obj, amount=0.75)
    assert [get_input(find_modifier(each, DISPLACEMENT), "Amount") for each in (obj, twin)] == [0.75, 0.75]
    assert np.array_equal(shown(obj), shown(twin))
    bpy.ops.object.framelet_apply_modifier()
    assert_no_trace(obj)
    assert_no_trace(twin)


def test_running_again_replaces_the_displacement_and_keeps_the_inputs(pair):
    obj, before, _after = pair
    set_input(find_modifier(obj, DISPLACEMENT), "Amount", 0.5)
    run(obj, lambda_=0.1)
    assert len(obj.modifiers) == 1 and read(obj).tobytes() == before.tobytes()
    set_input(find_modifier(obj, DISPLACEMENT), "Amount", 1.0)
    twin = noisy_monkey("Twin")
    denoise_object(twin, QUICK.with_changes(lambda_=0.1))
    assert np.allclose(shown(obj), read(twin), atol=1e-6)


@pytest.mark.parametrize("output", ["IN_PLACE", "SHAPE_KEY", "NEW_OBJECT"])
def test_another_output_takes_its_place(pair, output, capfd):
    obj, _before, after = pair
    bpy.ops.object.framelet_denoise(preset="POSITIONS", output=output)
    result = bpy.context.object
    assert find_modifier(result, DISPLACEMENT) is None
    assert np.allclose(shown(result), after, atol=1e-6)
    assert "; the modifier of the run before was removed" in capfd.readouterr().out
    if output == "NEW_OBJECT":
        assert find_modifier(obj, DISPLACEMENT) and np.allclose(shown(obj), after, atol=1e-6)
    else:
        assert_no_trace(obj)


def test_in_edit_mode_selected_vertices_move():
    obj = noisy_monkey()
    before = read(obj)
    chosen = np.arange(507) < 200
    edit(obj, select=chosen)
    assert bpy.ops.object.framelet_denoise(preset="POSITIONS", output="MODIFIER") == {"FINISHED"}
    added = offset_of(obj, DISPLACEMENT)
    bpy.ops.object.mode_set(mode="OBJECT")
    assert read(obj).tobytes() == before.tobytes()
    assert np.array_equal(before + added, shown(obj))
    moved = (shown(obj) != before).any(axis=1)
    assert moved[chosen].any() and not moved[~chosen].any()
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.object.framelet_remove_modifier()
    bpy.ops.object.mode_set(mode="OBJECT")
    assert_no_trace(obj)


@pytest.mark.parametrize("output", ["MODIFIER", "IN_PLACE"])
def test_parts_one_after_the_other(output):
    """A second run on another part leaves what the first one moved."""
    obj = noisy_monkey()
    before = read(obj)
    first, second = np.arange(507) < 200, np.arange(507) >= 300
    edit(obj, select=first)
    bpy.ops.object.framelet_denoise(preset="POSITIONS", output="MODIFIER")
    moved_once = before + offset_of(obj, DISPLACEMENT)
    edit(obj, select=second)
    bpy.ops.object.framelet_denoise(preset="POSITIONS", output=output)
    bpy.ops.object.mode_set(mode="OBJECT")
    assert np.allclose(shown(obj)[first], moved_once[first], atol=1e-7)
    assert np.allclose(shown(obj)[200:300], before[200:300], atol=1e-7)
    assert np.abs(shown(obj) - before)[second].max() > 0.01
    assert (find_modifier(obj, DISPLACEMENT) is None) == (output == "IN_PLACE")


def test_a_group_after_another():
    obj = noisy_monkey()
    for name, members in (("One", range(200)), ("Two", range(300, 507))):
        obj.vertex_groups.new(name=name).add(list(members), 1.0, "REPLACE")
    run(obj, vertex_group="One")
    once = shown(obj)
    run(obj, vertex_group="Two")
    assert np.allclose(shown(obj)[:300], once[:300], atol=1e-7)
    assert np.abs(shown(obj) - once)[300:].max() > 0.01


def test_the_sidebar_makes_a_modifier_and_scripts_change_the_mesh():
    assert bpy.context.scene.framelet.output == "MODIFIER"
    obj = noisy_monkey()
    before = read(obj)
    values = draw(panel.VIEW3D_PT_framelet)["object.framelet_denoise"]
    assert values.output == "MODIFIER"
    bpy.ops.object.framelet_denoise(preset="POSITIONS")
    assert not obj.modifiers and read(obj).tobytes() != before.tobytes()


def test_it_comes_before_the_other_modifiers(pair):
    obj, _, _ = pair
    obj.modifiers.clear()
    bpy.ops.object.framelet_clear()
    obj.modifiers.new("Subdivision", "SUBSURF")
    run(obj)
    assert [item.type for item in obj.modifiers] == ["NODES", "SUBSURF"]
    subdivided = shown(obj)
    bpy.ops.object.framelet_apply_modifier()
    assert np.allclose(shown(obj), subdivided, atol=1e-6)


def test_keys_that_follow_move_along_when_it_is_applied():
    obj = noisy_monkey()
    obj.shape_key_add(name="Basis")
    key = obj.shape_key_add(name="Wide")
    for point in key.points:
        point.co.x *= 2
    obj.active_shape_key_index = 0
    run(obj)
    added = offset_of(obj, DISPLACEMENT)
    wide = np.array([point.co[:] for point in key.points])
    bpy.ops.object.framelet_apply_modifier()
    assert np.allclose([point.co[:] for point in key.points], wide + added, atol=1e-6)
    assert_no_trace(obj)


def test_files_open_where_there_is_no_framelet(pair, tmp_path):
    _obj, _, after = pair
    path = tmp_path / "saved.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    code = f"""
import bpy, numpy as np
bpy.ops.wm.open_mainfile(filepath={str(path)!r})
mesh = bpy.data.objects["Monkey"].evaluated_get(bpy.context.evaluated_depsgraph_get()).data
points = np.array([vertex.co[:] for vertex in mesh.vertices], np.float32)
np.save({str(tmp_path / "shown.npy")!r}, points)
"""
    subprocess.run([sys.executable, "-c", code], check=True, timeout=100, capture_output=True)
    assert np.allclose(np.load(tmp_path / "shown.npy"), after, atol=1e-6)


def words(obj):
    bpy.context.view_layer.update()
    return cage.cage_words(obj)


def test_a_change_of_the_mesh_is_said(pair):
    obj, _, _ = pair
    assert words(obj) == ""
    obj.data.vertices[3].co.x += 1
    obj.data.update()
    assert words(obj) == "The mesh was edited since; run it again"
    assert words(obj) in draw(output_panel.VIEW3D_PT_framelet_output)["label"]
    run(obj)
    assert words(obj) == ""
    edit(obj)
    bpy.ops.mesh.subdivide()
    assert words(obj) == "", "not while it is edited"
    bpy.ops.object.mode_set(mode="OBJECT")
    assert words(obj) == "Other vertices or faces since; run it again"
    run(obj)
    assert words(obj) == ""
    obj.modifiers.new("Array", "ARRAY")
    obj.modifiers.new("Smooth", "SMOOTH")
    obj.modifiers.move(2, 0)
    assert words(obj) == ""
    obj.modifiers.move(2, 0)
    assert words(obj) == "‘Array’ changes the vertices before; move it down"


def test_undo_and_redo(pair):
    obj, before, after = pair
    run(obj)
    bpy.ops.ed.undo_push(message="Run")
    bpy.ops.object.framelet_remove_modifier()
    bpy.ops.ed.undo_push(message="Remove")
    assert np.array_equal(shown(obj), before)
    bpy.ops.ed.undo()
    assert np.allclose(shown(bpy.data.objects["Monkey"]), after, atol=1e-6)
    bpy.ops.ed.redo()
    assert np.array_equal(shown(bpy.data.objects["Monkey"]), before)


def test_before_and_after_switch_the_modifier(pair):
    obj, before, after = pair
    assert run_memory.known_side(obj) == "AFTER"
    bpy.ops.object.framelet_before_after()
    assert np.array_equal(shown(obj), before) and run_memory.known_side(obj) == "BEFORE"
    bpy.ops.object.framelet_before_after(side="BEFORE")
    assert run_memory.known_side(obj) == "BEFORE"
    bpy.ops.object.framelet_before_after(side="AFTER")
    assert np.allclose(shown(obj), after, atol=1e-6)
    assert read(obj).tobytes() == before.tobytes()


def test_a_new_result_is_shown_though_the_old_one_was_not(pair):
    obj, _, after = pair
    bpy.ops.object.framelet_before_after(side="BEFORE")
    run(obj)
    assert np.allclose(shown(obj), after, atol=1e-6)


def test_the_heat_map_shows_what_the_modifier_adds(pair):
    obj, _, _ = pair
    assert bpy.ops.object.framelet_heat_map(quantity="LENGTH") == {"FINISHED"}
    found = bpy.context.window_manager.framelet_band_range
    assert found.largest == pytest.approx(
        np.linalg.norm(offset_of(obj, DISPLACEMENT), axis=1).max(), rel=1e-3
    )


@pytest.mark.usefixtures("no_thread_stays")
def test_the_preview_shows_the_new_result_alone(pair, settings):
    obj, before, _after = pair
    session = turn_on()
    settings.lambda_ = 0.9
    settle(session)
    twin = noisy_monkey("Twin")
    denoise_object(twin, QUICK.with_changes(lambda_=0.9))
    select_only(obj)
    assert np.allclose(shown(obj), read(twin), atol=1e-5)
    set_input(find_modifier(obj, DISPLACEMENT), "Amount", 0.5)
    settle(session)
    assert np.allclose(shown(obj), read(twin), atol=1e-5)
    settings.output = "MODIFIER"
    assert bpy.ops.object.framelet_apply_preview() == {"FINISHED"}
    assert read(obj).tobytes() == before.tobytes()
    assert np.allclose(shown(obj), before + 0.5 * (read(twin) - before), atol=1e-5)


def test_the_panel_has_the_amount_of_the_modifier(pair):
    obj, _, _ = pair
    _, key = input_property(find_modifier(obj, DISPLACEMENT), "Amount")
    assert key in draw(panel.VIEW3D_PT_framelet)["prop"]
    select_only(noisy_monkey("Other"))
    assert draw(panel.VIEW3D_PT_framelet)["prop"].count("amount") == 1
    select_only(obj)
    record = draw(output_panel.VIEW3D_PT_framelet_output)
    assert record["operator"] == ["object.framelet_apply_modifier", "object.framelet_remove_modifier"]
    assert record["object.framelet_apply_modifier"].kind == DISPLACEMENT


def test_linked_meshes_and_other_modes_are_refused():
    obj = noisy_monkey()
    bpy.ops.object.mode_set(mode="SCULPT")
    bpy.ops.sculpt.dynamic_topology_toggle()
    with pytest.raises(ValueError, match="‘Monkey’ is sculpted with Dyntopo"):
        denoise_object(obj, QUICK, output="MODIFIER")
