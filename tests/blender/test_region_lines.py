# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Sharp and creased edges of an object are lines that stay sharp."""

import bpy
import numpy as np
import pytest

# isort: split
# This module exists once bpy was imported.
import bmesh
from blender_objects import edit, read
from checks import lengths
from framelet.core import PRESETS, Region, SurfaceMesh, denoise
from framelet.operators.mesh_io import mesh_bridge
from framelet.operators.mesh_io.region_bridge import read_region
from framelet.operators.properties.region_options import RegionOptions
from meshes import noisy
from region_cases import box


@pytest.fixture
def cube(make_object, rng):
    """A noisy cube and its sharp edges, by the numbers of vertices."""
    mesh, edges = box(6)
    obj = make_object(noisy(mesh, rng, 0.08))
    return obj, {tuple(sorted(edge)) for edge in edges.tolist()}


def mark(obj, edges, how):
    """Mark edges in Object Mode, by Blender's own attributes."""
    mesh = obj.data
    chosen = [tuple(sorted(edge.vertices)) in edges for edge in mesh.edges]
    if how == "sharp":
        mesh.attributes.new("sharp_edge", "BOOLEAN", "EDGE").data.foreach_set("value", chosen)
    elif how == "crease":
        values = [0.3 if is_chosen else 0.0 for is_chosen in chosen]
        mesh.attributes.new("crease_edge", "FLOAT", "EDGE").data.foreach_set("value", values)
    else:
        for edge, is_chosen in zip(mesh.edges, chosen, strict=True):
            edge.use_seam = is_chosen


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
@pytest.mark.parametrize("how", ["sharp", "crease", "seam"])
def test_sharp_and_creased_edges_are_lines_and_seams_are_not(how, mode, cube):
    obj, edges = cube
    mark(obj, edges, how)
    if mode == "EDIT":
        edit(obj)
    found = read_region(obj, RegionOptions(keep_sharp=True)).region.feature_edges
    assert {tuple(sorted(edge)) for edge in found.tolist()} == (set() if how == "seam" else edges)
    assert read_region(obj, RegionOptions()).region.feature_edges is None


def test_edges_marked_in_edit_mode(cube):
    obj, edges = cube
    edit(obj)
    edit_mesh = bmesh.from_edit_mesh(obj.data)
    layer = edit_mesh.edges.layers.float.new("crease_edge")
    expected = set()
    for number, edge in enumerate(edit_mesh.edges):
        ends = tuple(sorted(vert.index for vert in edge.verts))
        if ends in edges:
            expected.add(ends)
            if number % 2:
                edge.smooth = False
            else:
                edge[layer] = 1.0
    bmesh.update_edit_mesh(obj.data)
    found = read_region(obj, RegionOptions(keep_sharp=True)).region.feature_edges
    assert {tuple(sorted(edge)) for edge in found.tolist()} == expected == edges
    bpy.ops.object.mode_set(mode="OBJECT")
    found = read_region(obj, RegionOptions(keep_sharp=True)).region.feature_edges
    assert {tuple(sorted(edge)) for edge in found.tolist()} == edges


def test_sharp_edges_stay_sharp(cube):
    obj, edges = cube
    mark(obj, edges, "sharp")
    surface = mesh_bridge.read_surface(obj)
    region = Region(feature_edges=np.array(sorted(edges)))
    expected = denoise(surface, PRESETS["TRI_2"].settings, region=region)
    assert bpy.ops.object.framelet_denoise(preset="TRI_2", keep_sharp=True) == {"FINISHED"}
    assert lengths(read(obj) - expected.vertices).max() < 1e-6
    report = bpy.context.window_manager.framelet_report
    assert report.line_vertices == expected.report.line_vertices == len(set().union(*edges))


def test_nothing_of_a_mesh_is_read_twice_or_left_behind(cube):
    obj, edges = cube
    mark(obj, edges, "sharp")
    edit(obj)
    names = {mesh.name for mesh in bpy.data.meshes}
    found = read_region(obj, RegionOptions(keep_sharp=True))
    assert isinstance(found.surface, SurfaceMesh)
    assert {mesh.name for mesh in bpy.data.meshes} == names
