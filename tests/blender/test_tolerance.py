# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Green on a heat map is what is within a tolerance, and the legend says so."""

from math import radians

import bpy
import meshes
import numpy as np
import pytest
from drawing import draw
from framelet.operators.colors.colormaps import DIVERGING, SEQUENTIAL, map_colors
from framelet.operators.colors.heat_values import heat_values
from framelet.operators.properties.scene_units import three_digits
from framelet.ui.legend import legend
from framelet.ui.panels import see_panel


@pytest.fixture
def torus(make_object, rng):
    obj = make_object(meshes.noisy(meshes.triangle_torus(), rng), "Torus")
    bpy.ops.object.framelet_denoise(preset="TRI_2")
    return obj


def shown():
    return bpy.context.window_manager.framelet_band_range


def colors(obj):
    attribute = obj.data.color_attributes["framelet_heat_map"]
    values = np.empty((len(attribute.data), 4), np.float32)
    attribute.data.foreach_get("color", values.reshape(-1))
    return values


def is_green(found):
    red, green, blue = np.asarray(found).T[:3]
    return (green > 2 * red) & (green > 1.5 * blue)


@pytest.mark.parametrize("colormap", [DIVERGING, SEQUENTIAL])
def test_no_map_has_the_green_of_the_tolerance(colormap):
    assert not is_green(map_colors(colormap, np.linspace(colormap.low, colormap.high, 200))).any()
    values = [-0.25, 0.0, 0.25, 0.2501, 1.0]
    assert is_green(map_colors(colormap, values, 0.25)).tolist() == [True, True, True, False, False]
    assert np.array_equal(map_colors(colormap, values, 0.25)[3:], map_colors(colormap, values)[3:])


@pytest.mark.parametrize("quantity", ["NORMAL", "LENGTH", "NOISE", "ANGLE"])
def test_exactly_what_is_within_is_green(torus, quantity):
    values = np.abs(heat_values(torus, quantity).values)
    tolerance = float(f"{np.median(values):.4g}")
    given = {"tolerance_angle": radians(tolerance)} if quantity == "ANGLE" else {"tolerance": tolerance}
    bpy.ops.object.framelet_heat_map(quantity=quantity, **given)
    assert shown().tolerance == pytest.approx(tolerance, rel=1e-5)
    is_near = np.abs(values - tolerance) < 1e-5 * tolerance
    assert np.array_equal(is_green(colors(torus))[~is_near], (values <= tolerance)[~is_near])
    assert shown().green == pytest.approx(100.0 * (values <= tolerance).mean(), abs=1.0)


def test_without_a_tolerance_nothing_is_green(torus):
    bpy.ops.object.framelet_heat_map()
    assert not is_green(colors(torus)).any() and (shown().tolerance, shown().green) == (0.0, 0.0)


def test_all_is_green_where_all_is_within(torus):
    bpy.ops.object.framelet_heat_map(tolerance=10.0)
    assert is_green(colors(torus)).all() and shown().green == 100.0 and shown().maximum == 10.0


def test_the_width_of_noise_has_no_tolerance(torus):
    bpy.ops.object.framelet_heat_map(quantity="WIDTH", tolerance=0.5)
    assert shown().tolerance == 0.0


def test_the_legend_says_so_in_three_digits(torus):
    bpy.context.scene.unit_settings.length_unit = "MILLIMETERS"
    bpy.context.scene.unit_settings.scale_length = 0.001
    values = np.abs(heat_values(torus, "NORMAL").values)
    bpy.ops.object.framelet_heat_map(tolerance=0.123456)
    _, labels, note = legend.legend_texts(bpy.context.scene, shown())
    share = 100.0 * (values <= np.float32(0.123456)).mean()
    assert note == f"Green: up to 0.123 mm, {share:.3g}%"
    assert all(len(label.strip("−").split()[0].replace(".", "").strip("0")) <= 3 for label in labels)
    tolerance = shown().tolerance / shown().maximum
    places = np.linspace(0.0, 1.0, 101)
    stripes = is_green(legend.stripe_colors(True, places, tolerance))
    assert np.array_equal(stripes, np.abs(2.0 * places - 1.0) <= tolerance)


def test_it_stays_over_runs_and_is_in_the_panel(torus):
    heat = bpy.context.scene.framelet_heat_map
    heat.tolerance = 0.05
    record = draw(see_panel.VIEW3D_PT_framelet_see)
    assert "tolerance" in record["prop"] and "tolerance_angle" not in record["prop"]
    assert record["object.framelet_heat_map"].tolerance == pytest.approx(0.05)
    bpy.ops.object.framelet_heat_map(tolerance=0.05)
    idnames = draw(see_panel.VIEW3D_PT_framelet_see)["operator"]
    # Shown, it can be taken away, and made again with another range.
    assert idnames.count("object.framelet_hide_colors") == 1
    assert idnames.count("object.framelet_heat_map") == 4
    bpy.ops.object.framelet_denoise(preset="TRI_1")
    assert shown().tolerance == pytest.approx(0.05) and is_green(colors(torus)).any()
    heat.quantity = "ANGLE"
    bpy.ops.object.framelet_hide_colors()
    assert "tolerance_angle" in draw(see_panel.VIEW3D_PT_framelet_see)["prop"]


def test_three_digits():
    assert [three_digits(value) for value in (0.0, 0.53541, 12.345, 1234.5, 99999.0)] == [
        "0",
        "0.535",
        "12.3",
        "1234",
        "99999",
    ]
