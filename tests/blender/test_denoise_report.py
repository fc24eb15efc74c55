# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The report of a run counts in scene units and in edge lengths, for one object and for several."""

import re
from dataclasses import replace

import bpy
import numpy as np
import pytest
from blender_objects import noisy_monkey, read, select_only
from framelet.core import PRESETS, denoise, estimate_noise
from framelet.operators import mesh_bridge
from framelet.operators.denoise_job import MeasuredReport
from framelet.operators.filled_reports import fill_report


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
    assert not report.is_closed


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


def test_noise_and_recipe_of_the_default():
    obj = noisy_monkey()
    core = denoise(mesh_bridge.read_surface(obj)).report
    obj.scale = (10, 10, -10)
    bpy.context.view_layer.update()
    bpy.ops.object.framelet_denoise()
    report = last_report()
    assert report.has_noise and report.recipe == core.recipe != ""
    assert report.noise_sigma == pytest.approx(10 * core.noise.sigma) and core.noise.sigma > 0
    assert report.noise_sigma_edges == pytest.approx(core.noise.sigma_edges)
    assert report.is_impulsive == core.noise.is_impulsive
    assert report.parameters == ""


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
    assert report.recipe == "; ".join(dict.fromkeys(report.recipe for report in reports))


def test_a_run_without_noise_shows_none_of_an_earlier_one():
    obj = noisy_monkey()
    bpy.ops.object.framelet_denoise()
    assert last_report().has_noise
    bpy.ops.object.framelet_denoise(preset="TRI_2")
    report = last_report()
    assert not report.has_noise and not report.is_impulsive
    assert (report.noise_sigma, report.noise_sigma_edges, report.recipe) == (0, 0, "")
    assert obj.name not in bpy.context.window_manager.framelet_estimate.objects


def test_the_sentence_names_noise_and_recipe(capfd):
    noisy_monkey()
    bpy.ops.object.framelet_denoise()
    recipe = last_report().recipe
    assert re.search(
        rf"; noise [\d.]+ c?m \(\d\.\d{{3}} edge lengths(, impulsive)?\); used {re.escape(recipe)}\n",
        capfd.readouterr().out,
    )
    bpy.ops.object.framelet_denoise(preset="TRI_2")
    assert "; noise" not in capfd.readouterr().out


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
    assert "0 of 8 vertices moved" in (out := capfd.readouterr().out)
    assert re.search(r"; noise 0 m \(0\.000 edge lengths\); clean already$", out, re.MULTILINE)
