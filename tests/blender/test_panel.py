# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels show every setting once and draw without errors."""

import re

import bpy
import framelet.ui
import meshes
import pytest
from drawing import draw
from framelet.core.settings import PRESETS
from framelet.operators import band_settings, mesh_facts, setting_values
from framelet.ui import band_panels, panel, region_panel, report_panels, see_panel
from framelet.ui.layouts import FrameletPanel


def test_panels_are_registered_in_one_tab():
    panels = [each for each in framelet.ui.classes if issubclass(each, FrameletPanel)]
    for each in panels:
        assert each.is_registered
        assert (each.bl_category, each.bl_region_type, each.bl_space_type) == ("Framelet", "UI", "VIEW_3D")
        assert each.bl_label
        assert each is panel.VIEW3D_PT_framelet or each.bl_options == {"DEFAULT_CLOSED"}
    parents = [each for each in panels if not hasattr(each, "bl_parent_id")]
    assert parents == [panel.VIEW3D_PT_framelet]


@pytest.mark.parametrize("preset", list(PRESETS))
def test_every_setting_of_a_method_is_shown_once(preset):
    bpy.context.scene.framelet.preset = preset
    method = PRESETS[preset].settings.method
    shown = draw(panel.VIEW3D_PT_framelet)["prop"] + draw(panel.VIEW3D_PT_framelet_advanced)["prop"]
    region = draw(region_panel.VIEW3D_PT_framelet_region)["prop"]
    shown += [name for name in region if name in setting_values.SETTING_NAMES]
    expected = [name for name in setting_values.PROPERTY_NAMES if setting_values.has_effect(method, name)]
    assert sorted(shown) == sorted(expected)


def test_the_button_carries_the_scene_settings():
    scene_settings = bpy.context.scene.framelet
    scene_settings.preset = "TRI_1"
    scene_settings.mu = 4.0
    record = draw(panel.VIEW3D_PT_framelet)
    assert record["operator"] == ["object.framelet_denoise", "object.framelet_preview"]
    values = record["object.framelet_denoise"]
    assert (values.preset, values.mu) == ("TRI_1", 4.0)


def panel_lines(label, each, following):
    """Return the labels of a panel between two others."""
    labels = draw(each)["label"]
    return labels[labels.index(label) + 1 : labels.index(following)]


def test_last_run_before_and_after():
    assert draw(report_panels.VIEW3D_PT_framelet_last_run)["label"] == ["Nothing was denoised yet"]
    bpy.ops.mesh.primitive_monkey_add()
    bpy.ops.object.framelet_denoise()
    labels = draw(report_panels.VIEW3D_PT_framelet_last_run)["label"]
    assert "Suzanne" in labels and "Open mesh" in labels
    assert re.fullmatch(r"[\d.]+ cm", labels[labels.index("RMS") + 1])
    assert re.fullmatch(r"\d+\.\d{3} edge lengths", labels[labels.index("RMS") + 3])
    recipe = bpy.context.window_manager.framelet_report.recipe
    lines = labels[labels.index("Chosen") + 1 : labels.index("Iterations")]
    # A line each, as in the panel above: two recipes do not fit into one.
    assert " and ".join(line for line in lines if line).replace(" and after ", " after ") == recipe != ""
    assert lines == panel_lines("Chosen", panel.VIEW3D_PT_framelet, "Frame")
    assert re.fullmatch(r"[\d.]+ c?m", labels[labels.index("Noise") + 1])
    bpy.ops.object.framelet_denoise(preset="TRI_2")
    labels = draw(report_panels.VIEW3D_PT_framelet_last_run)["label"]
    assert not {"Noise", "Chosen", "From Noise"} & set(labels)


CHOSEN = ["Chosen", "Frame", "Levels", "Smoothing λ", "Penalty μ"]


def table(labels):
    """Return the rows of a table that was drawn as label, value, label, value."""
    return dict(zip(labels[::2], labels[1::2], strict=True))


def test_the_automatic_panel_is_calm():
    shown = draw(panel.VIEW3D_PT_framelet)
    assert shown["prop"] == ["preset", "method", "strength"]
    assert table(shown["label"]) == dict(zip(CHOSEN, ["At the next run", "–", "–", "–", "–"], strict=True))


def test_the_automatic_panel_shows_grayed_what_the_run_chose():
    bpy.ops.mesh.primitive_monkey_add()
    bpy.ops.object.framelet_add_noise(sigma=0.1)
    bpy.ops.object.framelet_denoise()
    shown = draw(panel.VIEW3D_PT_framelet)
    entry = bpy.context.window_manager.framelet_estimate.objects["Suzanne"]
    rows = table(shown["label"])
    assert [label for label in rows if label] == CHOSEN and shown["grayed"] == shown["label"]
    assert bpy.context.window_manager.framelet_report.recipe.startswith(rows["Chosen"])
    names = ("frame", "levels", "lambda", "mu")
    assert [rows[label] for label in CHOSEN[1:]] == [
        getattr(entry, f"chosen_{name}").partition("\n")[0] or "–" for name in names
    ]
    entry.chosen_recipe, entry.chosen_lambda = "Soft\nFlat and sharp", ""
    labels = draw(panel.VIEW3D_PT_framelet)["label"]
    assert labels[:4] == ["Chosen", "Soft", "", "Flat and sharp"]
    assert labels[labels.index("Smoothing λ") + 1] == "–"
    bpy.ops.mesh.primitive_cube_add()
    assert table(draw(panel.VIEW3D_PT_framelet)["label"])["Chosen"] == "At the next run"


@pytest.mark.parametrize("tuning", ["GIVEN", "NOISE"])
def test_what_comes_from_the_noise_is_grayed(tuning):
    settings = bpy.context.scene.framelet
    settings.preset, settings.tuning = "POSITIONS", tuning
    record = draw(panel.VIEW3D_PT_framelet)
    assert record["prop"][:3] == ["preset", "method", "tuning"]
    is_tuned = tuning == "NOISE"
    grayed = ["lambda_", "mu", "Smoothing λ", "–", "Penalty μ", "–"]
    assert record["grayed"] == (grayed if is_tuned else [])
    assert ("iterations" in draw(panel.VIEW3D_PT_framelet_advanced)["grayed"]) == is_tuned
    settings.preset = "BILATERAL"
    settings.tuning = tuning
    assert draw(panel.VIEW3D_PT_framelet)["grayed"] == []


def test_what_the_noise_gave_is_shown():
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=4)
    bpy.ops.object.framelet_add_noise(sigma=0.2)
    settings = bpy.context.scene.framelet
    settings.preset, settings.tuning = "POSITIONS", "NOISE"
    bpy.ops.object.framelet_denoise(preset="POSITIONS", tuning="NOISE")
    rows = table(draw(panel.VIEW3D_PT_framelet)["label"])
    given = bpy.context.window_manager.framelet_report.parameters
    assert given == f"λ {rows['Smoothing λ']}, μ {rows['Penalty μ']}"


def test_the_noise_of_the_active_object_is_shown_once_it_is_measured():
    bpy.ops.mesh.primitive_monkey_add()
    bpy.ops.object.framelet_add_noise(sigma=0.1)
    record = draw(report_panels.VIEW3D_PT_framelet_noise)
    assert record["operator"] == ["object.framelet_estimate_noise"] and record["label"] == []
    bpy.ops.object.framelet_estimate_noise()
    labels = draw(report_panels.VIEW3D_PT_framelet_noise)["label"]
    assert labels[0] == "Noise"
    assert re.fullmatch(r"[\d.]+ c?m", labels[1])
    assert re.fullmatch(r"\d\.\d{3} edge lengths", labels[3])
    assert table(draw(panel.VIEW3D_PT_framelet)["label"])["Chosen"] == "At the next run"
    bpy.ops.object.framelet_denoise()
    assert draw(report_panels.VIEW3D_PT_framelet_noise)["label"][0] == "Noise Before"
    entry = bpy.context.window_manager.framelet_estimate.objects["Suzanne"]
    for is_impulsive in (True, False):
        entry.is_impulsive = is_impulsive
        assert ("Impulsive" in draw(report_panels.VIEW3D_PT_framelet_noise)["label"]) == is_impulsive
    bpy.context.scene.framelet.preset = "TRI_2"
    assert draw(panel.VIEW3D_PT_framelet)["label"] == []
    bpy.ops.mesh.primitive_cube_add()
    assert draw(report_panels.VIEW3D_PT_framelet_noise)["label"] == []


def test_lengths_follow_the_units_of_the_scene():
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3)
    bpy.ops.object.framelet_denoise()

    def rms():
        labels = draw(report_panels.VIEW3D_PT_framelet_last_run)["label"]
        return labels[labels.index("RMS") + 1]

    units = bpy.context.scene.unit_settings
    metric = rms()
    units.system = "NONE"
    assert re.fullmatch(r"[\d.e-]+", rms())
    units.system = "METRIC"
    units.scale_length = 1000.0
    assert rms() != metric


def test_volume_of_closed_meshes_and_number_of_objects():
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3)
    first = bpy.context.object
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=2)
    first.select_set(True)
    bpy.ops.object.framelet_denoise(preset="TRI_2")
    labels = draw(report_panels.VIEW3D_PT_framelet_last_run)["label"]
    assert labels[labels.index("Objects") + 1] == "2"
    assert re.fullmatch(r"-\d+\.\d{2} %", labels[labels.index("Volume") + 1])


def test_try_it_before_and_after():
    record = draw(report_panels.VIEW3D_PT_framelet_try_it)
    assert record["operator"] == ["object.framelet_add_noise", "object.framelet_compare"]
    assert record["label"] == []
    bpy.ops.mesh.primitive_monkey_add()
    first = bpy.context.object
    bpy.ops.mesh.primitive_monkey_add()
    bpy.ops.object.framelet_add_noise()
    first.select_set(True)
    bpy.ops.object.framelet_compare()
    labels = draw(report_panels.VIEW3D_PT_framelet_try_it)["label"]
    assert {"Suzanne", "Suzanne.001", "Mean Angle"} <= set(labels)


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
    bpy.context.scene.framelet.method = "NORMALS"
    assert draw(panel.VIEW3D_PT_framelet_advanced)["icon"] == []


def test_what_a_run_changed_is_shown_by_buttons_that_stay_pressed(make_object, rng):
    name = "object.framelet_{}".format
    obj = make_object(meshes.noisy(meshes.triangle_torus(), rng), "Torus")
    record = draw(see_panel.VIEW3D_PT_framelet_see)
    expected = [name("before_after"), name("heat_map"), name("heat_map")]
    assert record["operator"] == expected and record["pressed"] == []
    bpy.ops.object.framelet_denoise(preset="TRI_2")
    for quantity, first in (("NORMAL", True), ("ANGLE", False)):
        bpy.ops.object.framelet_heat_map(quantity=quantity)
        record = draw(see_panel.VIEW3D_PT_framelet_see)
        both = [name("hide_colors"), name("heat_map")] if first else [name("heat_map"), name("hide_colors")]
        assert record["operator"] == [name("before_after"), *both]
        assert record["pressed"] == [name("hide_colors")]
        assert record[name("heat_map")].quantity == ("ANGLE" if first else "NORMAL")
    obj.data.attributes.active_color_name = ""
    assert draw(see_panel.VIEW3D_PT_framelet_see)["pressed"] == []
    bpy.ops.mesh.primitive_cube_add()
    assert draw(see_panel.VIEW3D_PT_framelet_see)["pressed"] == []


@pytest.mark.parametrize("rule", ["PERCENTILE", "MAXIMUM", "FIXED"])
def test_the_heat_map_takes_the_range_of_the_scene(make_object, rng, rule):
    make_object(meshes.noisy(meshes.triangle_torus(), rng), "Torus")
    bpy.ops.object.framelet_denoise(preset="TRI_2")
    heat = bpy.context.scene.framelet_heat_map
    heat.range_rule, heat.percentile, heat.limit = rule, 77.0, 0.5
    more = {"PERCENTILE": ["percentile"], "MAXIMUM": [], "FIXED": ["limit"]}[rule]
    record = draw(see_panel.VIEW3D_PT_framelet_see)
    assert record["prop"] == ["range_rule", *more]
    values = record["object.framelet_heat_map"]
    assert (values.range_rule, values.percentile, values.limit) == (rule, 77.0, 0.5)
    bpy.ops.object.framelet_heat_map(quantity="ANGLE")
    more = ["limit_angle"] if rule == "FIXED" else more
    assert draw(see_panel.VIEW3D_PT_framelet_see)["prop"] == ["range_rule", *more]
