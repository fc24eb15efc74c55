# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a result is other than expected a short line names the way out, and that way works."""

from pathlib import Path

import bpy
import meshes
import numpy as np
import pytest
from drawing import draw
from framelet.core import SurfaceMesh
from framelet.core.noise import TERRACES, VOXELS, find_steps
from framelet.operators.mesh_io.mesh_bridge import read_positions, read_surface
from framelet.ui.panels import report_panels
from framelet.ui.panels.layouts import draw_text
from known_shapes import lifted, wide

SIDE = 24
CASES = Path(__file__).resolve().parents[3] / "shared" / "cases"


def voxel_ball(side=SIDE, up=2):
    """Return the faces between the voxels inside a ball and those outside, as quads."""
    places = np.stack(np.mgrid[:side, :side, :side], axis=-1) - side / 2 + 0.5
    inside = (places**2).sum(axis=-1) < (0.42 * side) ** 2
    points, quads = {}, []
    for axis in range(3):
        one, two = (axis + 1) % 3, (axis + 2) % 3
        for is_upper in (False, True):
            beyond = np.roll(inside, -1 if is_upper else 1, axis)
            for place in np.argwhere(inside & ~beyond):
                place[axis] += is_upper
                corners = np.tile(place, (4, 1))
                corners[1:3, one] += 1
                corners[2:, two] += 1
                ring = [points.setdefault(tuple(each), len(points)) for each in corners.tolist()]
                quads.append(ring if is_upper else ring[::-1])
    return SurfaceMesh.from_faces(np.array(list(points), float) - side / 2, np.array(quads))


def ground(axis=2, step=1.0, side=60):
    """Return a hilly ground whose heights are rounded, with `axis` up."""
    surface = meshes.triangle_grid(side, side)
    rows, columns = np.mgrid[:side, :side].astype(float)
    heights = 4.0 * np.sin(rows / 9.0) * np.cos(columns / 11.0)
    points = np.stack((rows, columns, step * np.round(heights / step)), axis=-1).reshape(-1, 3)
    return surface.with_vertices(np.roll(points, axis - 2, axis=1))


def boxes(cuts):
    bpy.ops.mesh.primitive_cube_add()
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.subdivide(number_cuts=cuts)
    bpy.ops.object.mode_set(mode="OBJECT")
    return read_surface(bpy.context.object)


def labels():
    return draw(report_panels.VIEW3D_PT_framelet_last_run)["label"]


@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize("step", [1.0, 0.37])
def test_terraces_are_seen_along_any_axis(axis, step):
    assert find_steps(ground(axis, step)) == TERRACES


def test_voxels_are_seen():
    assert find_steps(voxel_ball()) == VOXELS


def test_nothing_is_said_of_other_shapes(empty_scene, rng):
    smooth = ground()
    rows, columns = np.mgrid[:60, :60].astype(float)
    points = smooth.vertices.copy()
    points[:, 2] = (4.0 * np.sin(rows / 9.0) * np.cos(columns / 11.0)).ravel()
    assert find_steps(smooth.with_vertices(points)) == ""
    assert find_steps(meshes.noisy(ground(), rng, 0.05)) == ""
    assert find_steps(meshes.triangle_grid(30, 30)) == ""  # a plane
    assert find_steps(meshes.triangle_torus(40, 40)) == ""
    assert find_steps(boxes(20)) == ""
    assert find_steps(meshes.tetrahedron()) == ""
    bpy.ops.mesh.primitive_cone_add(vertices=64)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.subdivide(number_cuts=9)
    bpy.ops.object.mode_set(mode="OBJECT")
    assert find_steps(read_surface(bpy.context.object)) == ""
    bpy.ops.mesh.primitive_cylinder_add(vertices=64)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.subdivide(number_cuts=5)
    bpy.ops.object.mode_set(mode="OBJECT")
    assert find_steps(read_surface(bpy.context.object)) == ""


def test_the_preset_for_voxels_rounds_them(make_object, capfd):
    obj = make_object(voxel_ball(), "Ball")

    def unevenness():
        return np.linalg.norm(read_positions(obj.data), axis=1).std()

    before = unevenness()
    bpy.ops.object.framelet_denoise()
    assert unevenness() > 0.5 * before
    words = "it is made of voxels: the preset Marching Cubes / CT rounds the steps"
    assert words in capfd.readouterr().out
    assert " ".join(labels()).startswith("It is made of voxels: the preset")
    bpy.ops.object.framelet_denoise(preset="MARCHING_CUBES", from_original=True)
    assert unevenness() < 0.2 * before
    assert words not in capfd.readouterr().out and not any("voxels" in label for label in labels())


def test_the_preset_for_terraces_takes_them_away(make_object, capfd):
    obj = make_object(ground(step=3.0), "Ground")  # twice the length of an edge: these may be meant
    flat = read_positions(obj.data)
    bpy.ops.object.framelet_denoise()
    assert "its heights are in whole steps: the preset Paper Tri-2" in capfd.readouterr().out
    assert "whole steps" in " ".join(labels())
    bpy.ops.object.framelet_denoise(preset="TRI_2")
    assert np.abs(read_positions(obj.data) - flat).max() > 0.1
    assert "whole steps" not in capfd.readouterr().out


def test_noise_that_looks_like_relief_is_named(make_object, capfd, rng):
    clean = meshes.quad_torus(40, 60)
    make_object(lifted(clean, 0.3 * wide(clean, rng, 12)), "Wavy")
    words = "if what is left is noise, it is several edges wide: set Noise to Wide"
    bpy.ops.object.framelet_denoise()
    assert f"clean already; {words}" in capfd.readouterr().out
    assert words[1:] in " ".join(labels())
    bpy.ops.object.framelet_denoise(noise="WIDE", from_original=True)
    assert words not in capfd.readouterr().out and bpy.context.window_manager.framelet_report.n_moved


def test_a_scale_and_a_cage_are_in_last_run_too(make_object, rng):
    obj = make_object(meshes.noisy(meshes.triangle_torus(), rng), "Torus")
    obj.scale = (1.0, 1.0, 3.0)
    obj.modifiers.new("Subdivision", "SUBSURF")
    bpy.context.view_layer.update()
    bpy.ops.object.framelet_denoise(preset="TRI_2")
    lines = " ".join(labels())
    assert "The object is scaled unevenly: apply its scale (Ctrl A)" in lines
    assert "The cage was denoised" in lines


def test_last_run_does_not_go_on_about_what_is_gone(make_object, rng):
    obj = make_object(meshes.noisy(meshes.triangle_torus(), rng), "Torus")
    bpy.ops.object.framelet_denoise(preset="TRI_2")
    assert "Volume" in labels()
    bpy.data.objects.remove(obj)
    assert labels() == ["The object is gone"]


def test_a_large_change_of_volume_stands_out(make_object, rng):
    make_object(meshes.noisy(meshes.triangle_torus(), rng), "Torus")
    bpy.ops.object.framelet_denoise(preset="TRI_2")
    report = bpy.context.window_manager.framelet_report
    alerts = []
    for change in (-19.5, 4.0):
        report.volume_change = change
        record = draw(report_panels.VIEW3D_PT_framelet_last_run)
        alerts.append(record["alert"])
    assert alerts == [["Volume", "-19.50%"], []]


def test_sentences_are_broken_into_lines_of_the_sidebar():
    text = "the object is scaled unevenly: apply its scale (Ctrl A) and denoise again"
    record = draw(lambda drawn, context: draw_text(drawn.layout, context, text))
    assert " ".join(record["label"]).lower() == text.lower() and len(record["label"]) > 1
    assert max(map(len, record["label"])) < 40
    assert [icon for _, icon in record["icon"]] == ["INFO"] + ["BLANK1"] * (len(record["label"]) - 1)


@pytest.mark.skipif(not CASES.is_dir(), reason="needs the development cases beside the checkout")
def test_the_case_of_the_terraces(empty_scene):
    bpy.ops.wm.ply_import(filepath=str(CASES / "terraces.ply"))
    assert find_steps(read_surface(bpy.context.object)) == TERRACES
