# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""With Multires the finest level is denoised, and never the cage in silence."""

import bpy
import numpy as np
import pytest
from framelet.core import PRESETS, add_noise, denoise, equalize, estimate_noise
from framelet.core.mesh.geometry import mean_edge_length
from framelet.operators.mesh_io.mesh_bridge import read_surface
from framelet.operators.modifier.multires import level_object, reshape
from framelet.operators.preview.preview_session import begin_preview
from framelet.operators.properties.region_options import RegionOptions
from framelet.operators.run import run_guard
from framelet.operators.run.denoise_run import State, begin_run
from meshes import quad_torus

QUICK = PRESETS["QUAD_2"].settings


@pytest.fixture
def sculpt(make_object, rng):
    """A torus with three levels of Multires, of which the second is shown, and noise on the finest."""
    obj = make_object(quad_torus())
    modifier = obj.modifiers.new("Multires", "MULTIRES")
    for _ in range(3):
        bpy.ops.object.multires_subdivide(modifier="Multires")
    surface = level(obj)
    noise = rng.normal(0, 0.1 * mean_edge_length(surface), surface.vertices.shape)
    reshape(obj, surface.vertices + noise)
    modifier.levels = 2
    return obj


def level(obj):
    with level_object(obj) as found:
        return read_surface(found)


def shown(obj):
    """Return the positions that Level Viewport shows."""
    found = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    positions = np.empty(3 * len(found.vertices), np.float32)
    found.vertices.foreach_get("co", positions)
    return positions.reshape(-1, 3)


def run(**given):
    assert bpy.ops.object.framelet_denoise(preset="QUAD_2", **given) == {"FINISHED"}


def refused(**given):
    with pytest.raises(RuntimeError) as caught:
        bpy.ops.object.framelet_denoise(preset="QUAD_2", **given)
    return str(caught.value)


def counts():
    return len(bpy.data.objects), len(bpy.data.meshes), len(bpy.context.scene.collection.objects)


@pytest.mark.parametrize("output", ["IN_PLACE", "MODIFIER"])
def test_the_finest_level_is_denoised(sculpt, output, capfd):
    surface, before = level(sculpt), counts()
    assert surface.n_vertices == 64 * len(sculpt.data.vertices)
    run(output=output)
    expected = denoise(surface, QUICK).vertices
    assert np.abs(expected - surface.vertices).max() > 0.01
    np.testing.assert_allclose(level(sculpt).vertices, expected, atol=1e-5)
    assert counts() == before
    assert sculpt.modifiers.keys() == ["Multires"]
    assert "level 3 of Multires, the finest, was denoised" in capfd.readouterr().out


def test_coarser_levels_go_along(sculpt):
    modifier = sculpt.modifiers[0]
    fine, cage = level(sculpt).vertices, read_surface(sculpt).vertices
    coarse = shown(sculpt)
    run(amount=0.5)
    assert modifier.levels == 2
    assert read_surface(sculpt).vertices.tobytes() == cage.tobytes()
    assert 0.01 < np.abs(shown(sculpt) - coarse).max() < 2.0 * np.abs(level(sculpt).vertices - fine).max()


def test_the_amount_counts(sculpt):
    surface = level(sculpt)
    run(amount=0.5)
    moved = denoise(surface, QUICK).vertices.astype(float) - surface.vertices
    np.testing.assert_allclose(level(sculpt).vertices, surface.vertices + 0.5 * moved, atol=1e-5)


def test_other_modifiers_are_not_read(sculpt):
    surface = level(sculpt)
    sculpt.modifiers.new("Subdivision", "SUBSURF")
    sculpt.modifiers.new("Displace", "DISPLACE").strength = 3.0
    assert level(sculpt).vertices.tobytes() == surface.vertices.tobytes()
    run()
    expected = denoise(surface, QUICK).vertices
    np.testing.assert_allclose(level(sculpt).vertices, expected, atol=1e-5)


def test_a_new_object_leaves_the_original(sculpt):
    surface, cage = level(sculpt), read_surface(sculpt).vertices
    run(output="NEW_OBJECT")
    new = bpy.context.active_object
    assert new != sculpt and new.data != sculpt.data
    assert level(sculpt).vertices.tobytes() == surface.vertices.tobytes()
    assert read_surface(sculpt).vertices.tobytes() == cage.tobytes()
    np.testing.assert_allclose(level(new).vertices, denoise(surface, QUICK).vertices, atol=1e-5)


def test_a_vertex_group_limits_the_level(sculpt):
    sculpt.vertex_groups.new(name="Part").add(range(20), 1.0, "REPLACE")
    with level_object(sculpt) as found:
        weighted = np.array([sum(item.weight for item in each.groups) > 0 for each in found.data.vertices])
    before = level(sculpt).vertices
    run(vertex_group="Part")
    moved = np.abs(level(sculpt).vertices - before).max(axis=1)
    assert 0.1 < weighted.mean() < 0.9
    assert moved[~weighted].max() < 1e-5 < 0.01 < moved[weighted].max()


@pytest.mark.parametrize("mode", ["SCULPT", "EDIT"])
def test_other_modes_are_refused(sculpt, mode):
    surface = level(sculpt)
    bpy.ops.object.mode_set(mode=mode)
    assert "whose finest level is reached in Object Mode; switch to it, or apply the modifier" in refused()
    bpy.ops.object.mode_set(mode="OBJECT")
    assert level(sculpt).vertices.tobytes() == surface.vertices.tobytes()


def test_what_is_not_possible_is_said_with_the_ways_out(sculpt, settings):
    surface = level(sculpt)
    assert "have no shape keys; choose the output In Place or New" in refused(output="SHAPE_KEY")
    sculpt.modifiers[0].show_viewport = False
    assert "is not the first one or is off; move it to the top and turn it on, or apply it" in refused()
    sculpt.modifiers[0].show_viewport = True
    sculpt.modifiers.new("Displace", "DISPLACE")
    sculpt.modifiers.move(1, 0)
    assert "is not the first one or is off" in refused()
    sculpt.modifiers.move(0, 1)
    with pytest.raises(RuntimeError, match="of which there is no preview; press Denoise instead"):
        bpy.ops.object.framelet_preview()
    assert "has no vertex group ‘None’" in refused(vertex_group="None")
    assert "‘Mesh’" in refused(vertex_group="None")
    sculpt.shape_key_add(name="Basis")
    assert "and shape keys; apply the modifier, or remove the keys" in refused()
    sculpt.shape_key_clear()
    assert level(sculpt).vertices.tobytes() == surface.vertices.tobytes()


def test_a_preview_is_refused_by_its_function_too(sculpt):
    with pytest.raises(ValueError, match="there is no preview"):
        begin_preview(sculpt, QUICK, RegionOptions())


def test_a_modifier_without_levels_is_none(make_object):
    obj = make_object(quad_torus())
    obj.modifiers.new("Multires", "MULTIRES")
    before = read_surface(obj).vertices
    run()
    assert (read_surface(obj).vertices != before).any()


def test_a_run_is_dropped_when_the_level_changes(sculpt):
    surface = level(sculpt)
    started = begin_run([sculpt], QUICK)
    started.start()
    assert started.wait(60.0)
    reshape(sculpt, surface.vertices + np.array([0, 0, 0.5]))
    assert started.tick() is State.FAILED
    assert "was sculpted while Framelet was running" in started.reason
    started = begin_run([sculpt], QUICK)
    started.start()
    assert started.wait(60.0)
    bpy.ops.object.multires_higher_levels_delete(modifier="Multires")
    assert started.tick() is State.FAILED
    assert "The levels of ‘Mesh’ are others" in started.reason


def test_a_run_that_is_not_disturbed_is_written(sculpt):
    surface = level(sculpt)
    started = begin_run([sculpt], QUICK)
    started.start()
    assert started.wait(60.0)
    assert started.tick() is State.READY
    started.finish()
    np.testing.assert_allclose(level(sculpt).vertices, denoise(surface, QUICK).vertices, atol=1e-5)


def test_a_level_is_looked_at_once(sculpt, gate, no_thread_stays, monkeypatch):
    """Reading it counts as an edit, so that each look would ask for the next one."""
    looks, original = [], run_guard._is_same_level
    monkeypatch.setattr(run_guard, "_is_same_level", lambda *each: looks.append(each) or original(*each))
    started = begin_run([sculpt], QUICK)
    started.start()
    for _ in range(3):
        started.touch({sculpt.session_uid, sculpt.data.session_uid})
        assert started.tick() is State.RUNNING
    assert looks == []
    gate.set()
    assert started.wait(60.0)
    assert started.tick() is State.READY
    assert len(looks) == 1


def test_undo_takes_the_result_back(sculpt):
    before = level(sculpt).vertices
    bpy.ops.ed.undo_push(message="Before")
    run()
    after = level(sculpt).vertices
    bpy.ops.ed.undo_push(message="Denoise")
    bpy.ops.ed.undo()
    np.testing.assert_allclose(level(bpy.data.objects["Mesh"]).vertices, before, atol=1e-6)
    bpy.ops.ed.redo()
    np.testing.assert_allclose(level(bpy.data.objects["Mesh"]).vertices, after, atol=1e-6)


def test_noise_is_measured_on_the_finest_level(sculpt):
    expected = estimate_noise(level(sculpt))
    assert (
        expected.sigma_edges
        == pytest.approx(0.1, rel=0.1)
        != estimate_noise(read_surface(sculpt)).sigma_edges
    )
    assert bpy.ops.object.framelet_estimate_noise() == {"FINISHED"}
    found = bpy.context.window_manager.framelet_estimate.objects["Mesh"]
    assert found.sigma == pytest.approx(expected.sigma)


def test_noise_is_measured_where_the_level_may_move(sculpt):
    sculpt.vertex_groups.new(name="Part").add(range(20), 1.0, "REPLACE")
    bpy.ops.object.framelet_estimate_noise()
    whole = bpy.context.window_manager.framelet_estimate.objects["Mesh"].sigma
    bpy.context.scene.framelet.vertex_group = "Part"
    bpy.ops.object.framelet_estimate_noise()
    assert bpy.context.window_manager.framelet_estimate.objects["Mesh"].sigma != whole


def test_noise_is_added_to_the_finest_level(sculpt):
    surface, cage = level(sculpt), read_surface(sculpt).vertices
    assert bpy.ops.object.framelet_add_noise(sigma=0.2, seed=3) == {"FINISHED"}
    np.testing.assert_allclose(level(sculpt).vertices, add_noise(surface, 0.2, 3), atol=1e-5)
    assert read_surface(sculpt).vertices.tobytes() == cage.tobytes()


def test_the_finest_level_is_equalized(sculpt):
    surface, cage = level(sculpt), read_surface(sculpt).vertices
    assert bpy.ops.object.framelet_equalize(levels=2, gain_1=0.2, gain_2=0.5) == {"FINISHED"}
    expected = equalize(surface, (0.2, 0.5))
    assert np.abs(expected - surface.vertices).max() > 0.01
    np.testing.assert_allclose(level(sculpt).vertices, expected, atol=1e-5)
    assert read_surface(sculpt).vertices.tobytes() == cage.tobytes()


def test_a_spike_of_the_finest_level_is_flattened(sculpt):
    surface = level(sculpt)
    vertices = surface.vertices.copy()
    vertices[1000] *= 1.5
    reshape(sculpt, vertices)
    assert bpy.ops.object.framelet_flatten_spikes() == {"FINISHED"}
    assert np.abs(level(sculpt).vertices[1000] - surface.vertices[1000]).max() < 0.1


@pytest.mark.parametrize(
    ("name", "what"),
    [
        ("analyze", "whose levels have no bands that are kept; press Equalize, or apply the modifier first"),
        ("live_equalizer", "whose levels have no bands that are kept; press Equalize, or apply the modifier"),
        ("select_spikes", "whose levels have no selection; apply the modifier first"),
        ("select_islands", "whose levels have no selection; apply the modifier first"),
    ],
)
def test_what_levels_do_not_have_is_said(sculpt, name, what):
    surface = level(sculpt)
    with pytest.raises(RuntimeError, match=f"‘Mesh’ has a Multires modifier, {what}"):
        getattr(bpy.ops.object, f"framelet_{name}")()
    assert sculpt.mode == "OBJECT" and sculpt.modifiers.keys() == ["Multires"]
    assert level(sculpt).vertices.tobytes() == surface.vertices.tobytes()


@pytest.mark.parametrize("name", ["estimate_noise", "add_noise", "equalize", "flatten_spikes"])
@pytest.mark.parametrize("mode", ["SCULPT", "EDIT"])
def test_tools_name_object_mode_too(sculpt, name, mode):
    bpy.ops.object.mode_set(mode=mode)
    with pytest.raises(RuntimeError, match="whose finest level is reached in Object Mode"):
        getattr(bpy.ops.object, f"framelet_{name}")()
    bpy.ops.object.mode_set(mode="OBJECT")
