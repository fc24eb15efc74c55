# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the legend shows, where, and when. Drawing itself needs a window; see tests/gui."""

import re

import bpy
import meshes
import numpy as np
import pytest
from framelet.operators.colors.colormaps import DIVERGING, SEQUENTIAL, map_colors
from framelet.operators.properties.scene_units import value_texts
from framelet.ui.legend import legend
from framelet.ui.legend.legend_layout import Rectangle, free_area, lay_out_legend, tick_values

AREA = Rectangle(50, 0, 800, 600)
TEXTS = ["−2 mm", "−1 mm", "0 m", "1 mm", "2 mm"]


def measure(text, scale=1.0):
    return 6.0 * scale * len(text), 8.0 * scale


def lay_out(area=AREA, scale=1.0, title="Displacement", texts=TEXTS, note="98.0% in this range"):
    return lay_out_legend(area, scale, title, texts, note, lambda text: measure(text, scale))


def inside(inner, outer, slack=1e-6):
    return (
        inner.x >= outer.x - slack
        and inner.y >= outer.y - slack
        and inner.right <= outer.right + slack
        and inner.top <= outer.top + slack
    )


@pytest.mark.parametrize("scale", [0.75, 1.0, 1.5, 2.0])
@pytest.mark.parametrize("note", ["", "98.0% in this range"])
@pytest.mark.parametrize("texts", [TEXTS, ["0°", "10°", "20°"]])
def test_everything_lies_on_the_backdrop_and_nothing_overlaps(scale, note, texts):
    found = lay_out(Rectangle(0, 0, 1500, 1200), scale, texts=texts, note=note)
    boxes = [Rectangle(label.x, label.y, *measure(label.text, scale)) for label in found.labels]
    for each in (*boxes, *found.stripes, *found.ticks):
        assert inside(each, found.backdrop)
    bar = Rectangle(
        found.stripes[0].x,
        found.stripes[0].y,
        found.stripes[0].width,
        found.stripes[-1].top - found.stripes[0].y,
    )
    parts = [*boxes, bar]
    for number, one in enumerate(parts):
        for other in parts[:number]:
            assert one.right <= other.x or other.right <= one.x or one.top <= other.y or other.top <= one.y
    assert len(found.labels) == 1 + len(texts) + bool(note)


def test_twice_the_scale_is_twice_as_large():
    one = lay_out(Rectangle(0, 0, 800, 600), 1.0)
    two = lay_out(Rectangle(0, 0, 1600, 1200), 2.0)
    assert np.allclose(two.backdrop, np.multiply(one.backdrop, 2), atol=1)
    for first, second in zip(one.stripes, two.stripes, strict=True):
        assert np.allclose(second, np.multiply(first, 2), atol=1)
    for first, second in zip(one.labels, two.labels, strict=True):
        assert np.allclose(second[1:], np.multiply(first[1:], 2), atol=1)


def test_stripes_are_one_bar_from_low_to_high():
    found = lay_out()
    for below, above in zip(found.stripes[:-1], found.stripes[1:], strict=True):
        assert above.y == pytest.approx(below.top)
    assert (np.diff(found.values) > 0).all()
    assert found.values[0] == pytest.approx(1 - found.values[-1])
    # The ticks are where their values are.
    low, high = found.stripes[0].y, found.stripes[-1].top
    middles = [tick.y + tick.height / 2 for tick in found.ticks]
    assert np.allclose(middles, np.linspace(low, high, len(TEXTS)))
    assert [label.text for label in found.labels[1 : 1 + len(TEXTS)]] == TEXTS


@pytest.mark.parametrize("area", [Rectangle(0, 0, 80, 600), Rectangle(0, 0, 800, 100), Rectangle(0, 0, 0, 0)])
def test_without_room_there_is_none(area):
    assert lay_out(area) is None


def test_a_low_area_has_a_shorter_bar():
    tall, low = lay_out(), lay_out(Rectangle(0, 0, 800, 200))
    assert low.backdrop.height < tall.backdrop.height
    assert inside(low.backdrop, Rectangle(0, 0, 800, 200))


def test_regions_over_the_view_take_their_part():
    region = Rectangle(100, 50, 1000, 700)
    header, toolbar = Rectangle(100, 724, 1000, 26), Rectangle(100, 50, 60, 674)
    sidebar, tiny = Rectangle(800, 50, 300, 674), Rectangle(100, 50, 1, 1)
    assert free_area(region, []) == Rectangle(0, 0, 1000, 700)
    assert free_area(region, [header]) == Rectangle(0, 0, 1000, 674)
    assert free_area(region, [header, toolbar, sidebar, tiny]) == Rectangle(60, 0, 640, 674)
    assert free_area(region, [Rectangle(100, 50, 1000, 30)]) == Rectangle(0, 30, 1000, 670)
    # The sidebar on the left, and regions beside the view.
    assert free_area(region, [Rectangle(100, 50, 300, 674)]) == Rectangle(300, 0, 700, 700)
    assert free_area(region, [Rectangle(1100, 50, 300, 700), Rectangle(100, 750, 1000, 30)]) == Rectangle(
        0, 0, 1000, 700
    )


@pytest.mark.parametrize("limit", [1.0, 0.1, 3e-9, 1e30, 0.0])
def test_signed_ranges_are_symmetric_about_zero(limit):
    values = tick_values(-limit, limit, True)
    assert values[2] == 0.0 and values[0] == -limit and values[-1] == limit
    assert values[:2] == [-value for value in values[:2:-1]]
    assert tick_values(0.0, limit, False) == [0.0, limit / 2, limit]


@pytest.mark.parametrize(("is_signed", "colormap"), [(True, DIVERGING), (False, SEQUENTIAL)])
def test_stripes_have_the_colors_of_the_mesh(is_signed, colormap):
    places = [0.0, 0.3, 0.5, 1.0]
    found = np.array(legend.stripe_colors(is_signed, places))
    linear = map_colors(colormap, np.interp(places, [0, 1], [colormap.low, colormap.high]))
    # Back from sRGB by its other formula.
    back = np.where(found <= 0.04045, found / 12.92, ((found + 0.055) / 1.055) ** 2.4)
    assert np.allclose(back[:, :3], linear[:, :3], atol=1e-4) and (found[:, 3] == 1).all()


@pytest.fixture
def torus(make_object, rng):
    obj = make_object(meshes.noisy(meshes.triangle_torus(), rng), "Torus")
    bpy.ops.object.framelet_denoise(preset="TRI_2")
    return obj


def view():
    """Return an area with a 3D View."""
    return next(area for area in bpy.context.screen.areas if area.type == "VIEW_3D")


def is_wanted():
    with bpy.context.temp_override(area=view()):
        return legend.is_wanted(bpy.context)


def texts():
    return legend.legend_texts(bpy.context.scene, bpy.context.window_manager.framelet_band_range)


def test_it_is_there_while_the_colors_are(torus):
    space = view().spaces.active
    assert not is_wanted()
    bpy.ops.object.framelet_heat_map()
    assert is_wanted()
    space.overlay.show_overlays = False
    assert not is_wanted()
    space.overlay.show_overlays = True
    for shading, color in (("SOLID", "MATERIAL"), ("WIREFRAME", None), ("RENDERED", None)):
        space.shading.type = shading
        if color:
            space.shading.color_type = color
        assert not is_wanted()
    space.shading.type, space.shading.color_type = "SOLID", "VERTEX"
    torus.hide_set(True)
    assert not is_wanted()
    torus.hide_set(False)
    torus.select_set(True)
    other = torus.data.color_attributes.new("Mine", "FLOAT_COLOR", "POINT")
    torus.data.attributes.active_color_name = other.name
    assert not is_wanted()
    torus.data.attributes.active_color_name = "framelet_heat_map"
    assert is_wanted()
    bpy.ops.object.framelet_hide_colors()
    space.shading.color_type = "VERTEX"
    assert not is_wanted()


def test_it_is_there_for_names_with_commas(torus):
    torus.name = "Left, upper"
    bpy.ops.object.framelet_heat_map()
    assert is_wanted()


def test_it_goes_when_the_object_does(torus):
    bpy.ops.object.framelet_heat_map()
    bpy.data.objects.remove(torus)
    assert not is_wanted()


def test_labels_have_the_units_of_the_scene(torus):
    bpy.ops.object.framelet_heat_map(range_rule="FIXED", limit=0.002)
    title, labels, _ = texts()
    assert title == "Displacement along normals"
    assert labels == ["−2 mm", "−1 mm", "0 mm", "1 mm", "2 mm"]
    bpy.context.scene.unit_settings.system = "NONE"
    assert texts()[1] == ["−0.002", "−0.001", "0", "0.001", "0.002"]
    bpy.context.scene.unit_settings.system = "IMPERIAL"
    assert texts()[1][-1].endswith(" thou")


@pytest.mark.parametrize("system", ["METRIC", "IMPERIAL", "NONE"])
@pytest.mark.parametrize("scale", [1.0, 0.001, 1000.0])
@pytest.mark.parametrize("limit", [1e-12, 3.3e-5, 0.0108137, 0.3, 0.305, 7.0, 1500.0, 4e7])
def test_all_labels_have_one_unit_and_are_true(system, scale, limit):
    units = bpy.context.scene.unit_settings
    units.system, units.scale_length = system, scale
    labels = value_texts(bpy.context.scene, [-limit, -limit / 2, 0.0, limit / 2, limit])
    parts = [re.fullmatch(r"−?([\d.e+-]+?)( ?[^\d.e+-]*)", label).groups() for label in labels]
    numbers, suffixes = zip(*parts, strict=True)
    assert len(set(suffixes)) == 1
    assert [label.startswith("−") for label in labels] == [True, True, False, False, False]
    numbers = [float(number) for number in numbers]
    assert numbers[2] == 0 and numbers[0] == numbers[4] and numbers[1] == numbers[3]
    assert numbers[3] == pytest.approx(numbers[4] / 2, rel=1e-2)
    if suffixes[0]:
        back = bpy.utils.units.to_value(system, "LENGTH", f"{numbers[4]}{suffixes[0]}") / units.scale_length
        assert back == pytest.approx(limit, rel=1e-2)
    else:
        assert numbers[4] == pytest.approx(limit, rel=1e-2)


def test_angles_are_in_degrees(torus):
    bpy.ops.object.framelet_heat_map(quantity="ANGLE", range_rule="MAXIMUM")
    title, labels, note = texts()
    highest = bpy.context.window_manager.framelet_band_range.maximum
    assert title == "Angle change of faces"
    assert labels == ["0°", f"{highest / 2:.3g}°", f"{highest:.3g}°"]
    assert note == ""


@pytest.mark.parametrize(("quantity", "title"), [("NOISE", "Noise"), ("WIDTH", "Noise width in edges")])
def test_noise_is_a_length_and_its_width_is_in_edges(torus, quantity, title):
    bpy.ops.object.framelet_heat_map(quantity=quantity, range_rule="FIXED", limit=0.04, limit_edges=2.5)
    unit = " cm" if quantity == "NOISE" else ""
    assert texts()[:2] == (title, [f"{number}{unit}" for number in ((0, 2, 4) if unit else (0, 1.25, 2.5))])


def test_it_serves_bands_too(torus):
    bpy.ops.object.framelet_analyze(levels=2)
    bpy.ops.object.framelet_show_band(level=2, band=3)
    assert is_wanted()
    title, labels, note = texts()
    assert title == "Level 2, band 3" and len(labels) == 5
    share = bpy.context.window_manager.framelet_band_range.share
    assert note == f"{share:.1f}% in this range" and share < 100


def test_registering_takes_and_gives_back_the_handle():
    assert legend._handle is not None
    legend.unregister()
    assert legend._handle is None
    legend.register()
    assert legend._handle is not None
