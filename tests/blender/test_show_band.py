# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Colors show the chosen band, and the reported range says what they mean."""

import re

import bpy
import meshes
import numpy as np
import pytest
from framelet.core.mesh.geometry import vertex_normals
from framelet.core.stencils.cells import find_cells
from framelet.operators.bands.band_values import BandChoice, choose_values, find_limit
from framelet.operators.colors.colormaps import DIVERGING, SEQUENTIAL, map_colors
from framelet.operators.mesh_io import mesh_bridge


@pytest.fixture
def analyzed(make_object, rng):
    obj = make_object(meshes.noisy(meshes.flipped(meshes.triangle_torus()), rng), "Torus")
    bpy.ops.object.framelet_analyze(levels=2)
    return obj


def vectors(obj, name):
    attribute = obj.data.attributes[name]
    values = np.empty((len(attribute.data), 3), np.float32)
    attribute.data.foreach_get("vector", values.reshape(-1))
    return values.astype(np.float64)


def colors(obj):
    attribute = obj.data.color_attributes["framelet_band"]
    values = np.empty((len(attribute.data), 4), np.float32)
    attribute.data.foreach_get("color", values.reshape(-1))
    return values


def shown_range():
    return bpy.context.window_manager.framelet_band_range


def along_normals(obj, name):
    return (vectors(obj, name) * vertex_normals(mesh_bridge.read_surface(obj))).sum(axis=1)


def test_signed_values_are_components_along_the_normals(analyzed):
    assert bpy.ops.object.framelet_show_band(level=2, band=3) == {"FINISHED"}
    values = along_normals(analyzed, "framelet_L2_B3")
    assert (values < 0).any() and (values > 0).any()
    limit = np.percentile(np.abs(values), 98)
    found = shown_range()
    assert (found.objects.keys(), found.title, found.is_signed) == (["Torus"], "Level 2, band 3", True)
    assert found.maximum == pytest.approx(limit) and found.minimum == pytest.approx(-limit)
    assert found.largest == pytest.approx(np.abs(values).max())
    assert found.share == pytest.approx(100 * (np.abs(values) <= limit).mean())
    assert np.allclose(colors(analyzed), map_colors(DIVERGING, values / limit), atol=1e-5)


def test_lengths_and_norms_take_the_sequential_map(analyzed):
    bpy.ops.object.framelet_show_band(band=2, component="LENGTH", range_rule="MAXIMUM")
    lengths = np.linalg.norm(vectors(analyzed, "framelet_L1_B2"), axis=1)
    assert shown_range().maximum == pytest.approx(lengths.max())
    assert (shown_range().minimum, shown_range().is_signed, shown_range().share) == (0, False, 100)
    assert np.allclose(colors(analyzed), map_colors(SEQUENTIAL, lengths / lengths.max()), atol=1e-5)

    bpy.ops.object.framelet_show_band(content="LEVEL", level=2, range_rule="FIXED", limit=0.05)
    bands = [vectors(analyzed, f"framelet_L2_B{band}") for band in range(1, 7)]
    norms = np.sqrt(sum((band**2).sum(axis=1) for band in bands))
    assert shown_range().maximum == pytest.approx(0.05)
    assert shown_range().title == "Level 2"
    assert np.allclose(colors(analyzed), map_colors(SEQUENTIAL, norms / 0.05), atol=1e-5)


def test_the_low_pass_is_shown_as_the_way_to_it(analyzed):
    bpy.ops.object.framelet_show_band(content="LOW", component="LENGTH", range_rule="MAXIMUM")
    away = np.linalg.norm(vectors(analyzed, "framelet_low") - vectors(analyzed, "framelet_rest"), axis=1)
    assert shown_range().maximum == pytest.approx(away.max())
    assert shown_range().title == "Low-pass"


def test_normals_are_those_of_the_analyzed_surface(analyzed):
    expected = along_normals(analyzed, "framelet_L1_B1")
    surface = mesh_bridge.read_surface(analyzed)
    mesh_bridge.write_vertices(analyzed, surface, surface.vertices[:, [1, 2, 0]])
    assert np.allclose(choose_values(analyzed, BandChoice()).values, expected, atol=1e-6)


def test_the_range_is_in_scene_units(analyzed):
    one = choose_values(analyzed, BandChoice(component="LENGTH")).values
    signed = choose_values(analyzed, BandChoice()).values
    analyzed.scale = (2, 2, 2)
    bpy.context.view_layer.update()
    assert np.allclose(choose_values(analyzed, BandChoice(component="LENGTH")).values, 2 * one, rtol=1e-6)
    assert np.allclose(choose_values(analyzed, BandChoice()).values, 2 * signed, atol=1e-6)
    analyzed.scale = (-1, 1, 1)
    bpy.context.view_layer.update()
    # What points outwards in the mesh also does so in its mirror image.
    assert np.allclose(choose_values(analyzed, BandChoice()).values, signed, atol=1e-6)


@pytest.mark.parametrize("shape", [meshes.quad_torus, meshes.triangle_torus, meshes.mixed_sheet])
def test_bands_on_cells_are_averaged_to_points(make_object, shape, rng):
    obj = make_object(meshes.noisy(shape(), rng), "Cells")
    bpy.ops.object.framelet_analyze(frame="B_SPLINE_1", levels=2)
    surface = mesh_bridge.read_surface(obj)
    cells = find_cells(surface, with_triangles=True)
    on_edges = "framelet_L1_B2_edges" if cells.n_quads else "framelet_L1_B2"
    sums, counts = np.zeros(surface.n_vertices), np.zeros(surface.n_vertices)
    for cell, (owner, corners) in enumerate(zip(cells.owner, cells.corners, strict=True)):
        name = "framelet_L1_B2" if cell < cells.n_quads else on_edges
        sums[corners] += np.linalg.norm(vectors(obj, name)[owner])
        counts[corners] += 1
    found = choose_values(obj, BandChoice(band=2, component="LENGTH")).values
    assert np.allclose(found, sums / np.maximum(counts, 1), atol=1e-6)
    bpy.ops.object.framelet_show_band(band=2)
    assert shown_range().maximum > 0
    bpy.ops.object.framelet_show_band(level=2, band=2)
    normal = along_normals(obj, "framelet_L2_B2")
    assert shown_range().maximum == pytest.approx(np.percentile(np.abs(normal), 98))


def test_colors_are_active_and_rendered_and_shown(analyzed):
    mesh = analyzed.data
    mesh.color_attributes.new("Mine", "BYTE_COLOR", "CORNER")
    spaces = [area.spaces.active for area in bpy.context.screen.areas if area.type == "VIEW_3D"]
    assert spaces
    spaces[0].shading.type, spaces[0].shading.color_type = "MATERIAL", "RANDOM"
    bpy.ops.object.framelet_show_band()
    assert mesh.color_attributes.active_color.name == "framelet_band"
    assert mesh.color_attributes[mesh.color_attributes.render_color_index].name == "framelet_band"
    attribute = mesh.attributes["framelet_band"]
    assert (attribute.data_type, attribute.domain) == ("FLOAT_COLOR", "POINT")
    assert (spaces[0].shading.type, spaces[0].shading.color_type) == ("SOLID", "VERTEX")
    bpy.ops.object.framelet_show_band(band=2)
    bpy.ops.object.framelet_clear()
    assert spaces[0].shading.type == "MATERIAL"
    spaces[0].shading.type = "SOLID"
    assert spaces[0].shading.color_type == "RANDOM"
    assert not shown_range().objects


def test_only_the_view_that_was_used_is_switched(analyzed):
    area = next(each for each in bpy.context.screen.areas if each.type == "VIEW_3D")
    other = next(each for each in bpy.context.screen.areas if each.type == "OUTLINER")
    other.type = "VIEW_3D"
    other.spaces.active.shading.color_type = "MATERIAL"
    with bpy.context.temp_override(area=area):
        bpy.ops.object.framelet_show_band()
    assert area.spaces.active.shading.color_type == "VERTEX"
    assert other.spaces.active.shading.color_type == "MATERIAL"


def test_colors_of_somebody_else_stay(analyzed):
    analyzed.data.color_attributes.new("framelet_band", "BYTE_COLOR", "CORNER")
    with pytest.raises(RuntimeError, match="is BYTE_COLOR on CORNER instead of FLOAT_COLOR on POINT"):
        bpy.ops.object.framelet_show_band()
    assert analyzed.data.attributes["framelet_band"].domain == "CORNER"
    analyzed.data.attributes["framelet_band"].name = "Mine"
    bpy.ops.object.framelet_show_band()
    assert analyzed.data.attributes["framelet_band"].domain == "POINT"


def test_all_selected_meshes_have_one_range(make_object, rng, analyzed):
    second = make_object(meshes.noisy(meshes.quad_torus(), rng, 0.4), "Second")
    bpy.ops.object.framelet_analyze()
    analyzed.select_set(True)
    bpy.ops.object.framelet_show_band(band=2)
    values = [choose_values(obj, BandChoice(band=2)).values for obj in (analyzed, second)]
    limit = np.percentile(np.abs(np.concatenate(values)), 98)
    assert shown_range().maximum == pytest.approx(limit)
    for obj, each in zip((analyzed, second), values, strict=True):
        assert np.allclose(colors(obj), map_colors(DIVERGING, each / limit), atol=1e-5)


def test_the_report_says_the_range(analyzed, capfd):
    bpy.context.scene.unit_settings.system = "NONE"
    bpy.ops.object.framelet_show_band()
    report = capfd.readouterr().out
    limit = f"{shown_range().maximum:.4g}"
    assert f"Level 1, band 1 of ‘Torus’: colors from −{limit} to {limit}, " in report
    bpy.ops.object.framelet_show_band(content="LEVEL")
    assert re.search(
        r"Level 1 of ‘Torus’: colors from 0 to [\d.]+, [\d.]+% of all are within", capfd.readouterr().out
    )


def test_flat_parts_do_not_make_the_range_empty():
    values = np.zeros(1000)
    assert find_limit([values], 98.0) == 0.0
    values[5] = -3.0
    assert find_limit([values], 98.0) == 3.0
    assert find_limit([np.arange(101.0)], 50.0) == 50.0


def test_a_flat_mesh_is_gray(make_object):
    obj = make_object(meshes.triangle_grid(), "Flat")
    bpy.ops.object.framelet_analyze()
    for component in ("NORMAL", "LENGTH"):
        assert bpy.ops.object.framelet_show_band(component=component, band=2) == {"FINISHED"}
        found = colors(obj)
        assert np.isfinite(found).all()
    bpy.ops.object.framelet_show_band(band=4)
    assert np.ptp(colors(obj)[:, :3]) < 1e-3


@pytest.mark.parametrize(
    ("values", "sentence"),
    [
        ({"level": 3}, "‘Torus’ has levels 1 to 2, but level 3 was chosen; choose one that it has."),
        ({"band": 7}, "‘Torus’ has bands 1 to 6 at level 1, but band 7 was chosen; choose one that it has."),
    ],
)
def test_bands_that_do_not_exist_get_a_sentence(analyzed, values, sentence):
    with pytest.raises(RuntimeError, match=sentence):
        bpy.ops.object.framelet_show_band(**values)
    assert "framelet_band" not in analyzed.data.attributes
    assert not shown_range().objects


def test_undo_takes_the_colors_away(analyzed):
    bpy.ops.ed.undo_push(message="Before")
    bpy.ops.object.framelet_show_band()
    bpy.ops.ed.undo_push(message="Show")
    bpy.ops.ed.undo()
    mesh = bpy.data.objects["Torus"].data
    assert "framelet_band" not in mesh.attributes and "framelet_L1_B1" in mesh.attributes


def test_clearing_one_of_two_keeps_the_view(make_object, rng, analyzed):
    second = make_object(meshes.noisy(meshes.quad_torus(), rng), "Second")
    bpy.ops.object.framelet_analyze()
    analyzed.select_set(True)
    bpy.ops.object.framelet_show_band()
    space = next(area.spaces.active for area in bpy.context.screen.areas if area.type == "VIEW_3D")
    analyzed.select_set(False)
    bpy.ops.object.framelet_clear()
    assert "framelet_band" not in second.data.attributes
    assert space.shading.color_type == "VERTEX" and shown_range().objects
    analyzed.select_set(True)
    bpy.ops.object.framelet_clear()
    assert space.shading.color_type != "VERTEX" and not shown_range().objects


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"percentile": float("nan")}, "The percentile is nan; it must be from 0 to 100"),
        ({"range_rule": "FIXED", "limit": float("nan")}, "The range is nan; it must be a length"),
    ],
)
def test_ranges_that_are_no_numbers_are_refused(analyzed, options, sentence):
    with pytest.raises(RuntimeError, match=sentence):
        bpy.ops.object.framelet_show_band(**options)
