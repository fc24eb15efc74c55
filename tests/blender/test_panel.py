# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels show every setting once and draw without errors."""

import re

import bpy
import framelet.ui
import pytest
from blender_objects import noisy_monkey
from drawing import draw
from framelet.core.learned.scales import N_SCALES
from framelet.core.settings import PRESETS
from framelet.operators.properties import setting_values
from framelet.operators.properties.scene_units import range_text
from framelet.ui.panels import panel, region_panel, report_panels, run_rows
from framelet.ui.panels.layouts import FrameletPanel
from run_steps import start, until_done


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
    region += draw(region_panel.VIEW3D_PT_framelet_mask)["prop"]
    shown += [name for name in region if name in setting_values.SETTING_NAMES]
    expected = [name for name in setting_values.PROPERTY_NAMES if setting_values.has_effect(method, name)]
    assert sorted(shown) == sorted([*expected, "amount"])


def test_the_button_carries_the_scene_settings():
    scene_settings = bpy.context.scene.framelet
    scene_settings.preset = "TRI_1"
    scene_settings.mu = 4.0
    record = draw(panel.VIEW3D_PT_framelet)
    assert record["operator"] == ["object.framelet_denoise", "object.framelet_preview"]
    values = record["object.framelet_denoise"]
    assert (values.preset, values.mu) == ("TRI_1", 4.0)


def test_last_run_before_and_after():
    assert draw(report_panels.VIEW3D_PT_framelet_last_run)["label"] == ["Nothing was denoised yet"]
    bpy.ops.mesh.primitive_monkey_add()
    bpy.ops.object.framelet_add_noise(sigma=0.1)
    bpy.ops.object.framelet_denoise()
    labels = draw(report_panels.VIEW3D_PT_framelet_last_run)["label"]
    assert "Suzanne" in labels and "Open mesh" in labels
    assert re.fullmatch(r"[\d.]+ cm", labels[labels.index("RMS") + 1])
    assert re.fullmatch(r"\d+\.\d{3} edge lengths", labels[labels.index("RMS") + 3])
    noise = labels.index("Noise")
    assert re.fullmatch(r"[\d.]+ to [\d.]+ c?m", labels[noise + 1])
    assert labels[noise + 2] == "" and re.fullmatch(r"[\d.]+ to [\d.]+ edges", labels[noise + 3])
    assert labels[labels.index("Passes") + 1] == "2" and "Iterations" not in labels
    bpy.ops.object.framelet_denoise(preset="TRI_2")
    labels = draw(report_panels.VIEW3D_PT_framelet_last_run)["label"]
    assert not {"Noise", "Width", "Spikes", "Clean", "From Noise", "Passes"} & set(labels)
    assert "Iterations" in labels


def test_the_noise_that_was_removed_has_a_line_for_what_there_is():
    report = bpy.context.window_manager.framelet_report
    bpy.context.scene.unit_settings.system = "NONE"

    def rows(**values):
        for name, value in values.items():
            setattr(report, name, value)
        return draw(
            lambda drawn, context: report_panels.draw_belief(drawn.layout, context.scene, "Noise", report)
        )["label"]

    plain = ["Noise", "0.02 to 0.05", "", "0.1 to 0.25 edges"]
    assert rows(sigma_low=0.02, sigma_high=0.05, sigma_low_edges=0.1, sigma_high_edges=0.25) == plain
    assert rows(width=0.39) == plain
    width, spikes, clean = ["Width", "about 3.2 edges"], ["Spikes", "0.5%"], ["Clean", "33.3% stayed"]
    assert rows(width=3.21) == [*plain, *width]
    assert rows(spikes=0.5) == [*plain, *width, *spikes]
    assert rows(clean=100 / 3) == [*plain, *width, *spikes, *clean]
    assert rows(is_clean=True) == ["Noise", "Clean already"]
    assert rows(is_off=True) == ["Noise", "Strength is 0"]


@pytest.mark.parametrize(("strength", "words"), [(1.0, "Clean already"), (0.0, "Strength is 0")])
def test_panels_say_why_nothing_moved(strength, words):
    bpy.ops.mesh.primitive_cube_add()
    bpy.ops.object.framelet_denoise(strength=strength)
    labels = draw(report_panels.VIEW3D_PT_framelet_last_run)["label"]
    assert labels[labels.index("Noise") + 1] == words and labels[labels.index("Passes") + 1] == "0"
    assert draw(report_panels.VIEW3D_PT_framelet_noise)["label"] == ["Noise Before", words]


def table(labels):
    """Return the rows of a table that was drawn as label, value, label, value."""
    return dict(zip(labels[::2], labels[1::2], strict=True))


ROWS = ["Frame", "Levels", "Smoothing λ", "Penalty μ"]


def test_automatic_has_a_gray_row_for_each_parameter_of_the_paper():
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=4)
    record = draw(panel.VIEW3D_PT_framelet)
    rows = table(record["label"])
    assert list(rows) == ROWS and set(record["label"]) <= set(record["grayed"])
    assert rows["Levels"] == str(N_SCALES) and rows["Smoothing λ"] == "By local noise"
    bpy.ops.object.framelet_denoise()
    assert table(draw(panel.VIEW3D_PT_framelet)["label"])["Smoothing λ"] == "Clean already"
    bpy.ops.object.framelet_add_noise(sigma=0.2)
    bpy.ops.object.framelet_denoise()
    words = table(draw(panel.VIEW3D_PT_framelet)["label"])["Smoothing λ"]
    report = bpy.context.window_manager.framelet_report
    assert words == f"{range_text(report.sigma_low_edges, report.sigma_high_edges)} edges"


def test_subpanels_stand_in_the_order_of_work():
    panels = [each for each in framelet.ui.classes if issubclass(each, FrameletPanel)]
    main = [each.bl_label for each in panels if getattr(each, "bl_parent_id", "") == "VIEW3D_PT_framelet"]
    assert main[:5] == ["Output", "Mask", "Constraints", "Result", "Bands"]
    assert [
        each.bl_label for each in panels if getattr(each, "bl_parent_id", "") == "VIEW3D_PT_framelet_see"
    ] == [
        "Last Run",
        "Noise",
    ]


def test_the_automatic_panel_is_calm():
    for _ in range(2):
        shown = draw(panel.VIEW3D_PT_framelet)
        assert shown["prop"] == ["preset", "method", "strength", "noise", "amount"]
        assert shown["slider"] == ["strength"]  # that has a fill, as a factor has by itself
        assert list(table(shown["label"])) == ROWS
        assert draw(panel.VIEW3D_PT_framelet_advanced)["prop"] == ["passes", "threads"]
        bpy.ops.mesh.primitive_cube_add()
        bpy.ops.object.framelet_denoise()


@pytest.mark.parametrize("tuning", ["GIVEN", "NOISE"])
def test_what_comes_from_the_noise_is_grayed(tuning):
    settings = bpy.context.scene.framelet
    settings.preset, settings.tuning = "POSITIONS", tuning
    record = draw(panel.VIEW3D_PT_framelet)
    assert record["prop"][:5] == ["preset", "method", "strength", "amount", "tuning"]
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
    entry = bpy.context.window_manager.framelet_estimate.objects["Suzanne"]
    for is_impulsive in (True, False):
        entry.is_impulsive = is_impulsive
        assert ("Impulsive" in draw(report_panels.VIEW3D_PT_framelet_noise)["label"]) == is_impulsive
    bpy.ops.object.framelet_denoise()
    labels = draw(report_panels.VIEW3D_PT_framelet_noise)["label"]
    last = draw(report_panels.VIEW3D_PT_framelet_last_run)["label"]
    assert labels[0] == "Noise Before"
    assert labels[1:] == last[last.index("Noise") + 1 : last.index("Passes")]
    bpy.context.scene.framelet.preset = "TRI_2"
    assert draw(panel.VIEW3D_PT_framelet)["label"] == []
    bpy.ops.mesh.primitive_cube_add()
    assert draw(report_panels.VIEW3D_PT_framelet_noise)["label"] == []


def test_lengths_follow_the_units_of_the_scene():
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3)
    bpy.ops.object.framelet_add_noise()
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
    assert re.fullmatch(r"-\d+\.\d{2}%", labels[labels.index("Volume") + 1])


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


@pytest.mark.usefixtures("no_thread_stays")
def test_no_row_pops_in_while_a_run_goes_on(gate):
    """The bar stands where the preview's button stood, so that no slider moves under the mouse."""
    noisy_monkey()
    record = draw(panel.VIEW3D_PT_framelet)
    assert record["operator"][1:] == ["object.framelet_preview"] and not record["progress"]
    run = start(bpy.context.active_object)
    record = draw(panel.VIEW3D_PT_framelet)
    assert record["operator"][1:] == ["object.framelet_cancel"] and len(record["progress"]) == 1
    gate.set()
    until_done(run)


def test_a_long_name_is_all_that_the_button_of_the_preview_says():
    assert run_rows.preview_text("Monkey") == "Preview of ‘Monkey’"
    assert run_rows.preview_text("Bust, scanned in May") == "‘Bust, scanned in May’"


def test_what_the_preview_says_stands_below_the_settings(monkeypatch):
    noisy_monkey()
    monkeypatch.setattr(run_rows, "preview_message", lambda: "It ended")
    labels = draw(panel.VIEW3D_PT_framelet)["label"]
    assert labels[-1] == "It ended"
