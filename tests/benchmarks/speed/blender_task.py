# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""One measurement inside Blender, as JSON: `blender_task.py MESH SETTINGS`; MESH may be `monkey:5`."""

import json
import os
import sys

import bpy
import loading  # noqa: F401
import numpy as np
from core_task import changed_a_little, settings_of, warm_up
from framelet.operators.mesh_io import mesh_bridge
from framelet.operators.run import denoise_object as operator_module
from framelet.operators.run.preparations import preparations
from shapes import read_mesh
from stopwatch import Stopwatch, begin_peak, peak_bytes


def torus_object(path):
    """Return an object with the mesh of a file."""
    surface = read_mesh(path)
    mesh = bpy.data.meshes.new("Torus")
    mesh.vertices.add(surface.n_vertices)
    mesh.attributes["position"].data.foreach_set("vector", surface.vertices.ravel())
    mesh.loops.add(surface.n_corners)
    mesh.polygons.add(surface.n_faces)
    mesh.loops.foreach_set("vertex_index", surface.corner_vertex)
    mesh.polygons.foreach_set("loop_start", surface.face_offset[:-1])
    mesh.update(calc_edges=True)
    return linked(mesh)


def monkey_object(levels):
    """Return Blender's monkey, subdivided and cut into triangles, with noise."""
    bpy.ops.mesh.primitive_monkey_add()
    obj = bpy.context.object
    for kind in ("SUBSURF", "TRIANGULATE"):
        modifier = obj.modifiers.new(kind, kind)
        if kind == "SUBSURF":
            modifier.levels = levels
    mesh = bpy.data.meshes.new_from_object(obj.evaluated_get(bpy.context.evaluated_depsgraph_get()))
    bpy.data.objects.remove(obj)
    obj = linked(mesh)
    from framelet.core import add_noise

    surface = mesh_bridge.read_surface(obj)
    mesh_bridge.write_vertices(obj, surface, add_noise(surface, 0.2, 0))
    return obj


def linked(mesh):
    """Return a new object with a mesh, in the scene."""
    obj = bpy.data.objects.new(mesh.name, mesh)
    bpy.context.collection.objects.link(obj)
    return obj


def main():
    """Measure and print."""
    source, options = sys.argv[1], json.loads(sys.argv[2])
    settings = settings_of(options)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    name, _, levels = source.partition(":")
    obj = monkey_object(int(levels)) if name == "monkey" else torus_object(source)
    warm_up(settings)
    noisy = mesh_bridge.read_surface(obj)
    before = begin_peak()
    watch = Stopwatch()
    watch.wrap(operator_module, "read_job", "read")
    watch.wrap(mesh_bridge, "write_vertices", "write")
    watch.run("all", lambda: operator_module.denoise_object(obj, settings))
    found = {"stages": dict(watch.seconds), "peak": peak_bytes() - before}
    # A value is dragged: the mesh is put back, as undo does, and the next run comes.
    mesh_bridge.write_vertices(obj, mesh_bridge.read_surface(obj), noisy.vertices)
    again = changed_a_little(settings)
    watch.run("rerun", lambda: operator_module.denoise_object(obj, again))
    found["stages"]["rerun"] = watch.seconds["rerun"]
    found |= {"n_vertices": noisy.n_vertices, "n_faces": noisy.n_faces, "kept": len(preparations())}
    found["moved"] = int(np.any(mesh_bridge.read_surface(obj).vertices != noisy.vertices, axis=1).sum())
    sys.stdout.write("\n" + json.dumps(found) + "\n")
    sys.stdout.flush()
    os._exit(0)  # nothing is registered, and Blender need not take the mesh apart


if __name__ == "__main__":
    main()
