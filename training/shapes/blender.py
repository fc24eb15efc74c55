# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's modifiers and operators on our arrays."""

from __future__ import annotations

import os
import sys

import numpy as np

from .mesh import Mesh


def _import_bpy():
    """Import bpy without what its compiled parts print: they find no sound and a newer NumPy."""
    sys.stderr.flush()
    sys.stdout.flush()
    saved, nothing = [os.dup(1), os.dup(2)], os.open(os.devnull, os.O_WRONLY)
    os.dup2(nothing, 1)
    os.dup2(nothing, 2)
    try:
        import bpy
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        for target, copy in zip((1, 2), saved, strict=True):
            os.dup2(copy, target)
            os.close(copy)
        os.close(nothing)
    return bpy


bpy = _import_bpy()


def to_data(mesh: Mesh):
    """Make Blender's mesh of ours."""
    data = bpy.data.meshes.new("shape")
    data.vertices.add(len(mesh.vertices))
    data.vertices.foreach_set("co", mesh.vertices.astype(np.float32).ravel())
    data.loops.add(len(mesh.corner_vertex))
    data.loops.foreach_set("vertex_index", mesh.corner_vertex.astype(np.int32))
    data.polygons.add(mesh.n_faces)
    data.polygons.foreach_set("loop_start", mesh.face_offset[:-1].astype(np.int32))
    data.update(calc_edges=True)
    return data


def from_data(data) -> Mesh:
    """Read Blender's mesh."""
    points = np.empty(3 * len(data.vertices), np.float32)
    data.vertices.foreach_get("co", points)
    corner = np.empty(len(data.loops), np.int32)
    data.loops.foreach_get("vertex_index", corner)
    start = np.empty(len(data.polygons), np.int32)
    data.polygons.foreach_get("loop_start", start)
    return Mesh(points.reshape(-1, 3).astype(float), np.append(start, len(corner)).astype(np.int32), corner)


def with_modifiers(mesh: Mesh, *modifiers) -> Mesh:
    """Apply modifiers, each a pair of its type and its properties."""
    data = to_data(mesh)
    thing = bpy.data.objects.new("shape", data)
    bpy.context.scene.collection.objects.link(thing)
    try:
        for kind, properties in modifiers:
            modifier = thing.modifiers.new(kind, kind)
            for name, value in properties.items():
                setattr(modifier, name, value)
        evaluated = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
        result = from_data(evaluated.to_mesh())
        evaluated.to_mesh_clear()
    finally:
        bpy.data.objects.remove(thing)
        bpy.data.meshes.remove(data)
    return result


def with_bmesh(mesh: Mesh, operate) -> Mesh:
    """Let a function change a BMesh."""
    import bmesh

    data = to_data(mesh)
    work = bmesh.new()
    try:
        work.from_mesh(data)
        operate(bmesh, work)
        work.to_mesh(data)
        return from_data(data)
    finally:
        work.free()
        bpy.data.meshes.remove(data)


def quads_joined(mesh: Mesh, angle: float) -> Mesh:
    """Join pairs of triangles into quads where that bends no face by more than ``angle`` (radians)."""

    def operate(bmesh, work):
        bmesh.ops.join_triangles(
            work, faces=work.faces[:], angle_face_threshold=angle, angle_shape_threshold=1.2
        )

    return with_bmesh(mesh, operate)


def dissolved(mesh: Mesh, angle: float) -> Mesh:
    """Dissolve edges between faces that are flat to within ``angle`` (radians) into polygons."""

    def operate(bmesh, work):
        bmesh.ops.dissolve_limit(
            work, angle_limit=angle, use_dissolve_boundaries=False, verts=work.verts[:], edges=work.edges[:]
        )

    return with_bmesh(mesh, operate)


def quadriflow(mesh: Mesh, target: int) -> Mesh:
    """Remesh into a field-aligned quad mesh."""
    data = to_data(mesh)
    thing = bpy.data.objects.new("shape", data)
    bpy.context.scene.collection.objects.link(thing)
    bpy.context.view_layer.objects.active = thing
    try:
        bpy.ops.object.quadriflow_remesh(target_faces=target, seed=0)
        return from_data(thing.data)
    finally:
        data = thing.data
        bpy.data.objects.remove(thing)
        bpy.data.meshes.remove(data)
