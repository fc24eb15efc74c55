# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The subpanels of bands, the equalizer and frames, and what a run changed, drawn without a screen."""

import re

import bpy
import meshes
import pytest
from drawing import draw
from framelet.operators.mesh_io import mesh_facts
from framelet.operators.properties import band_settings
from framelet.ui.panels import band_panels, panel, see_panel


def test_bands_before_and_after():
    record = draw(band_panels.VIEW3D_PT_framelet_bands)
    assert record["operator"] == ["object.framelet_analyze"]
    assert record["prop"] == ["frame", "levels", "max_megabytes"] and "Needs" not in record["label"]
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3)
    bpy.context.scene.framelet.levels = 2
    labels = draw(band_panels.VIEW3D_PT_framelet_bands)["label"]
    assert labels == ["Needs", "27 kB"]
    bpy.context.scene.framelet.preset = "POSITIONS"
    assert draw(band_panels.VIEW3D_PT_framelet_bands)["prop"] == ["max_megabytes"]
    bpy.ops.object.framelet_analyze(levels=2)
    record = draw(band_panels.VIEW3D_PT_framelet_bands)
    names = ("analyze", "show_band", "synthesize", "clear")
    assert record["operator"] == [f"object.framelet_{name}" for name in names]
    assert {"Box Spline", "2 levels, 12 bands"} <= set(record["label"])
    assert "Colors" not in record["label"]
    bpy.ops.object.framelet_show_band(band=3)
    labels = draw(band_panels.VIEW3D_PT_framelet_bands)["label"]
    assert labels[labels.index("Colors") + 1] == "Level 1, band 3"
    assert re.fullmatch(r"[\d.]+ [cm]*m", labels[labels.index("Red") + 1])
    assert labels[labels.index("Blue") + 1] == f"−{labels[labels.index('Red') + 1]}"
    bpy.ops.object.framelet_show_band(content="LEVEL")
    labels = draw(band_panels.VIEW3D_PT_framelet_bands)["label"]
    assert labels[labels.index("Gray") + 1] == "0"
    bpy.context.object.data["framelet_bands"] = "x"
    assert "No bands that can be read" in draw(band_panels.VIEW3D_PT_framelet_bands)["label"]


def test_the_band_buttons_carry_the_scene_settings():
    bpy.ops.mesh.primitive_ico_sphere_add()
    bpy.ops.object.framelet_analyze()
    scene = bpy.context.scene
    scene.framelet.frame, scene.framelet.levels, scene.framelet.boundary = "ADAPTIVE", 3, "FREE"
    scene.framelet_bands.max_megabytes = 7.0
    scene.framelet_bands.level, scene.framelet_bands.content = 2, "LEVEL"
    record = draw(band_panels.VIEW3D_PT_framelet_bands)
    values = record["object.framelet_analyze"]
    assert (values.frame, values.levels, values.boundary, values.max_megabytes) == ("ADAPTIVE", 3, "FREE", 7)
    values = record["object.framelet_show_band"]
    assert (values.level, values.content, values.range_rule) == (2, "LEVEL", "PERCENTILE")
    scene.framelet_equalizer.gain_2 = 1.5
    scene.framelet_equalizer.vertex_group = "Nose"
    values = draw(band_panels.VIEW3D_PT_framelet_equalizer)["object.framelet_equalize"]
    assert (values.frame, values.boundary, values.levels) == ("ADAPTIVE", "FREE", 3)
    assert (values.gain_1, values.gain_2, values.vertex_group) == (1.0, 1.5, "Nose")


@pytest.mark.parametrize("content", ["BAND", "LEVEL", "LOW"])
@pytest.mark.parametrize("rule", ["PERCENTILE", "MAXIMUM", "FIXED"])
def test_only_what_counts_is_shown(content, rule):
    bpy.ops.mesh.primitive_ico_sphere_add()
    bpy.ops.object.framelet_analyze()
    bands = bpy.context.scene.framelet_bands
    bands.content, bands.range_rule = content, rule
    shown = draw(band_panels.VIEW3D_PT_framelet_bands)["prop"]
    assert ("band" in shown, "level" in shown) == (content == "BAND", content != "LOW")
    assert ("component" in shown) == (content != "LEVEL")
    assert ("percentile" in shown, "limit" in shown) == (rule == "PERCENTILE", rule == "FIXED")
    assert set(shown) - {"frame", "levels", "max_megabytes"} <= set(band_settings.SHOW_NAMES)


def test_the_equalizer_shows_the_gains_of_its_levels():
    bpy.ops.mesh.primitive_ico_sphere_add()
    equalizer = bpy.context.scene.framelet_equalizer
    bpy.context.scene.framelet.preset = "POSITIONS"
    for levels in (1, 6):
        equalizer.levels = levels
        shown = draw(band_panels.VIEW3D_PT_framelet_equalizer)["prop"]
        assert shown == ["levels", *band_settings.GAIN_NAMES[:levels], "vertex_group", "invert"]


def test_the_frame_is_shown_somewhere_with_every_method():
    for preset in ("AUTO", "POSITIONS", "BILATERAL"):
        bpy.context.scene.framelet.preset = preset
        main = "frame" in draw(panel.VIEW3D_PT_framelet)["prop"]
        for each in band_panels.classes:
            assert ("frame" in draw(each)["prop"]) != main


def test_frames_that_do_not_fit_are_shown_as_such():
    scene = bpy.context.scene
    scene.framelet.preset = "POSITIONS"
    cases = {
        ("primitive_ico_sphere_add", "LINEAR_SPLINE"): [("For quads; this mesh has none", "ERROR")],
        ("primitive_ico_sphere_add", "BOX_SPLINE_111"): [],
        ("primitive_cube_add", "BOX_SPLINE_111"): [("For triangles; this mesh has none", "INFO")],
        ("primitive_cube_add", "LINEAR_SPLINE"): [],
        ("primitive_cube_add", "B_SPLINE_3"): [],
        ("primitive_circle_add", "B_SPLINE_3"): [("Needs quads or pairs of triangles", "ERROR")],
        ("primitive_circle_add", "ADAPTIVE"): [],
        ("primitive_circle_add", "AUTO"): [],
    }
    for (shape, frame), expected in cases.items():
        options = {"fill_type": "NGON"} if "circle" in shape else {}
        getattr(bpy.ops.mesh, shape)(**options)
        scene.framelet.frame = frame
        assert draw(panel.VIEW3D_PT_framelet)["icon"] == expected, (shape, frame)
        problem = bool(expected) and expected[0][1] == "ERROR"
        try:
            bpy.ops.object.framelet_analyze(frame=frame)
        except RuntimeError:
            assert problem
        else:
            assert not problem
    scene.framelet.stencil, scene.framelet.frame = "ADAPTIVE", "B_SPLINE_3"
    assert draw(panel.VIEW3D_PT_framelet)["icon"] == []
    bpy.ops.object.mode_set(mode="EDIT")
    scene.framelet.stencil = "STRAIGHT"
    assert draw(panel.VIEW3D_PT_framelet)["icon"] == []


def test_drawing_looks_at_a_mesh_once(monkeypatch):
    bpy.ops.mesh.primitive_ico_sphere_add()
    bpy.context.scene.framelet.preset = "POSITIONS"
    mesh_facts.forget_facts()
    draw(panel.VIEW3D_PT_framelet)

    def fail(_surface):
        raise AssertionError("looked again")

    monkeypatch.setattr(mesh_facts, "find_facts", fail)
    draw(panel.VIEW3D_PT_framelet)
    draw(band_panels.VIEW3D_PT_framelet_bands)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.subdivide()
    bpy.ops.object.mode_set(mode="OBJECT")
    with pytest.raises(AssertionError, match="looked again"):
        draw(panel.VIEW3D_PT_framelet)
    mesh_facts.forget_facts()


def test_advanced_says_which_frames_do_not_fit():
    bpy.context.scene.framelet.method = "POSITIONS"
    for shape, kind in (("primitive_ico_sphere_add", "quads"), ("primitive_cube_add", "triangles")):
        getattr(bpy.ops.mesh, shape)()
        shown = draw(panel.VIEW3D_PT_framelet_advanced)["icon"]
        assert shown == [(f"Not for this mesh: frames for {kind}", "INFO")]
    bpy.context.scene.framelet.method = "AUTO"
    assert draw(panel.VIEW3D_PT_framelet_advanced)["icon"] == []


def test_what_a_run_changed_is_shown_by_buttons_that_stay_pressed(make_object, rng):
    name = "object.framelet_{}".format
    obj = make_object(meshes.noisy(meshes.triangle_torus(), rng), "Torus")
    record = draw(see_panel.VIEW3D_PT_framelet_see)
    sides = [name("before_after")] * 2
    expected = [*sides, *[name("heat_map")] * 4]
    assert record["operator"] == expected and record["pressed"] == []
    bpy.ops.object.framelet_denoise(preset="TRI_2")
    quantities = ["NORMAL", "ANGLE", "NOISE", "WIDTH"]
    for quantity in quantities:
        bpy.ops.object.framelet_heat_map(quantity=quantity)
        record = draw(see_panel.VIEW3D_PT_framelet_see)
        buttons = [name("heat_map")] * 4
        buttons.insert(quantities.index(quantity), name("hide_colors"))  # the one behind it colors again
        assert record["operator"] == [*sides, *buttons]
        assert record["pressed"] == [name("before_after"), name("hide_colors")]
        assert record[name("heat_map")].quantity == quantities[-1]
    obj.data.attributes.active_color_name = ""
    assert draw(see_panel.VIEW3D_PT_framelet_see)["pressed"] == [name("before_after")]
    bpy.ops.mesh.primitive_cube_add()
    assert draw(see_panel.VIEW3D_PT_framelet_see)["pressed"] == []


def test_names_with_commas_are_names(make_object, rng):
    first = make_object(meshes.noisy(meshes.triangle_torus(), rng), "Left, upper")
    bpy.ops.object.framelet_denoise(preset="TRI_2")
    bpy.ops.object.framelet_heat_map()
    assert "object.framelet_hide_colors" in draw(see_panel.VIEW3D_PT_framelet_see)["pressed"]
    assert bpy.context.window_manager.framelet_band_range.objects.keys() == [first.name]
    bpy.ops.object.framelet_analyze()
    bpy.ops.object.framelet_show_band()
    assert "Colors" in draw(band_panels.VIEW3D_PT_framelet_bands)["label"]


@pytest.mark.parametrize("rule", ["PERCENTILE", "MAXIMUM", "FIXED"])
def test_the_heat_map_takes_the_range_of_the_scene(make_object, rng, rule):
    make_object(meshes.noisy(meshes.triangle_torus(), rng), "Torus")
    bpy.ops.object.framelet_denoise(preset="TRI_2")
    heat = bpy.context.scene.framelet_heat_map
    heat.range_rule, heat.percentile, heat.limit = rule, 77.0, 0.5
    more = {"PERCENTILE": ["percentile"], "MAXIMUM": [], "FIXED": ["limit"]}[rule]
    record = draw(see_panel.VIEW3D_PT_framelet_see)
    assert record["prop"] == ["range_rule", *more, "tolerance"]
    values = record["object.framelet_heat_map"]
    assert (values.range_rule, values.percentile, values.limit) == (rule, 77.0, 0.5)
    bpy.ops.object.framelet_heat_map(quantity="ANGLE")
    for quantity, name, *end in (
        ("ANGLE", "limit_angle", "tolerance_angle"),
        ("NOISE", "limit", "tolerance"),
        ("WIDTH", "limit_edges"),
    ):
        bpy.ops.object.framelet_heat_map(quantity=quantity)
        more = [name] if rule == "FIXED" else more
        assert draw(see_panel.VIEW3D_PT_framelet_see)["prop"] == ["range_rule", *more, *end]
