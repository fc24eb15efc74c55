# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Denoise a noisy mesh, print how well it went, and render a picture.

Run it by `make demo` or with the Python of a bpy environment. It reads no file: the mesh is Blender's own
monkey, the noise is that of the paper.
"""

import argparse
import csv
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import bpy
from checkout import load_framelet

load_framelet()

from framelet.core import PRESETS, Comparison, add_noise, compare, denoise  # noqa: E402
from framelet.operators.mesh_io import mesh_bridge  # noqa: E402
from meshes import copy_with_vertices, make_monkey, write_ply  # noqa: E402
from picture import Column, render_picture  # noqa: E402
from quiet import without_output  # noqa: E402

SIGMA = 0.2
"""Noise in mean edge lengths, as in the paper's experiments."""

SEED = 0
METHODS = ("BILATERAL", "TRI_1", "TRI_2", "AUTO")


class Run(NamedTuple):
    """A mesh, how far it is from the clean one, and how long it took to compute."""

    name: str
    obj: bpy.types.Object
    comparison: Comparison
    seconds: float | None = None

    def cells(self) -> tuple[str, ...]:
        """Return what stands in the table."""
        found = self.comparison
        return (
            self.name,
            f"{found.mean_angle:.2f}",
            f"{found.rms_distance / found.mean_edge_length:.3f}",
            f"{found.flipped_faces}",
            "" if self.seconds is None else f"{self.seconds:.2f}",
        )


HEADINGS = ("Method", "Mean angle (degrees)", "RMS distance (edges)", "Flipped faces", "Seconds")


def main() -> int:
    """Run the demo and return the exit code."""
    parser = argparse.ArgumentParser(description="Denoise a noisy mesh and render a picture of it.")
    parser.add_argument("--output", type=Path, default=Path("build/demo"), help="folder for all files")
    output = parser.parse_args().output
    output.mkdir(parents=True, exist_ok=True)

    bpy.ops.wm.read_factory_settings(use_empty=True)
    clean_obj = make_monkey("clean")
    runs = denoise_monkey(clean_obj)
    print_table(runs)
    write_csv(runs, output / "results.csv")

    with without_output():
        for obj in [clean_obj, *(run.obj for run in runs)]:
            write_ply(obj, output / f"{obj.name}.ply")
        columns = [Column(run.obj, run.name, f"{run.comparison.mean_angle:.1f}° mean error") for run in runs]
        columns.append(Column(clean_obj, "Clean", "before noise was added"))
        render_picture(columns, output / "before_after.webp")
    print(f"\nMeshes (PLY), results.csv and before_after.webp are in {output}.")
    return 0


def denoise_monkey(clean_obj: bpy.types.Object) -> list[Run]:
    """Add noise to a mesh, denoise it by each method with its preset, and compare the results with it."""
    clean = mesh_bridge.read_surface(clean_obj)
    noisy = clean.with_vertices(add_noise(clean, SIGMA, SEED))
    print(
        f"Blender's monkey: {clean.n_vertices:,} vertices, {clean.n_faces:,} triangles; "
        f"noise of {SIGMA:g} mean edge lengths along the normals.\n",
        flush=True,
    )
    noisy_obj = copy_with_vertices(clean_obj, "noisy", noisy.vertices)
    runs = [Run("Noisy", noisy_obj, compare(noisy, clean))]
    for key in METHODS:
        preset = PRESETS[key]
        result = denoise(noisy, preset.settings)
        obj = copy_with_vertices(clean_obj, key.lower(), result.vertices)
        comparison = compare(noisy.with_vertices(result.vertices), clean)
        runs.append(Run(preset.label, obj, comparison, result.report.seconds))
    return runs


def print_table(runs: Sequence[Run]) -> None:
    """Print the results, one line for each mesh."""
    for row in (HEADINGS, *(run.cells() for run in runs)):
        columns = [row[0].ljust(10)]
        columns += [cell.rjust(len(heading)) for cell, heading in zip(row[1:], HEADINGS[1:], strict=True)]
        print("  ".join(columns).rstrip())
    sys.stdout.flush()


def write_csv(runs: Sequence[Run], path: Path) -> None:
    """Write the table as a file."""
    with path.open("w", encoding="utf-8", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([HEADINGS, *(run.cells() for run in runs)])


if __name__ == "__main__":
    sys.exit(main())
