# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Render the strips of the page *λ and μ*: the monkey with noise, cleaned with one value after the other.

Run it with the Python of a bpy environment; it reads no file and writes two pictures to `docs/images`.
"""

import sys

import bpy
from checkout import ROOT, load_framelet

load_framelet()

from framelet.core import PRESETS, SurfaceMesh, add_noise, compare, denoise  # noqa: E402
from framelet.operators.mesh_io import mesh_bridge  # noqa: E402
from meshes import copy_with_vertices, make_monkey  # noqa: E402
from picture import Column, View, render_picture  # noqa: E402
from quiet import without_output  # noqa: E402

IMAGES = ROOT / "docs" / "images"
SIGMA = 0.2
"""Noise in mean edge lengths."""

LAMBDAS = (0.05, 0.15, 0.3, 0.6, 1.5)
MUS = (0.1, 1.0, 10.0, 30.0)
MANY = 300
"""Iterations after which hardly anything changes any more."""

VIEWS = (View((0.07, 0.0, -0.02), 2.82, 230), View((0.25, -0.7, 0.2), 1.0, 230))


def main() -> int:
    """Render both strips and return the exit code."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    with without_output():
        monkey = make_monkey("Monkey")
    clean = mesh_bridge.read_surface(monkey)
    noisy = clean.with_vertices(add_noise(clean, SIGMA, 0))
    rows = [(f"λ = {value:g}", {"lambda_": value}) for value in LAMBDAS]
    render(monkey, clean, noisy, rows, "lambda.webp")
    rows = [(f"μ = {value:g}", {"mu": value}) for value in MUS]
    rows.append((f"{MANY} iterations", {"iterations": MANY}))
    render(monkey, clean, noisy, rows, "mu.webp")
    return 0


def render(monkey: bpy.types.Object, clean: SurfaceMesh, noisy: SurfaceMesh, rows, name: str) -> None:
    """Denoise with each row's changes of Tri-2, and render the results side by side."""
    columns = []
    for title, changes in rows:
        result = denoise(noisy, PRESETS["TRI_2"].settings.with_changes(**changes))
        found = compare(noisy.with_vertices(result.vertices), clean)
        caption = f"{found.mean_angle:.1f}° from the clean mesh"
        columns.append(Column(copy_with_vertices(monkey, title, result.vertices), title, caption))
        moved = result.report.displacement_rms / result.report.mean_edge_length
        print(f"{title}: {caption}; moved {moved:.3f} edge lengths.", flush=True)
    with without_output():
        render_picture(columns, IMAGES / name, VIEWS)
    print(f"Wrote {name} to {IMAGES}.", flush=True)


if __name__ == "__main__":
    sys.exit(main())
