# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Estimate Noise measures what core measures, in scene units, and changes nothing."""

import re

import bpy
import numpy as np
import pytest
from framelet.core import PRESETS, add_noise, denoise, estimate_noise
from framelet.core.noise.estimate import estimate_noise as estimate_where
from framelet.operators.estimate_noise import estimate_object_noise
from framelet.operators.mesh_io import mesh_bridge
from framelet.operators.outliers import select_vertices
from framelet.operators.properties.scene_units import length_in_scene


@pytest.fixture
def make_noisy(empty_scene):
    """Give a function that makes a noisy sphere."""

    def make(name="Ball", sigma=0.1):
        bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=4)
        obj = bpy.context.object
        obj.name = name
        surface = mesh_bridge.read_surface(obj)
        mesh_bridge.write_vertices(obj, surface, add_noise(surface, sigma, 1))
        return obj

    return make


def select_only(*objects):
    bpy.ops.object.select_all(action="DESELECT")
    for obj in objects:
        obj.select_set(True)
    bpy.context.view_layer.objects.active = objects[0]


def measured():
    return bpy.context.window_manager.framelet_estimate.objects


def test_the_estimate_is_that_of_core_and_nothing_changes(make_noisy):
    obj = make_noisy()
    surface = mesh_bridge.read_surface(obj)
    expected = estimate_noise(surface)
    assert estimate_object_noise(obj).noise == expected
    assert bpy.ops.object.framelet_estimate_noise() == {"FINISHED"}
    entry = measured()["Ball"]
    assert entry.sigma == pytest.approx(expected.sigma) and expected.sigma > 0
    assert entry.sigma_edges == pytest.approx(expected.sigma_edges)
    assert entry.is_impulsive == expected.is_impulsive
    assert not entry.is_denoised and not entry.has_belief
    assert mesh_bridge.read_surface(obj).vertices.tobytes() == surface.vertices.tobytes()


def test_impulsive_noise_is_called_so(make_noisy, rng, capfd):
    obj = make_noisy(sigma=0.0)
    surface = mesh_bridge.read_surface(obj)
    is_hit = rng.random((surface.n_vertices, 1)) < 0.25
    vertices = np.where(is_hit, add_noise(surface, 0.5, 1), surface.vertices)
    mesh_bridge.write_vertices(obj, surface, vertices)
    expected = estimate_noise(mesh_bridge.read_surface(obj))
    assert expected.is_impulsive
    bpy.ops.object.framelet_estimate_noise()
    assert measured()["Ball"].is_impulsive
    assert "edge lengths, impulsive)" in capfd.readouterr().out


@pytest.mark.parametrize("scale", [(10, 10, 10), (-2, 2, 2), (1, 2, 5)])
def test_the_scale_of_the_object_counts_in_lengths_only(make_noisy, scale):
    obj = make_noisy()
    expected = estimate_noise(mesh_bridge.read_surface(obj))
    obj.scale = scale
    obj.rotation_euler = (0.3, 0.2, 1.0)
    bpy.context.view_layer.update()
    bpy.ops.object.framelet_estimate_noise()
    factor = np.sqrt(np.mean(np.square(scale)))
    assert length_in_scene(obj, 1.0) == pytest.approx(factor, rel=1e-6)
    assert measured()["Ball"].sigma == pytest.approx(factor * expected.sigma, rel=1e-5)
    assert measured()["Ball"].sigma_edges == pytest.approx(expected.sigma_edges)


def test_the_sentence_has_scene_units_and_edge_lengths(make_noisy, capfd):
    make_noisy()
    bpy.ops.object.framelet_estimate_noise()
    pattern = r"Info: Noise of ‘Ball’: [\d.]+ [cm]m \(0\.\d{3} edge lengths\)\n"
    assert re.search(pattern, capfd.readouterr().out)


def test_several_objects(make_noisy, capfd):
    objects = [make_noisy("Rough", 0.3), make_noisy("Even", 0.05), make_noisy("Middle", 0.1)]
    select_only(*objects)
    bpy.ops.object.framelet_estimate_noise()
    assert sorted(measured().keys()) == ["Even", "Middle", "Rough"]
    assert measured()["Even"].sigma < measured()["Middle"].sigma < measured()["Rough"].sigma
    output = capfd.readouterr().out
    assert re.search(r"Noise of 3 objects: from .* of ‘Even’ to .* of ‘Rough’\n", output)
    select_only(objects[1])
    bpy.ops.object.framelet_estimate_noise()
    assert measured().keys() == ["Even"]


@pytest.fixture
def uneven(make_noisy):
    """A ball that is noisy in its upper half only, and which vertices these are."""
    obj = make_noisy(sigma=0.0)
    surface = mesh_bridge.read_surface(obj)
    upper = surface.vertices[:, 2] > 0.0
    vertices = np.where(upper[:, None], add_noise(surface, 0.2, 1), surface.vertices)
    mesh_bridge.write_vertices(obj, surface, vertices)
    return obj, upper


def limit(obj, upper, by):
    """Let only some vertices move, each time in another way."""
    if by == "SELECTION":
        bpy.ops.object.mode_set(mode="EDIT")
        select_vertices(obj, upper)
    elif by == "MASK":
        mask = obj.data.attributes.new(".sculpt_mask", "FLOAT", "POINT")
        mask.data.foreach_set("value", (~upper).astype(np.float32))
    elif by == "HIDDEN":
        mesh = obj.data
        for polygon in mesh.polygons:
            polygon.hide = not upper[list(polygon.vertices)].any()
        for vertex, moves in zip(mesh.vertices, upper, strict=True):
            vertex.hide = not moves
    else:
        obj.vertex_groups.new(name="Upper").add(np.flatnonzero(upper).tolist(), 1.0, "REPLACE")
        bpy.context.scene.framelet.vertex_group = "Upper"


@pytest.mark.parametrize("by", ["SELECTION", "GROUP", "MASK", "HIDDEN"])
def test_it_is_measured_where_vertices_may_move(uneven, by, capfd):
    obj, upper = uneven
    surface = mesh_bridge.read_surface(obj)
    expected = estimate_where(surface, where=upper)
    assert expected.sigma > 1.5 * estimate_noise(surface).sigma
    bpy.ops.object.framelet_estimate_noise()
    assert measured()["Ball"].sigma == pytest.approx(estimate_noise(surface).sigma)
    assert "Noise of ‘Ball’: " in capfd.readouterr().out
    limit(obj, upper, by)
    bpy.ops.object.framelet_estimate_noise()
    assert measured()["Ball"].sigma == pytest.approx(expected.sigma, rel=0.1 if by == "HIDDEN" else 1e-6)
    assert "Noise of what may move of ‘Ball’: " in capfd.readouterr().out


def test_without_a_selection_there_is_nothing_to_measure(make_noisy):
    make_noisy()
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="DESELECT")
    with pytest.raises(
        RuntimeError, match="‘Ball’ has no selected vertices; select what should be denoised or m"
    ):
        bpy.ops.object.framelet_estimate_noise()
    bpy.ops.mesh.select_all(action="SELECT")
    assert bpy.ops.object.framelet_estimate_noise() == {"FINISHED"}


def test_bad_meshes_get_a_sentence_beside_good_ones(make_noisy, capfd):
    good = make_noisy()
    mesh = bpy.data.meshes.new("Empty")
    bad = bpy.data.objects.new("Empty", mesh)
    bpy.context.collection.objects.link(bad)
    select_only(bad)
    with pytest.raises(RuntimeError, match="‘Empty’"):
        bpy.ops.object.framelet_estimate_noise()
    assert len(measured()) == 0
    select_only(bad, good)
    assert bpy.ops.object.framelet_estimate_noise() == {"FINISHED"}
    assert measured().keys() == ["Ball"]
    assert "Warning: ‘Empty’" in capfd.readouterr().out


def test_other_objects_are_refused(empty_scene):
    bpy.ops.object.light_add()
    light = bpy.context.object
    with pytest.raises(ValueError, match=f"‘{light.name}’ is not a mesh"):
        estimate_object_noise(light)
    assert not bpy.ops.object.framelet_estimate_noise.poll()


def test_denoising_fills_the_estimate(make_noisy):
    obj = make_noisy()
    core = denoise(mesh_bridge.read_surface(obj)).report
    other = make_noisy("Other")
    select_only(other)
    bpy.ops.object.framelet_estimate_noise()
    select_only(obj)
    bpy.ops.object.framelet_denoise()
    assert measured().keys() == ["Ball"]
    entry = measured()["Ball"]
    assert entry.sigma == pytest.approx(core.noise.sigma)
    assert entry.is_denoised and entry.has_belief
    assert entry.sigma_low == pytest.approx(core.noise.sigma_low)
    assert entry.sigma_high == pytest.approx(core.noise.sigma_high)
    assert (entry.chosen_lambda, entry.chosen_mu) == ("", "")


def test_denoising_by_the_noise_keeps_what_was_taken_from_it(make_noisy):
    obj = make_noisy()
    settings = PRESETS["TRI_2"].settings.with_changes(tuning="NOISE")
    used = denoise(mesh_bridge.read_surface(obj), settings).report.settings
    bpy.ops.object.framelet_denoise(preset="TRI_2", tuning="NOISE")
    entry = measured()["Ball"]
    assert entry.is_denoised and not entry.has_belief
    assert (entry.chosen_lambda, entry.chosen_mu) == (f"{used.lambda_:.3g}", f"{used.mu:.3g}")


@pytest.mark.parametrize(
    ("name", "options"),
    [
        ("denoise", {"preset": "TRI_2"}),
        ("add_noise", {}),
        ("equalize", {}),
        ("synthesize", {}),
    ],
)
def test_what_changes_a_mesh_forgets_its_noise(make_noisy, name, options):
    obj, other = make_noisy(), make_noisy("Other")
    select_only(obj, other)
    bpy.ops.object.framelet_estimate_noise()
    select_only(obj)
    if name == "synthesize":
        bpy.ops.object.framelet_analyze()
    getattr(bpy.ops.object, f"framelet_{name}")(**options)
    assert measured().keys() == ["Other"]
