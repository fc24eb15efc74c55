# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The heat map shows what the last run changed, in scene units, and goes away without a trace."""

from math import radians

import bpy
import meshes
import numpy as np
import pytest
from framelet.core import noise_field
from framelet.core.metrics import compare
from framelet.operators.colors.colormaps import DIVERGING, SEQUENTIAL, map_colors
from framelet.operators.colors.heat_values import heat_values
from framelet.operators.mesh_io import band_storage, mesh_bridge
from framelet.operators.run import run_memory


@pytest.fixture(autouse=True)
def no_memory():
    run_memory.forget_runs()
    yield
    run_memory.forget_runs()


@pytest.fixture
def torus(make_object, rng):
    obj = make_object(meshes.noisy(meshes.flipped(meshes.triangle_torus()), rng), "Torus")
    bpy.ops.object.framelet_denoise(preset="TRI_2")
    return obj


def write_and_remember(obj, surface, vertices):
    positions = mesh_bridge.write_vertices(obj, surface, vertices)
    run_memory.remember(obj, surface, positions, {})


def shown():
    return bpy.context.window_manager.framelet_band_range


def colors(obj):
    attribute = obj.data.color_attributes["framelet_heat_map"]
    values = np.empty((len(attribute.data), 4), np.float32)
    attribute.data.foreach_get("color", values.reshape(-1))
    return values


def last_run(obj):
    return run_memory.recall(obj).run


def slow_angles(obj):
    """Angles of triangles between before and after, one at a time, by the arc cosine."""
    run, angles = last_run(obj), []
    for face in obj.data.polygons:
        normals = []
        for positions in (run.before, run.after):
            a, b, c = positions[list(face.vertices)].astype(np.float64)
            normal = np.cross(b - a, c - a)
            normals.append(normal / np.linalg.norm(normal))
        angles.append(np.degrees(np.arccos(np.clip(normals[0] @ normals[1], -1, 1))))
    return np.array(angles)


def test_a_sphere_that_grows_is_red_and_one_that_shrinks_is_blue():
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=4)
    obj = bpy.context.object
    surface = mesh_bridge.read_surface(obj)
    for factor, sign in ((1.25, 1), (0.75, -1)):
        write_and_remember(obj, surface, surface.vertices * factor)
        values = heat_values(obj, "NORMAL").values
        radius = np.linalg.norm(surface.vertices, axis=1)
        assert np.allclose(values, sign * 0.25 * radius, rtol=0.02)
        assert np.allclose(heat_values(obj, "LENGTH").values, 0.25 * radius, rtol=1e-5)
        assert np.allclose(heat_values(obj, "ANGLE").values, 0.0, atol=1e-4)
        bpy.ops.object.framelet_heat_map()
        red, blue = colors(obj)[:, 0], colors(obj)[:, 2]
        assert ((red > 2 * blue) if sign > 0 else (blue > 2 * red)).all()
        surface = surface.with_vertices(mesh_bridge.read_surface(obj).vertices)


def test_the_normals_are_those_of_the_result(torus):
    from framelet.core.mesh.geometry import vertex_normals

    run = last_run(torus)
    normals = vertex_normals(mesh_bridge.read_surface(torus).with_vertices(run.after.astype(np.float64)))
    expected = ((run.after.astype(np.float64) - run.before) * normals).sum(axis=1)
    assert (expected > 0).any() and (expected < 0).any()
    assert np.allclose(heat_values(torus, "NORMAL").values, expected, atol=1e-7)
    bpy.ops.object.framelet_heat_map()
    limit = np.percentile(np.abs(expected), 98)
    assert shown().maximum == pytest.approx(limit) and shown().minimum == -shown().maximum
    assert (shown().objects.keys(), shown().quantity, shown().is_signed) == (["Torus"], "NORMAL", True)
    assert np.allclose(colors(torus), map_colors(DIVERGING, expected / limit), atol=1e-5)


def test_values_are_in_scene_units_and_turn_with_the_object(torus):
    values = {name: heat_values(torus, name).values for name in ("NORMAL", "LENGTH", "ANGLE")}
    torus.scale = (3, 3, 3)
    torus.rotation_euler = (1, 2, 3)
    bpy.context.view_layer.update()
    for name, factor in (("NORMAL", 3), ("LENGTH", 3), ("ANGLE", 1)):
        assert np.allclose(heat_values(torus, name).values, factor * values[name], rtol=1e-4, atol=1e-5)
    torus.scale = (-1, 1, 1)
    bpy.context.view_layer.update()
    # What points outwards in the mesh also does so in its mirror image.
    assert np.allclose(heat_values(torus, "NORMAL").values, values["NORMAL"], atol=1e-6)


def test_angles_are_those_of_the_faces(torus):
    angles = heat_values(torus, "ANGLE").values
    assert np.allclose(angles, np.repeat(slow_angles(torus), 3), atol=1e-3)
    surface, run = mesh_bridge.read_surface(torus), last_run(torus)
    comparison = compare(surface.with_vertices(run.after), surface.with_vertices(run.before))
    assert angles.mean() == pytest.approx(comparison.mean_angle)
    bpy.ops.object.framelet_heat_map(quantity="ANGLE", range_rule="MAXIMUM")
    assert shown().unit == "ANGLE" and not shown().is_signed and shown().minimum == 0
    assert shown().maximum == pytest.approx(comparison.max_angle)
    attribute = torus.data.attributes["framelet_heat_map"]
    assert (attribute.data_type, attribute.domain) == ("FLOAT_COLOR", "CORNER")
    assert np.allclose(colors(torus), map_colors(SEQUENTIAL, angles / comparison.max_angle), atol=1e-5)
    # All corners of a face look the same.
    assert (np.ptp(colors(torus).reshape(-1, 3, 4), axis=1) == 0).all()


def numbers(obj, name):
    attribute = obj.data.attributes[name]
    assert (attribute.data_type, attribute.domain) == ("FLOAT", "POINT")
    values = np.empty(len(attribute.data), np.float32)
    attribute.data.foreach_get("value", values)
    return values


@pytest.mark.parametrize("preset", ["AUTO", "TRI_2"])
def test_the_noise_map_is_the_field_of_the_noise(make_object, rng, preset):
    obj = make_object(meshes.noisy(meshes.triangle_torus(), rng), "Torus")
    before = mesh_bridge.read_surface(obj)
    bpy.ops.object.framelet_denoise(preset=preset)
    field = noise_field(before, mesh_bridge.read_surface(obj).vertices)
    for quantity, name, expected in (("NOISE", "", field.strength), ("WIDTH", "_width", field.width)):
        assert np.array_equal(heat_values(obj, quantity).values, expected)
        assert bpy.ops.object.framelet_heat_map(quantity=quantity) == {"FINISHED"}
        assert np.array_equal(numbers(obj, f"framelet_noise{name}"), expected)
        limit = np.percentile(expected, 98)
        assert shown().maximum == pytest.approx(limit) and not shown().is_signed
        assert np.allclose(colors(obj), map_colors(SEQUENTIAL, expected / (limit or 1.0)), atol=1e-5)
    assert field.strength.min() > 0


def test_a_bump_is_wide_noise_and_grain_is_not(make_object, rng):
    obj = make_object(meshes.triangle_grid(21, 21), "Grid")
    surface = mesh_bridge.read_surface(obj)
    x, y, _ = surface.vertices.T
    edge = compare(surface, surface).mean_edge_length
    for heights, least, most in (
        (np.sin(0.6 * x / edge) * np.sin(0.6 * y / edge), 1.0, 5.0),
        (rng.normal(size=len(x)), 0.0, 0.4),
    ):
        moved = surface.vertices + np.stack([0 * x, 0 * x, 0.05 * edge * heights], axis=1).astype(np.float32)
        bumpy = mesh_bridge.read_surface(obj)
        write_and_remember(obj, bumpy.with_vertices(moved), surface.vertices)
        assert least <= np.median(heat_values(obj, "WIDTH").values) <= most
        assert np.median(heat_values(obj, "NOISE").values) == pytest.approx(
            0.05 * edge * np.sqrt(np.mean(heights**2)), rel=0.2
        )


def test_the_noise_map_is_in_scene_units_and_its_width_in_edges(torus):
    noise, width = (heat_values(torus, name).values for name in ("NOISE", "WIDTH"))
    torus.scale, torus.rotation_euler = (-3, 3, 3), (1, 2, 3)
    bpy.context.view_layer.update()
    assert np.allclose(heat_values(torus, "NOISE").values, 3 * noise, rtol=1e-3)
    assert np.allclose(heat_values(torus, "WIDTH").values, width, atol=1e-2)


def test_the_noise_stays_as_a_mask_until_all_is_cleared(torus):
    torus.data.attributes.new("framelet_noise", "INT", "FACE")  # as a script may have done
    with pytest.raises(
        RuntimeError, match="framelet_noise of ‘Torus’ is INT on FACE instead of FLOAT on POINT"
    ):
        bpy.ops.object.framelet_heat_map(quantity="NOISE")
    torus.data.attributes["framelet_noise"].name = "script"
    bpy.ops.object.framelet_heat_map(quantity="NOISE")
    first = numbers(torus, "framelet_noise")
    bpy.ops.object.framelet_denoise(preset="TRI_1")
    second = numbers(torus, "framelet_noise")
    assert not np.array_equal(first, second)
    assert np.array_equal(second, heat_values(torus, "NOISE").values.astype(np.float32))
    bpy.ops.object.framelet_heat_map(quantity="WIDTH")
    assert bpy.ops.object.framelet_hide_colors() == {"FINISHED"}
    assert not torus.data.color_attributes
    assert np.array_equal(numbers(torus, "framelet_noise"), second)
    bpy.ops.object.framelet_analyze()
    assert np.array_equal(numbers(torus, "framelet_noise"), second)
    assert bpy.ops.object.framelet_clear() == {"FINISHED"}
    assert not [item for item in torus.data.attributes if item.name.startswith("framelet")]
    assert not band_storage.has_traces(torus.data)


def test_the_noise_becomes_a_vertex_group_that_stays(torus):
    """A mesh cannot have an attribute and a vertex group of one name."""
    bpy.ops.object.framelet_heat_map(quantity="NOISE")
    values = numbers(torus, "framelet_noise")
    torus.data.attributes.active = torus.data.attributes["framelet_noise"]
    assert bpy.ops.geometry.attribute_convert(mode="VERTEX_GROUP") == {"FINISHED"}
    weights = [group.weight for vertex in torus.data.vertices for group in vertex.groups]
    assert np.allclose(weights, values)
    bpy.ops.object.vertex_group_normalize()
    assert bpy.ops.object.framelet_denoise(preset="TRI_1", vertex_group="framelet_noise") == {"FINISHED"}
    assert bpy.ops.object.framelet_heat_map(quantity="NOISE") == {"FINISHED"}
    assert "framelet_noise" not in torus.data.attributes and "framelet_noise" in torus.vertex_groups


def test_faces_without_area_did_not_turn(make_object):
    surface = meshes.triangle_grid()
    obj = make_object(surface, "Grid")
    surface = mesh_bridge.read_surface(obj)
    flat = surface.vertices.copy()
    flat[:, 0] = 0.0
    write_and_remember(obj, surface, flat)
    assert (heat_values(obj, "ANGLE").values == 0).all()
    assert np.isfinite(heat_values(obj, "NORMAL").values).all()


def test_mixed_faces_have_corners_of_their_own(make_object, rng):
    obj = make_object(meshes.noisy(meshes.mixed_sheet(), rng), "Mixed")
    bpy.ops.object.framelet_denoise(preset="POSITIONS")
    angles = heat_values(obj, "ANGLE").values
    assert len(angles) == len(obj.data.loops)
    for face in obj.data.polygons:
        assert np.ptp(angles[face.loop_start : face.loop_start + face.loop_total]) == 0


def test_before_and_after_have_the_same_heat_map(torus):
    values = heat_values(torus, "NORMAL").values
    bpy.ops.object.framelet_before_after()
    assert np.array_equal(heat_values(torus, "NORMAL").values, values)


def test_fixed_ranges(torus):
    bpy.ops.object.framelet_heat_map(range_rule="FIXED", limit=0.25)
    assert shown().maximum == pytest.approx(0.25)
    bpy.ops.object.framelet_heat_map(quantity="ANGLE", range_rule="FIXED", limit_angle=radians(30))
    assert shown().maximum == pytest.approx(30)
    with pytest.raises(RuntimeError, match="The range is nan; it must be a length"):
        bpy.ops.object.framelet_heat_map(range_rule="FIXED", limit=float("nan"))
    bpy.ops.object.framelet_heat_map(quantity="WIDTH", range_rule="FIXED", limit_edges=2.5)
    assert shown().maximum == pytest.approx(2.5)
    with pytest.raises(RuntimeError, match="The range is nan; it must be a width"):
        bpy.ops.object.framelet_heat_map(quantity="WIDTH", range_rule="FIXED", limit_edges=float("nan"))
    with pytest.raises(RuntimeError, match="The range is nan; it must be an angle"):
        bpy.ops.object.framelet_heat_map(quantity="ANGLE", range_rule="FIXED", limit_angle=float("nan"))


def test_a_mesh_that_did_not_move_is_gray(make_object):
    obj = make_object(meshes.triangle_torus(), "Still")
    bpy.ops.object.framelet_denoise(preset="POSITIONS", lambda_=0.0)
    for quantity in ("NORMAL", "LENGTH", "ANGLE", "NOISE", "WIDTH"):
        assert bpy.ops.object.framelet_heat_map(quantity=quantity) == {"FINISHED"}
        assert np.isfinite(colors(obj)).all() and np.ptp(colors(obj)[:, :3]) < 1e-3


def test_a_heat_map_and_a_band_take_turns(torus):
    bpy.ops.object.framelet_analyze()
    bpy.ops.object.framelet_show_band()
    bpy.ops.object.framelet_heat_map()
    names = {item.name for item in torus.data.color_attributes}
    assert names == {"framelet_heat_map"} and shown().quantity == "NORMAL"
    bpy.ops.object.framelet_show_band()
    assert {item.name for item in torus.data.color_attributes} == {"framelet_band"}
    assert shown().quantity == ""
    bpy.ops.object.framelet_heat_map(quantity="ANGLE")
    bpy.ops.object.framelet_clear()
    assert not torus.data.color_attributes and not torus.data.keys()


def test_hiding_brings_back_what_was_shown(torus):
    mesh = torus.data
    mesh.color_attributes.new("Mine", "BYTE_COLOR", "CORNER")
    mesh.attributes.active_color_name = "Mine"
    space = next(area.spaces.active for area in bpy.context.screen.areas if area.type == "VIEW_3D")
    space.shading.type, space.shading.color_type = "SOLID", "RANDOM"
    names = {item.name for item in mesh.attributes}
    bpy.ops.object.framelet_heat_map()
    assert mesh.attributes.active_color_name == "framelet_heat_map"
    assert space.shading.color_type == "VERTEX"
    bpy.ops.object.framelet_heat_map(quantity="ANGLE")
    assert bpy.ops.object.framelet_hide_colors() == {"FINISHED"}
    assert {item.name for item in mesh.attributes} == names and not mesh.keys()
    assert mesh.attributes.active_color_name == "Mine"
    assert (space.shading.type, space.shading.color_type) == ("SOLID", "RANDOM")
    assert not shown().objects
    with pytest.raises(RuntimeError, match="The selected meshes have no colors of Framelet"):
        bpy.ops.object.framelet_hide_colors()


def test_undo_takes_the_colors_away(torus):
    space = next(area.spaces.active for area in bpy.context.screen.areas if area.type == "VIEW_3D")
    space.shading.type, space.shading.color_type = "SOLID", "TEXTURE"
    bpy.ops.ed.undo_push(message="Before")
    bpy.ops.object.framelet_heat_map()
    bpy.ops.ed.undo_push(message="Heat")
    bpy.ops.ed.undo()
    assert "framelet_heat_map" not in bpy.data.objects["Torus"].data.attributes
    assert space.shading.color_type == "TEXTURE"
    bpy.ops.ed.redo()
    assert "framelet_heat_map" in bpy.data.objects["Torus"].data.attributes
    assert space.shading.color_type == "VERTEX"
    bpy.ops.ed.undo()
    assert space.shading.color_type == "TEXTURE"


def test_all_selected_meshes_have_one_range(torus, make_object, rng):
    second = make_object(meshes.noisy(meshes.quad_torus(), rng, 0.4), "Second")
    bpy.ops.object.framelet_denoise(preset="QUAD_2")
    torus.select_set(True)
    bpy.ops.object.framelet_heat_map()
    values = [heat_values(obj, "NORMAL").values for obj in (torus, second)]
    limit = np.percentile(np.abs(np.concatenate(values)), 98)
    assert shown().maximum == pytest.approx(limit)
    for obj, each in zip((torus, second), values, strict=True):
        assert np.allclose(colors(obj), map_colors(DIVERGING, each / limit), atol=1e-5)


def test_another_run_brings_the_heat_map_up_to_date(torus):
    bpy.ops.object.framelet_heat_map(quantity="LENGTH")
    first = colors(torus)
    bpy.ops.object.framelet_denoise(preset="TRI_1")
    values = heat_values(torus, "LENGTH").values
    limit = np.percentile(values, 98)
    assert not np.allclose(first, colors(torus))
    assert np.allclose(colors(torus), map_colors(SEQUENTIAL, values / limit), atol=1e-5)
    assert shown().maximum == pytest.approx(limit)
    bpy.ops.object.framelet_hide_colors()
    bpy.ops.object.framelet_denoise(preset="TRI_1")
    assert not torus.data.color_attributes


def test_a_run_in_edit_mode_takes_the_legend_away(torus):
    bpy.ops.object.framelet_heat_map()
    first = colors(torus)
    bpy.ops.object.mode_set(mode="EDIT")
    assert bpy.ops.object.framelet_denoise(preset="TRI_1") == {"FINISHED"}
    assert not shown().objects
    bpy.ops.object.mode_set(mode="OBJECT")
    assert np.array_equal(colors(torus), first)
    bpy.ops.object.framelet_heat_map()
    assert shown().objects.keys() == ["Torus"] and not np.array_equal(colors(torus), first)


def test_a_new_object_has_a_heat_map_of_its_own(torus):
    bpy.ops.object.framelet_heat_map(quantity="LENGTH")
    first = colors(torus)
    bpy.ops.object.framelet_denoise(preset="TRI_1", output="NEW_OBJECT")
    new = bpy.context.object
    assert new != torus and shown().objects.keys() == [new.name]
    values = heat_values(new, "LENGTH").values
    assert np.allclose(colors(new), map_colors(SEQUENTIAL, values / np.percentile(values, 98)), atol=1e-5)
    assert np.array_equal(colors(torus), first)


def test_a_shape_key_has_a_heat_map_too(torus):
    before = mesh_bridge.read_surface(torus).vertices
    bpy.ops.object.framelet_denoise(preset="TRI_1", output="SHAPE_KEY")
    run = last_run(torus)
    assert np.array_equal(run.before, before) and np.array_equal(
        run.after, mesh_bridge.read_surface(torus).vertices
    )
    assert bpy.ops.object.framelet_heat_map() == {"FINISHED"}
    assert bpy.ops.object.framelet_before_after() == {"FINISHED"}
    assert np.array_equal(mesh_bridge.read_surface(torus).vertices, before)


def test_the_report_says_the_range(torus, capfd):
    bpy.context.scene.unit_settings.system = "NONE"
    bpy.ops.object.framelet_heat_map()
    limit = f"{shown().maximum:.3g}"
    expected = f"Displacement along normals of ‘Torus’: colors from −{limit} to {limit}, 97.9%"
    assert expected in capfd.readouterr().out
    bpy.ops.object.framelet_heat_map(quantity="ANGLE")
    assert (
        f"Angle change of faces of ‘Torus’: colors from 0° to {shown().maximum:.3g}°"
        in capfd.readouterr().out
    )


def test_poll_says_why_not(make_object, rng):
    make_object(meshes.noisy(meshes.triangle_torus(), rng), "Torus")
    with pytest.raises(RuntimeError, match="Denoise a selected mesh first"):
        bpy.ops.object.framelet_heat_map()
    bpy.ops.object.framelet_denoise(preset="TRI_2")
    bpy.ops.object.mode_set(mode="EDIT")
    for name in ("heat_map", "hide_colors"):
        with pytest.raises(RuntimeError, match="Switch to Object Mode"):
            getattr(bpy.ops.object, f"framelet_{name}")()


def test_a_changed_mesh_gets_a_sentence(torus):
    torus.data.vertices[0].co = (5, 5, 5)
    with pytest.raises(RuntimeError, match="‘Torus’ was changed since it was denoised"):
        bpy.ops.object.framelet_heat_map()
    assert "framelet_heat_map" not in torus.data.attributes
