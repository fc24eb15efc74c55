# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Render the pictures of the page *How AUTO works*: scans as they are, after AUTO and after the baseline.

Run it with the Python of a bpy environment. It reads scans from the folder that the variable FRAMELET_MESHES
names, skips those that are not there, and writes a picture of each to `docs/images`. The scans themselves are
other people's and not part of Framelet.
"""

import os
import sys
from dataclasses import replace
from math import radians
from pathlib import Path
from typing import NamedTuple

import bpy
import numpy as np
from checkout import ROOT, load_framelet
from mathutils import Euler, Vector

load_framelet()

from framelet.core import PRESETS, denoise  # noqa: E402
from framelet.operators.mesh_io import mesh_bridge  # noqa: E402
from meshes import copy_with_vertices  # noqa: E402
from picture import DIRECTION, Column, View, render_picture  # noqa: E402
from quiet import without_output  # noqa: E402

IMAGES = ROOT / "docs" / "images"
SIZE = 2.4
"""Of a scan in the picture, so that the camera sees all of it."""


class Scan(NamedTuple):
    """A file, how the scan is turned (degrees about x, y and z), and what the rows of its picture show.

    A row is a place in the picture, from its middle to the right and up, and the width that is shown. With
    `strengths` AUTO runs with each of them.
    """

    name: str
    turn: tuple[float, float, float]
    rows: tuple[tuple[float, float, float], ...]
    strengths: tuple[float, ...] = (1.0,)


SCANS = (
    Scan("angel25k", (-120.0, 0.0, 0.0), ((0.0, 0.0, 2.8), (0.0, 0.0, 1.1), (-0.85, 0.4, 0.6))),
    Scan("iron86k", (-90.0, 0.0, 0.0), ((0.0, 0.0, 2.8), (-0.45, 0.25, 1.1), (-0.05, 0.0, 0.6)), (1.0, 3.0)),
    Scan("rabbit37k", (90.0, 0.0, 0.0), ((0.0, 0.0, 2.8), (-0.85, 0.05, 1.1), (0.25, -0.1, 0.6))),
)
HEIGHT = 260
"""Of a row, in pixels."""


def main() -> int:
    """Render a picture for each scan and return the exit code."""
    folder = os.environ.get("FRAMELET_MESHES", "")
    for scan in SCANS:
        path = Path(folder) / "scan" / f"{scan.name}.ply"
        if not folder or not path.is_file():
            print(f"No picture of {scan.name}: there is no scan/{scan.name}.ply in FRAMELET_MESHES.")
            continue
        bpy.ops.wm.read_factory_settings(use_empty=True)
        with without_output():
            obj = load_scan(path, scan.turn)
        columns = denoised(obj, scan.strengths)
        with without_output():
            render_picture(columns, IMAGES / f"scan_{scan.name}.webp", [view(*row) for row in scan.rows])
        print(f"Wrote scan_{scan.name}.webp to {IMAGES}.", flush=True)
    return 0


def load_scan(path: Path, turn: tuple[float, float, float]) -> bpy.types.Object:
    """Read a scan, turn it, and bring it to the middle of the picture."""
    bpy.ops.wm.ply_import(filepath=str(path), forward_axis="Y", up_axis="Z")
    source = bpy.context.object
    vertices = np.asarray(mesh_bridge.read_surface(source).vertices, np.float64)
    vertices = vertices @ np.array(Euler([radians(angle) for angle in turn]).to_matrix()).T
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    vertices = (vertices - 0.5 * (low + high)) * (SIZE / (high - low)[[0, 2]].max())
    obj = copy_with_vertices(source, "Scan", vertices)
    bpy.data.objects.remove(source)
    return obj


def denoised(obj: bpy.types.Object, strengths: tuple[float, ...]) -> list[Column]:
    """Return a scan, and what AUTO and the bilateral filter make of it."""
    surface = mesh_bridge.read_surface(obj)
    columns = [Column(obj, "Scan", f"{surface.n_faces:,} triangles")]
    auto = [replace(PRESETS["AUTO"].settings, strength=strength) for strength in strengths]
    for settings in (*auto, PRESETS["BILATERAL"].settings):
        result = denoise(surface, settings)
        report = result.report
        title, caption = "Bilateral", f"{report.iterations} iterations"
        if report.noise is not None:
            title = "Automatic" if settings.strength == 1.0 else f"Strength {settings.strength:g}"
            noise = report.noise
            caption = f"noise of {noise.sigma_edges:.2f} edges"
            low, high = (value / report.mean_edge_length for value in (noise.sigma_low, noise.sigma_high))
            print(f"Noise of {low:.3f} to {high:.3f} edge lengths, {noise.width:.1f} edges wide.")
        columns.append(Column(copy_with_vertices(obj, title, result.vertices), title, caption))
        print(
            f"{title}: {caption}; "
            f"moved {report.displacement_rms / report.mean_edge_length:.3f} edge lengths (rms), "
            f"{report.flipped_faces} faces turned over, {report.seconds:.1f} s.",
            flush=True,
        )
    return columns


def view(right: float, up: float, width: float) -> View:
    """Return what the camera has to look at for a place in the picture."""
    center = DIRECTION.to_track_quat("Z", "Y") @ Vector((right, up, 0.0))
    return View(tuple(center), width, HEIGHT)


if __name__ == "__main__":
    sys.exit(main())
