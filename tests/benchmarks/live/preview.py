# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How soon the live preview of *Automatic* shows something: from a value to the mesh.

Run it with Blender's Python: `preview.py --update` also writes the table of `docs/science/benchmarks.md`.
That has the time of all processors together, which says the same on a busy computer; the clock is printed.
"""

import argparse
import re
import sys
import time

import bpy
from run import PAGE, make_object

SIZES = (10_000, 50_000)
TABLE = re.compile(r"(<!-- begin preview -->\n).*?(<!-- end preview -->)", re.DOTALL)


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
    lines = [
        "| Seconds of all processors | "
        + " | ".join(f"{each['Vertices']:,} vertices" for each in results)
        + " |",
        "| --- |" + " --: |" * len(results),
    ]
    for name in list(results[0])[1:]:
        texts = [f"{each[name][1]:.2f}" for each in results]
        lines.append(f"| {name} | " + " | ".join(texts) + " |")
    return "\n".join(lines) + "\n"


def main():
    """Measure, print the table, and write it to the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--sizes", type=int, nargs="+", default=SIZES)
    parser.add_argument("--update", action="store_true")
    options = parser.parse_args()
    import loading  # noqa: F401  # makes the checkout the package

    # isort: split
    import framelet

    framelet.register()
    try:
        results = [measure(size) for size in options.sizes]
    finally:
        framelet.unregister()
    found = table(results)
    print(found)
    for each in results:
        print(", ".join(f"{name}: {pair[0]:.2f} s by the clock" for name, pair in list(each.items())[1:]))
    if options.update:
        page = PAGE.read_text(encoding="utf-8")
        PAGE.write_text(TABLE.sub(lambda match: match[1] + found + match[2], page), encoding="utf-8")


if __name__ == "__main__":
    sys.exit(main())
