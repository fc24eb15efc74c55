# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How soon the live preview of *Automatic* shows something: from a value to the mesh.

Run it with Blender's Python: `preview.py --update` also writes the table of `docs/science/benchmarks.md`.
That has the time of all processors together, which says the same on a busy computer; the clock is printed.
"""

import time

import bpy
import live_page
from run import make_object

SIZES = (10_000, 50_000)


def seconds(session, positions, is_there):
    """Tick until something is there; return seconds of the clock and of all processors."""
    from framelet.operators.preview import current_preview

    wall, processor, before = time.perf_counter(), time.process_time(), positions()
    while True:
        current_preview.tick_preview()
        if is_there(session, positions() != before):
            return time.perf_counter() - wall, time.process_time() - processor
        time.sleep(0.1)


def has_picture(_session, is_other):
    """Return whether the mesh shows something new."""
    return is_other


def has_result(session, _is_other):
    """Return whether the mesh shows what was asked for."""
    return session.is_current


def measure(n_vertices):
    """Return what was measured on a mesh of about as many vertices, by name."""
    from framelet.operators.mesh_io.mesh_bridge import read_positions
    from framelet.operators.preview import current_preview
    from framelet.operators.run.preparations import forget_preparations

    bpy.ops.wm.read_factory_settings(use_empty=True)
    forget_preparations()
    obj = make_object(n_vertices)
    settings = bpy.context.scene.framelet

    def positions():
        return read_positions(obj.data).tobytes()

    found = {"Vertices": len(obj.data.vertices)}
    wall, processor, before = time.perf_counter(), time.process_time(), positions()
    bpy.ops.object.framelet_preview()
    session = current_preview.current_preview()
    while positions() == before:
        current_preview.tick_preview()
        time.sleep(0.1)
    found["Turned on: first picture"] = (time.perf_counter() - wall, time.process_time() - processor)
    more = seconds(session, positions, has_result)
    found["Turned on: result"] = tuple(map(sum, zip(found["Turned on: first picture"], more, strict=True)))
    session.wait(600)  # for the end of the slider
    current_preview.tick_preview()
    for name, value in (("Strength 0.6", 0.6), ("Strength 1.5", 1.5)):
        settings.strength = value
        first = seconds(session, positions, has_picture)
        more = seconds(session, positions, has_result)
        found[f"{name}: first picture"] = first
        found[f"{name}: result"] = tuple(map(sum, zip(first, more, strict=True)))
    current_preview.stop_preview()
    return found


def table(results):
    """Return the results as a table, a column for each mesh."""
    return live_page.table("Seconds of all processors", results, lambda pair: f"{pair[1]:.2f}")


if __name__ == "__main__":
    for each in live_page.run(__doc__, SIZES, measure, table, "preview"):
        print(", ".join(f"{name}: {pair[0]:.2f} s by the clock" for name, pair in list(each.items())[1:]))
