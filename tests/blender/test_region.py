# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Regions in Blender: what is read of an object in both modes, and that operator and core agree."""

from dataclasses import fields

import bpy
import numpy as np
import pytest

# isort: split
# This module exists once bpy was imported.
import bmesh
from blender_objects import edit, read
from checks import assert_same_bits, lengths
from framelet.core import PRESETS, Region, denoise
from framelet.core.mesh.borders import border_vertices
from framelet.operators.mesh_io import mesh_bridge
from framelet.operators.properties.region_options import RegionOptions
from framelet.operators.properties.region_values import REGION_NAMES, shown_region_names, to_region_options
from framelet.operators.run.denoise_object import denoise_object
from meshes import noisy, triangle_grid, triangle_torus
from region_cases import exploded

QUICK = PRESETS["TRI_2"].settings


@pytest.fixture
def torus(make_object, rng):
    return make_object(noisy(triangle_torus(), rng, 0.1))


def run(**given):
    assert bpy.ops.object.framelet_denoise(preset="TRI_2", **given) == {"FINISHED"}


def refused(**given):
    with pytest.raises(RuntimeError) as caught:
        bpy.ops.object.framelet_denoise(preset="TRI_2", **given)
    return str(caught.value)


def add_group(obj, weights, name="Part"):
    group = obj.vertex_groups.new(name=name)
    for index, weight in enumerate(weights.tolist()):
        if weight:
            group.add([index], weight, "REPLACE")


def set_hidden(obj, hidden):
    for vertex, is_hidden in zip(obj.data.vertices, hidden.tolist(), strict=True):
        vertex.hide = is_hidden


def test_every_option_is_a_property_of_scene_and_operator():
    operator = bpy.ops.object.framelet_denoise.get_rna_type().properties
    scene = bpy.context.scene.framelet.bl_rna.properties
    for item in fields(RegionOptions):
        info = item.metadata["info"]
        for properties in (operator, scene):
            found = properties[item.name]
            assert found.name == info.label
            assert found.description == info.description
            if item.type == "float":
                assert found.default == pytest.approx(item.default)
                assert (found.hard_min, found.hard_max) == (info.minimum, info.maximum)
                assert found.unit == (info.unit or "NONE")
            else:
                assert found.default == item.default


def test_the_defaults_of_properties_are_those_of_core():
    assert to_region_options(bpy.context.scene.framelet) == RegionOptions()


def test_options_without_effect_are_not_shown():
    settings = bpy.context.scene.framelet
    settings.weld = False
    hidden = {"invert_group", "max_edges", "max_length", "weld_distance"}
    assert set(REGION_NAMES) - set(shown_region_names(settings)) == hidden
    settings.vertex_group, settings.limit, settings.weld = "Part", "LENGTH", True
    assert set(REGION_NAMES) - set(shown_region_names(settings)) == {"max_edges"}


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
@pytest.mark.parametrize("invert", [False, True])
def test_a_vertex_group_blends(mode, invert, torus, rng):
    weights = np.round(rng.random(len(torus.data.vertices)), 2).astype(np.float32)
    weights[:60] = 1.0 if invert else 0.0
    add_group(torus, weights)
    surface = mesh_bridge.read_surface(torus)
    share = (1.0 - weights.astype(float)) if invert else weights.astype(float)
    everything = np.ones(len(weights), bool)
    if mode == "EDIT":
        edit(torus)
    expected = denoise(
        surface, QUICK, movable=everything if mode == "EDIT" else None, region=Region(weights=share)
    )
    run(vertex_group="Part", invert_group=invert)
    assert_same_bits(read(torus), expected.vertices)
    assert_same_bits(read(torus)[:60], surface.vertices[:60])
    assert expected.report.n_moved > 100


def test_a_group_that_is_missing_or_empty_is_named(torus):
    before = read(torus)
    assert "‘Mesh’ has no vertex group ‘Nose’; choose one that it has." in refused(vertex_group="Nose")
    torus.vertex_groups.new(name="Nose")
    assert "The vertex group ‘Nose’ of ‘Mesh’ gives no weight to any of its vertices" in refused(
        vertex_group="Nose"
    )
    add_group(torus, np.ones(len(before)), "Full")
    assert "‘Full’, inverted, of ‘Mesh’ gives no weight" in refused(vertex_group="Full", invert_group=True)
    assert_same_bits(read(torus), before)


def test_of_several_objects_those_without_the_group_are_left(make_object, rng):
    first = make_object(noisy(triangle_torus(), rng, 0.1), "First")
    second = make_object(noisy(triangle_torus(), rng, 0.1), "Second")
    add_group(first, np.ones(len(first.data.vertices)))
    first.select_set(True)
    before = read(first), read(second)
    run(vertex_group="Part")
    assert (read(first) != before[0]).any()
    assert_same_bits(read(second), before[1])


def test_hidden_vertices_are_left_alone_in_object_mode(torus, rng):
    hidden = rng.random(len(torus.data.vertices)) < 0.4
    set_hidden(torus, hidden)
    surface = mesh_bridge.read_surface(torus)
    run()
    assert_same_bits(read(torus)[hidden], surface.vertices[hidden])
    assert_same_bits(read(torus), denoise(surface, QUICK, movable=~hidden).vertices)


def test_hidden_vertices_can_be_denoised_too(torus, rng):
    set_hidden(torus, rng.random(len(torus.data.vertices)) < 0.4)
    surface = mesh_bridge.read_surface(torus)
    run(keep_hidden=False)
    assert_same_bits(read(torus), denoise(surface, QUICK).vertices)


def test_all_hidden_is_said(torus):
    set_hidden(torus, np.ones(len(torus.data.vertices), bool))
    assert "All vertices of ‘Mesh’ are hidden; reveal some" in refused()


def test_hidden_vertices_are_left_alone_in_edit_mode(torus, rng):
    hidden = rng.random(len(torus.data.vertices)) < 0.4
    edit(torus)
    edit_mesh = bmesh.from_edit_mesh(torus.data)
    for vert in edit_mesh.verts:
        vert.hide_set(bool(hidden[vert.index]))
    bmesh.update_edit_mesh(torus.data)
    before = read(torus)
    run(keep_hidden=False)
    assert_same_bits(read(torus)[hidden], before[hidden])
    assert (read(torus)[~hidden] != before[~hidden]).any(axis=1).mean() > 0.9


@pytest.mark.parametrize("scale", [(1, 1, 1), (2, 0.5, 4), (-3, -3, -3)])
def test_a_length_is_measured_in_the_scene(scale, torus):
    torus.scale = scale
    bpy.context.view_layer.update()
    before = read(torus)
    run(limit="LENGTH", max_length=0.01)
    moved = (read(torus).astype(float) - before) * scale
    assert 0.002 < lengths(moved).max() <= 0.01 * (1 + 1e-4)
    if scale == (1, 1, 1):
        assert lengths(moved).max() > 0.0099


def test_edge_lengths_are_those_of_the_mesh(torus):
    torus.scale = (5, 5, 5)
    bpy.context.view_layer.update()
    before = read(torus)
    run(limit="EDGES", max_edges=0.05)
    report = bpy.context.window_manager.framelet_report
    assert report.displacement_max_edges == pytest.approx(0.05, rel=1e-4)
    assert lengths(read(torus) - before).max() > 0.0


def test_other_options_reach_core(torus):
    surface = mesh_bridge.read_surface(torus)
    region = Region(along_normals=True, keep_volume=True, repair_folds=False, weld_distance=0.0)
    expected = denoise(surface, QUICK, region=region)
    run(along_normals=True, keep_volume=True, repair_folds=False, weld=True)
    assert_same_bits(read(torus), expected.vertices)
    report = bpy.context.window_manager.framelet_report
    assert report.is_closed
    assert abs(report.volume_change) < 0.01


def test_the_button_hands_over_the_region(torus):
    from framelet.operators.properties.own_settings import shown_settings
    from framelet.operators.properties.setting_values import copy_settings

    settings = bpy.context.scene.framelet
    settings.preset, settings.limit, settings.max_edges = "TRI_2", "EDGES", 0.07
    settings.keep_volume, settings.vertex_group = True, "Part"

    class Target:
        """Takes what the panel hands to the operator."""

    copied = Target()
    for name in REGION_NAMES:
        setattr(copied, name, None)
    copy_settings(shown_settings(bpy.context), copied)
    assert to_region_options(copied) == RegionOptions(
        limit="EDGES", max_edges=0.07, keep_volume=True, vertex_group="Part"
    )


@pytest.mark.parametrize("distance", [0.0, 0.001])
def test_a_soup_keeps_vertices_and_uvs_and_stays_closed(distance, make_object, rng):
    soup, vertex = exploded(noisy(triangle_torus(), rng, 0.1))
    obj = make_object(soup)
    layer = obj.data.uv_layers.new(name="UV")
    uvs = rng.random(2 * len(obj.data.loops)).astype(np.float32)
    layer.data.foreach_set("uv", uvs)
    before = read(obj)
    run(weld_distance=distance)
    after = read(obj)
    assert len(after) == soup.n_vertices
    kept = np.empty_like(uvs)
    obj.data.uv_layers["UV"].data.foreach_get("uv", kept)
    assert_same_bits(kept, uvs)
    assert (after != before).any(axis=1).mean() > 0.9
    for number in range(vertex.max() + 1):
        bits = after[vertex == number].view(np.uint32)
        assert (bits == bits[0]).all()
    report = bpy.context.window_manager.framelet_report
    assert report.welded_vertices == soup.n_vertices - len(np.unique(vertex))
    assert report.is_closed


def test_folds_and_damped_vertices_are_reported(make_object):
    rng = np.random.default_rng(2)
    mesh = noisy(triangle_torus(), rng, 0.35)
    obj = make_object(mesh)
    surface = mesh_bridge.read_surface(obj)
    expected = denoise(surface, PRESETS["BILATERAL"].settings).report
    assert expected.damped_vertices > 0
    bpy.ops.object.framelet_denoise(preset="BILATERAL")
    report = bpy.context.window_manager.framelet_report
    for name in ("folded_faces", "folded_faces_before", "degenerate_faces", "damped_vertices"):
        assert getattr(report, name) == getattr(expected, name)
    assert report.folded_faces <= report.folded_faces_before


def test_scripts_can_pass_options(torus):
    surface = mesh_bridge.read_surface(torus)
    report = denoise_object(torus, QUICK, options=RegionOptions(limit="EDGES", max_edges=0.0))
    assert report.n_moved == 0
    assert_same_bits(read(torus), surface.vertices)


def test_shape_keys_and_regions_go_together(torus):
    torus.shape_key_add(name="Basis")
    key = torus.shape_key_add(name="Key")
    torus.active_shape_key_index = 1
    weights = np.zeros(len(torus.data.vertices))
    weights[:90] = 1.0
    add_group(torus, weights)
    before = read(torus)
    run(vertex_group="Part")
    after = np.empty((len(before), 3), np.float32)
    key.points.foreach_get("co", after.reshape(-1))
    assert_same_bits(after[90:], before[90:])
    assert (after[:90] != before[:90]).any(axis=1).mean() > 0.9


def test_a_frayed_border_is_straightened_on_request(make_object, rng):
    size = 24
    points = np.stack((*np.divmod(np.arange(size**2), size), np.zeros(size**2)), axis=1).astype(float)
    grid = triangle_grid(size, size).with_vertices(points)
    border = border_vertices(grid)
    points[border, 2] += 0.4 * rng.standard_normal(border.sum())
    obj = make_object(grid.with_vertices(points))
    run(straighten_borders=True)
    assert np.abs(mesh_bridge.read_surface(obj).vertices[border, 2]).std() < 0.2
