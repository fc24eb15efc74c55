# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Milliseconds a change of Framelet's modifiers, beside Blender's own Smooth modifier.

Run it with Blender's Python: `run.py --update` also writes the table of `docs/science/benchmarks.md`.
"""

import sys
import time
from pathlib import Path

import bpy
import live_page
import numpy as np

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "benchmarks" / "speed"))
SIZES = (100_000, 1_000_000)
LEVELS = 3
ROUNDS = 15


def make_object(n_vertices):
    """Return an object with the noisy torus of the speed benchmark."""
    from shapes import make_torus

    vertices, faces = make_torus(n_vertices, is_shuffled=False)
    mesh = bpy.data.meshes.new("Torus")
    mesh.vertices.add(len(vertices))
    mesh.attributes["position"].data.foreach_set("vector", vertices.ravel())
    mesh.loops.add(faces.size)
    mesh.polygons.add(len(faces))
    mesh.loops.foreach_set("vertex_index", faces.ravel().astype(np.int32))
    mesh.polygons.foreach_set("loop_start", np.arange(0, faces.size, 3, dtype=np.int32))
    mesh.update(calc_edges=True)
    obj = bpy.data.objects.new("Torus", mesh)
    bpy.context.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)
    return obj


def milliseconds(change, rounds=ROUNDS):
    """Return the median time from a change to the evaluated mesh, in milliseconds."""
    found = []
    for number in range(rounds + 2):
        change(0.25 + 0.5 * (number % 2))
        began = time.perf_counter()
        bpy.context.view_layer.update()
        found.append(1000.0 * (time.perf_counter() - began))
    return float(np.median(found[2:]))  # the first ones make what is kept


def measure(n_vertices, rounds=ROUNDS):
    """Return what was measured on a mesh of about as many vertices, by name."""
    from framelet.operators.modifier.inputs import set_input
    from framelet.operators.modifier.recipes import DISPLACEMENT, EQUALIZER
    from framelet.operators.modifier.stack import find_modifier

    bpy.ops.wm.read_factory_settings(use_empty=True)
    obj = make_object(n_vertices)
    group = obj.vertex_groups.new(name="Half")
    group.add(list(range(0, len(obj.data.vertices), 2)), 0.5, "REPLACE")
    found = {"Vertices": len(obj.data.vertices)}
    bpy.ops.object.framelet_denoise(preset="TRI_2", output="MODIFIER")
    modifier = find_modifier(obj, DISPLACEMENT)
    found["Amount"] = milliseconds(lambda value: set_input(modifier, "Amount", value), rounds)
    set_input(modifier, "Mask", "Half")
    found["Amount, with a mask"] = milliseconds(lambda value: set_input(modifier, "Amount", value), rounds)
    bpy.ops.object.framelet_remove_modifier(kind=DISPLACEMENT)
    began = time.perf_counter()
    bpy.ops.object.framelet_live_equalizer(levels=LEVELS)
    found["Storing the levels, once"] = 1000.0 * (time.perf_counter() - began)
    equalizer = find_modifier(obj, EQUALIZER)
    found["Live Equalizer, a gain"] = milliseconds(
        lambda value: set_input(equalizer, "Level 1", value), rounds
    )
    bpy.ops.object.framelet_remove_modifier(kind=EQUALIZER)
    began = time.perf_counter()
    bpy.ops.object.framelet_equalize(levels=LEVELS, gain_1=0.5)
    found["Equalize, again"] = 1000.0 * (time.perf_counter() - began)
    smooth = obj.modifiers.new("Smooth", "SMOOTH")
    found["Smooth of Blender, a factor"] = milliseconds(
        lambda value: setattr(smooth, "factor", value), rounds
    )
    return found


def table(results):
    """Return the results as a table, a column for each mesh."""
    return live_page.table(
        "Milliseconds", results, lambda value: f"{value:,.0f}" if value >= 10 else f"{value:.1f}"
    )


if __name__ == "__main__":
    live_page.run(__doc__, SIZES, measure, table, "sliders")
