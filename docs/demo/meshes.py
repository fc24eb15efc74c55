# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""The meshes of the demo: made by Blender, written as PLY files."""

from pathlib import Path

import bpy
import numpy as np

SUBDIVISIONS = 3
"""Levels of the subdivision surface: 31,658 vertices and 62,976 triangles."""


def make_monkey(name: str) -> bpy.types.Object:
    """Make Blender's monkey as a smooth triangle mesh: head and eyes are three parts with open borders."""
    bpy.ops.mesh.primitive_monkey_add()
    source = bpy.context.object
    source.modifiers.new("Subdivision", "SUBSURF").levels = SUBDIVISIONS
    source.modifiers.new("Triangulate", "TRIANGULATE").quad_method = "BEAUTY"
    mesh = bpy.data.meshes.new_from_object(source.evaluated_get(bpy.context.evaluated_depsgraph_get()))
    bpy.data.objects.remove(source)
    return _linked_object(name, mesh)


def copy_object(obj: bpy.types.Object, name: str) -> bpy.types.Object:
    """Return an object with a copy of a mesh."""
    return _linked_object(name, obj.data.copy())


def copy_with_vertices(obj: bpy.types.Object, name: str, vertices: np.ndarray) -> bpy.types.Object:
    """Return an object with a copy of a mesh and other positions, shape (N, 3)."""
    mesh = obj.data.copy()
    mesh.attributes["position"].data.foreach_set("vector", np.asarray(vertices, np.float32).reshape(-1))
    mesh.update()
    return _linked_object(name, mesh)


def write_ply(obj: bpy.types.Object, path: Path) -> None:
    """Write the mesh of an object, positions and faces only."""
    for other in bpy.context.scene.objects:
        other.select_set(other == obj)
    # Blender 5.2 leaves out what is hidden in renders, without a word.
    hidden, obj.hide_render = obj.hide_render, False
    bpy.ops.wm.ply_export(
        filepath=str(path),
        export_selected_objects=True,
        apply_modifiers=False,
        export_normals=False,
        export_uv=False,
        export_colors="NONE",
        forward_axis="Y",
        up_axis="Z",
    )
    obj.hide_render = hidden


def _linked_object(name: str, mesh: bpy.types.Mesh) -> bpy.types.Object:
    """Make an object and put it into the scene, away from the camera's view until it is its turn."""
    mesh.name = name
    obj = bpy.data.objects.new(name, mesh)
    obj.hide_render = True
    bpy.context.scene.collection.objects.link(obj)
    return obj
