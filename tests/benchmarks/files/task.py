# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Read a mesh file and write it again with one program, in a process of its own; prints what it took as JSON.

task.py PROGRAM FILE RESULT
"""

import importlib.util
import json
import os
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]


def with_framelet(source, target):
    """Return the seconds that Framelet takes to read, and to write all vertices elsewhere, safely."""
    spec = importlib.util.spec_from_file_location(
        "framelet", ROOT / "__init__.py", submodule_search_locations=[str(ROOT)]
    )
    package = importlib.util.module_from_spec(spec)
    sys.modules["framelet"] = package
    spec.loader.exec_module(package)
    from framelet.operators.files import open_file
    from framelet.operators.files.safe_write import Outputs

    yield
    file = open_file(source)
    yield len(file.positions)
    moved = file.positions + 0.01
    yield
    with Outputs() as outputs:
        outputs.write(target, file.patched(moved))
        outputs.publish()


def with_blender(source, target):
    """The same for Blender's importer and exporter."""
    import bpy

    bpy.ops.wm.read_factory_settings(use_empty=True)
    kind = source.suffix
    if kind == ".glb":
        reader, writer = bpy.ops.import_scene.gltf, bpy.ops.export_scene.gltf
    else:
        reader, writer = (getattr(bpy.ops.wm, f"{kind[1:]}_{what}") for what in ("import", "export"))
    yield
    reader(filepath=str(source))
    yield len(bpy.context.scene.objects[0].data.vertices)
    yield
    writer(filepath=str(target), **({"ascii_format": True} if "ascii" in source.stem else {}))


def with_trimesh(source, target):
    """The same for trimesh, which is told to change nothing."""
    import trimesh

    yield
    mesh = trimesh.load(source, force="mesh", process=False)
    yield len(mesh.vertices)
    mesh.vertices = mesh.vertices + 0.01
    yield
    mesh.export(
        target, **({"encoding": "ascii"} if "ascii" in source.stem and source.suffix == ".ply" else {})
    )


def memory(name):
    """Return a size of this process in megabytes; Linux only."""
    lines = Path("/proc/self/status").read_text().splitlines()
    return next(int(line.split()[1]) for line in lines if line.startswith(name)) / 1024


PROGRAMS = {"framelet": with_framelet, "blender": with_blender, "trimesh": with_trimesh}


def main():
    """Run one program on one file."""
    program, source, target = sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3])
    steps = PROGRAMS[program](source, target)
    next(steps)
    before = memory("VmRSS")
    Path("/proc/self/clear_refs").write_text("5")  # the peak counts from now on
    began = time.perf_counter()
    n_vertices = next(steps)
    read = time.perf_counter() - began
    next(steps)
    began = time.perf_counter()
    next(steps, None)
    write = time.perf_counter() - began
    found = {"vertices": n_vertices, "read": read, "write": write, "megabytes": memory("VmHWM") - before}
    print("\n" + json.dumps(found), flush=True)
    os._exit(0)  # Blender's module can take its time to end


if __name__ == "__main__":
    main()
