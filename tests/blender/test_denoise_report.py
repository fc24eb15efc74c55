# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The report of a run counts in scene units and in edge lengths, for one object and for several."""

import re
from dataclasses import replace

import bpy
import meshes
import numpy as np
import pytest
from blender_objects import noisy_monkey, read, select_only
from drawing import draw
from framelet.core import PRESETS, NoiseBelief, denoise, estimate_noise
from framelet.core.mesh.geometry import mean_edge_length
from framelet.operators import denoise_report
from framelet.operators.mesh_io import mesh_bridge
from framelet.operators.properties.scene_units import range_text
from framelet.operators.reports.filled_reports import fill_report
from framelet.operators.reports.report import BeliefMixin
from framelet.operators.run.denoise_job import MeasuredReport
from framelet.ui.panels import report_panels


def last_report():
    return bpy.context.window_manager.framelet_report


def test_report_counts_scene_units():
    obj = noisy_monkey()
    core = denoise(mesh_bridge.read_surface(obj), PRESETS["TRI_2"].settings).report
    obj.scale = (-10, 10, 10)
    obj.rotation_euler = (0.3, 0.2, 1.0)
    bpy.context.view_layer.update()
    bpy.ops.object.framelet_denoise(preset="TRI_2")
    report = last_report()
    assert report.displacement_rms == pytest.approx(10 * core.displacement_rms, rel=1e-5)
    assert report.displacement_max == pytest.approx(10 * core.displacement_max, rel=1e-5)
    assert report.displacement_rms_edges == pytest.approx(core.displacement_rms / core.mean_edge_length)
    assert report.displacement_max_edges == pytest.approx(core.displacement_max / core.mean_edge_length)
    assert report.n_vertices == core.n_vertices and report.n_moved == core.n_moved
    assert report.boundary_vertices == core.boundary_vertices > 0
    assert report.irregular_vertices == core.irregular_vertices > 0
    assert report.frame == core.frame == "BOX_SPLINE_111"
    assert not report.is_closed


def test_report_names_the_frame_that_ran():
    """Of triangles, of quads, of both together, and of an engine without any."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3)
    triangles = bpy.context.object
    bpy.ops.mesh.primitive_grid_add()
    quads = bpy.context.object
    for objects, preset, frame in (
        ([triangles], "POSITIONS", "BOX_SPLINE_111"),
        ([quads], "POSITIONS", "LINEAR_SPLINE"),
        ([triangles, quads], "POSITIONS", ""),
        ([quads], "BILATERAL", ""),
    ):
        select_only(*objects)
        bpy.ops.object.framelet_denoise(preset=preset)
        assert last_report().frame == frame


def test_report_with_another_scale_on_each_axis():
    obj = noisy_monkey()
    before = read(obj).astype(np.float64)
    obj.scale = (1, 2, 5)
    bpy.context.view_layer.update()
    bpy.ops.object.framelet_denoise(preset="TRI_2")
    moved = np.linalg.norm((read(obj) - before) * (1, 2, 5), axis=1)
    assert last_report().displacement_rms == pytest.approx(np.sqrt(np.mean(moved**2)), rel=1e-5)
    assert last_report().displacement_max == pytest.approx(moved.max(), rel=1e-5)


def test_report_of_several_objects():
    objects = [noisy_monkey("A"), noisy_monkey("B")]
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3)
    objects.append(bpy.context.object)
    before = [read(obj).astype(np.float64) for obj in objects]
    select_only(*objects)
    bpy.ops.object.framelet_denoise(preset="TRI_2")
    moved = np.concatenate(
        [np.linalg.norm(read(obj) - old, axis=1) for obj, old in zip(objects, before, strict=True)]
    )
    report = last_report()
    assert report.n_objects == 3 and report.n_vertices == len(moved)
    assert report.displacement_rms == pytest.approx(np.sqrt(np.mean(moved**2)), rel=1e-5)
    assert report.displacement_max == pytest.approx(moved.max(), rel=1e-5)
    assert not report.is_closed and report.volume_change < 0


def test_noise_of_the_default():
    obj = noisy_monkey()
    core = denoise(mesh_bridge.read_surface(obj)).report
    obj.scale = (10, 10, -10)
    bpy.context.view_layer.update()
    bpy.ops.object.framelet_denoise()
    report = last_report()
    assert report.has_noise and report.has_belief
    assert report.noise_sigma == pytest.approx(10 * core.noise.sigma) and core.noise.sigma > 0
    assert report.noise_sigma_edges == pytest.approx(core.noise.sigma_edges)
    assert report.is_impulsive == core.noise.is_impulsive
    assert report.parameters == ""
    for end in ("low", "high"):
        sigma = getattr(core.noise, f"sigma_{end}")
        assert getattr(report, f"sigma_{end}") == pytest.approx(10 * sigma, rel=1e-5)
        assert getattr(report, f"sigma_{end}_edges") == pytest.approx(sigma / core.mean_edge_length)
    assert 0 < report.sigma_low < report.noise_sigma < report.sigma_high
    assert report.width == pytest.approx(core.noise.width)
    assert report.spikes == pytest.approx(100 * core.noise.spikes)
    assert report.clean == pytest.approx(100 * core.noise.clean)
    assert not report.is_clean and not report.is_off


def test_noise_of_several_objects():
    objects = [noisy_monkey("A")]
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3)
    objects.append(bpy.context.object)
    reports = [denoise(mesh_bridge.read_surface(obj)).report for obj in objects]
    select_only(*objects)
    bpy.ops.object.framelet_denoise()
    counts = np.array([report.n_vertices for report in reports])
    squares = np.array([report.noise.sigma for report in reports]) ** 2
    report = last_report()
    assert report.noise_sigma == pytest.approx(np.sqrt((counts * squares).sum() / counts.sum()))


BELIEF = NoiseBelief(0.02, 0.2, 0.2, False, 0.02, 0.01, 0.04, 1.25, 0.01, 0.3)


def measured(n_vertices, noise=BELIEF, strength=1.0, scale=1.0):
    """Return what a run of AUTO reports, with a mean edge length of 0.1."""
    bpy.ops.mesh.primitive_cube_add()
    core = denoise(mesh_bridge.read_surface(bpy.context.object)).report
    settings = core.settings.with_changes(strength=strength)
    made = {"n_vertices": n_vertices, "mean_edge_length": 0.1, "noise": noise, "settings": settings}
    return MeasuredReport(replace(core, **made), 0.1, 0.2, scale)


def test_what_several_objects_had_of_noise_is_taken_together():
    still = replace(BELIEF, sigma=0.0, sigma_low=0.0, sigma_high=0.0, width=0.0, spikes=0.0, clean=1.0)
    strong = replace(BELIEF, sigma_low=0.03, sigma_high=0.08, width=3.0, spikes=0.0, clean=0.0)
    strong = replace(strong, wide=0.5, along=0.07)
    report = last_report()
    fill_report(report, {"A": measured(100), "B": measured(200, still), "C": measured(100, strong, scale=5)})
    found = {name: getattr(report, name) for name in BeliefMixin.__annotations__}
    assert found == pytest.approx(
        {
            "has_belief": True,
            "is_off": False,
            "is_clean": False,
            "sigma_low": 0.01,
            "sigma_high": 0.4,
            "sigma_low_edges": 0.1,
            "sigma_high_edges": 0.8,
            "width": 3.0,
            "spikes": 0.25,
            "clean": 57.5,
            "wide": 12.5,
            "along_edges": 0.07,
        }
    )
    fill_report(report, {"B": measured(200, still)})
    assert report.is_clean and report.clean == 100 and report.sigma_high == report.width == 0
    fill_report(report, {"B": measured(200, still, strength=0.0)})
    assert report.is_off and not report.is_clean


def test_last_run_says_what_was_wide_and_along_the_surface(make_object, rng):
    make_object(meshes.noisy(meshes.quad_torus(30, 60), rng, 0.15), "Torus")
    bpy.ops.object.framelet_denoise()
    shown = draw(report_panels.VIEW3D_PT_framelet_last_run)["label"]
    assert "Along Surface" in shown and "Wide" not in shown
    assert f"{last_report().along_edges:.2g} edges" in shown
    bpy.ops.object.framelet_denoise(noise="WIDE", from_original=True)
    assert "Wide" in draw(report_panels.VIEW3D_PT_framelet_last_run)["label"]


def test_a_run_without_noise_shows_none_of_an_earlier_one():
    obj = noisy_monkey()
    bpy.ops.object.framelet_denoise()
    assert last_report().has_noise
    bpy.ops.object.framelet_denoise(preset="TRI_2")
    report = last_report()
    assert not report.has_noise and not report.is_impulsive
    assert (report.noise_sigma, report.noise_sigma_edges) == (0, 0)
    assert not any(getattr(report, name) for name in BeliefMixin.__annotations__)
    assert obj.name not in bpy.context.window_manager.framelet_estimate.objects


def test_the_sentence_names_the_range_of_the_noise(capfd):
    noisy_monkey()
    bpy.ops.object.framelet_denoise()
    # One breath; everything else is in Last Run.
    found = re.search(
        r"Denoised ‘\w+’ in [\d.]+ s: noise of ([\d.]+) to ([\d.]+) cm removed\n", capfd.readouterr().out
    )
    report = last_report()
    expected = [100 * report.sigma_low, 100 * report.sigma_high]
    assert [float(text) for text in found.groups()] == pytest.approx(expected, rel=0.05)
    bpy.ops.object.framelet_denoise(preset="TRI_2")
    assert "; noise" not in capfd.readouterr().out
    bpy.ops.object.framelet_denoise(preset="TRI_2", tuning="NOISE")
    used = last_report().parameters
    assert re.search(
        rf"; noise [\d.]+ [cm]?m \(\d\.\d{{3}} edge lengths(, impulsive)?\); used {used}\n",
        capfd.readouterr().out,
    )


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({}, ": noise of 0.01 to 0.04 removed"),
        ({"sigma_low": 0.04, "width": 6}, ": noise of 0.04 removed"),
    ],
)
def test_the_sentence_says_what_there_is_to_say(changes, words):
    scene = bpy.context.scene
    scene.unit_settings.system = "NONE"
    fill_report(last_report(), {"A": measured(100, replace(BELIEF, **changes))})
    assert denoise_report._noise_words(scene, last_report()) == words


def test_ranges_have_one_unit_and_end_where_they_begin():
    scene = bpy.context.scene
    assert range_text(0.00123, 0.0456, scene) == "0.12 to 4.6 cm"
    assert range_text(0.00123, 0.0456) == "0.0012 to 0.046"
    assert range_text(0.0451, 0.0452, scene) == "4.5 cm"
    assert range_text(0.0, 0.0) == "0"
    scene.unit_settings.system = "NONE"
    assert range_text(0.00123, 0.0456, scene) == "0.0012 to 0.046"


def test_parameters_that_were_taken_from_the_noise():
    """Of what a run reports, whatever made it."""
    obj = noisy_monkey()
    surface = mesh_bridge.read_surface(obj)
    core = denoise(surface, PRESETS["TRI_2"].settings.with_changes(lambda_=0.31, mu=2.0)).report
    report = last_report()
    texts = []
    for noise in (None, estimate_noise(surface)):
        fill_report(report, {"Monkey": MeasuredReport(replace(core, noise=noise), 0.1, 0.2, 0.3)})
        texts.append((report.has_noise, report.parameters))
    assert texts == [(False, ""), (True, "λ 0.31, μ 2")]
    other = replace(core, noise=estimate_noise(surface), settings=core.settings.with_changes(mu=3.0))
    both = [MeasuredReport(replace(core, noise=other.noise), 0, 0, 0), MeasuredReport(other, 0, 0, 0)]
    fill_report(report, dict(zip("AB", both, strict=True)))
    assert report.parameters == "Different for each"


def test_a_clean_mesh_is_called_so(capfd):
    bpy.ops.mesh.primitive_cube_add()
    bpy.ops.object.framelet_denoise()
    assert re.search(r" in [\d.]+ s; clean already$", capfd.readouterr().out, re.MULTILINE)
    assert last_report().n_moved == 0
    assert last_report().is_clean and last_report().clean == 100


def test_strength_zero_is_not_called_clean(capfd):
    for make in (noisy_monkey, bpy.ops.mesh.primitive_cube_add):
        make()
        bpy.ops.object.framelet_denoise(strength=0.0)
        assert re.search(r" in [\d.]+ s; Strength is 0$", capfd.readouterr().out, re.MULTILINE)
        report = last_report()
        assert report.is_off and not report.is_clean and report.n_moved == 0


def test_the_choice_of_noise_reaches_the_engine(make_object, rng):
    surface = meshes.noisy(meshes.triangle_torus(), rng)
    results = []
    for noise in ("AUTO", "FINE", "WIDE"):
        obj = make_object(surface)
        settings = PRESETS["AUTO"].settings.with_changes(noise=noise, passes=1)
        expected = denoise(mesh_bridge.read_surface(obj), settings).vertices
        bpy.ops.object.framelet_denoise(noise=noise, passes=1)
        assert read(obj).tobytes() == expected.tobytes()
        assert last_report().iterations == 1
        results.append(expected.tobytes())
    assert len(set(results)) == 2  # of a part this small the noise counts as fine


def test_a_mesh_far_from_its_origin_is_told(capfd):
    obj = noisy_monkey()
    mesh_bridge.show_positions(obj.data, read(obj) + np.float32(2e5))
    capfd.readouterr()
    edge = mean_edge_length(mesh_bridge.read_surface(obj))
    assert bpy.ops.object.framelet_denoise(preset="TRI_2", lambda_=0) == {"FINISHED"}
    words = capfd.readouterr()
    found = re.search(r"positions come in steps of (\S+) edge lengths", words.out + words.err)
    assert float(found[1]) == pytest.approx(2**-6 / edge, rel=0.05)


@pytest.mark.parametrize(
    ("prepare", "words"),
    [
        (lambda obj: setattr(obj, "scale", (1.0, 1.0, 3.0)), "scaled unevenly: apply its scale"),
        (lambda obj: obj.modifiers.new("Subdivision", "SUBSURF"), "the cage was denoised"),
        (lambda obj: setattr(obj, "scale", (3.0, 3.0, -3.0)), None),
    ],
)
def test_the_sentence_names_the_way_out(prepare, words, capfd):
    prepare(noisy_monkey())
    bpy.context.view_layer.update()
    bpy.ops.object.framelet_denoise(preset="TRI_2")
    out = capfd.readouterr().out
    assert ("unevenly" in out or "cage" in out) == (words is not None)
    assert words is None or words in out
