# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""One measurement of `framelet.core` in a process of its own: `core_task.py MESH.npz SETTINGS`, as JSON."""

import json
import sys

import loading  # noqa: F401
import numpy as np
from framelet.core import PRESETS, DenoiseSettings, PreparationCache, SurfaceMesh, denoise
from framelet.core import prepared as prepared_module
from framelet.core.memory import estimated_bytes
from framelet.core.methods import METHODS
from framelet.core.settings import used_settings
from shapes import read_mesh
from stopwatch import Stopwatch, begin_peak, peak_bytes, triad_seconds

BYTES_PER_ITERATION = 200
"""What an iteration of Tri-2 has to move for each vertex: indices, neighbors, residuals and positions."""

walk = sys.modules["framelet.core.denoise"]

STAGES = (
    (prepared_module, "check_surface", "check"),
    (prepared_module, "spatial_order", "reorder"),
    (prepared_module, "reorder", "reorder"),
    (prepared_module, "connect_agreeing", "connectivity"),
    (prepared_module, "normalize", "normalize"),
    (prepared_module, "make_transform", "stencils"),
    (prepared_module, "FaceEngine", "stencils"),
    (walk, "finish", "report"),
    (walk, "account", "report"),
)


def settings_of(options):
    """Return the settings of a preset with changes."""
    preset, changes = options["preset"], options.get("changes", {})
    return PRESETS[preset].settings.with_changes(**changes)


def changed_a_little(settings):
    """Return settings with one value changed that needs nothing prepared anew, as when it is dragged."""
    name = {"AUTO": "strength", "POSITIONS": "lambda_", "BILATERAL": "sigma_c"}[settings.method]
    return settings.with_changes(**{name: 1.1 * getattr(settings, name)})


def warm_up(settings):
    """Import and set up what the first run would pay for."""
    points = np.random.default_rng(0).normal(size=(4, 3))
    mesh = SurfaceMesh.from_faces(points, [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)])
    values = vars(settings) | {"frame": "BOX_SPLINE_111", "levels": 1}
    denoise(mesh, DenoiseSettings(**used_settings(values)))
    triad_seconds(12000)


def main():
    """Measure and print."""
    path, options = sys.argv[1], json.loads(sys.argv[2])
    settings = settings_of(options)
    warm_up(settings)
    mesh = read_mesh(path)
    before = begin_peak()
    watch = Stopwatch()
    for module, name, stage in STAGES:
        watch.wrap(module, name, stage)
    METHODS[settings.method] = watch.timed(METHODS[settings.method], "solve")
    cache = PreparationCache(max_bytes=2**40)
    result = watch.run("all", lambda: denoise(mesh, settings, prepared=cache))
    found = {"stages": dict(watch.seconds), "peak": peak_bytes() - before}
    found["estimate"] = estimated_bytes(mesh.n_vertices, mesh.n_corners, settings)
    if options.get("rerun"):
        copy = mesh.with_vertices(mesh.vertices.copy())
        again = changed_a_little(settings)
        watch.run("rerun", lambda: denoise(copy, again, prepared=cache))
        found["stages"]["rerun"] = watch.seconds["rerun"]
    if settings.method == "POSITIONS" and settings.iterations > 1:
        found["iteration"] = found["stages"]["solve"] / (settings.iterations - 1)
        found["floor"] = triad_seconds(BYTES_PER_ITERATION * mesh.n_vertices)
    found |= {"n_vertices": mesh.n_vertices, "n_faces": mesh.n_faces, "moved": result.report.n_moved}
    sys.stdout.write("\n" + json.dumps(found) + "\n")


if __name__ == "__main__":
    main()
