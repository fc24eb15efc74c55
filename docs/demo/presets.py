# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Render the pictures of the page *Which preset for my mesh*: models made in code, several presets each.

Run it with the Python of a bpy environment; it reads no file, writes a picture for each kind of mesh to
`docs/images`, and prints what stands in the tables of the page.
"""

import sys
from typing import NamedTuple

import bpy
from checkout import ROOT, load_framelet

load_framelet()

from framelet.core import PRESETS, SurfaceMesh, add_noise, compare, denoise  # noqa: E402
from framelet.operators.mesh_io import mesh_bridge  # noqa: E402
from meshes import copy_with_vertices, make_monkey  # noqa: E402
from models import bone, bracket, make_carved_monkey, make_quad_monkey, surface_object  # noqa: E402
from picture import Column, View, render_picture  # noqa: E402
from quiet import without_output  # noqa: E402

IMAGES = ROOT / "docs" / "images"
FACE = (View((0.07, 0.0, -0.02), 2.82, 230), View((0.25, -0.7, 0.2), 1.0, 230))
WHOLE = (View((0.0, 0.0, 0.0), 2.5, 230),)
PART = (View((0.0, 0.0, 0.1), 2.5, 230), View((0.3, -0.5, 0.25), 1.1, 230))
BONE = (View((0.0, 0.0, 0.0), 2.9, 260), View((0.25, -0.3, 0.85), 1.1, 230))


class Kind(NamedTuple):
    """A kind of mesh: its picture, its noise in edge lengths (0: noisy already), and presets to compare."""

    name: str
    sigma: float
    presets: tuple[str, ...]
    views: tuple[View, ...]


KINDS = (
    Kind("scan", 0.2, ("AUTO", "FREE_FORM", "PRISMATIC", "TRI_2"), FACE),
    Kind("part", 0.2, ("AUTO", "PRISMATIC", "FREE_FORM", "TRI_2"), PART),
    Kind("voxels", 0.0, ("AUTO", "MARCHING_CUBES", "POSITIONS", "PRISMATIC"), BONE),
    Kind("sculpt", 0.08, ("AUTO", "SCULPT", "FREE_FORM", "TRI_1"), FACE),
    Kind("quads", 0.2, ("AUTO", "QUAD_2", "QUAD_1", "TRI_2"), FACE),
)


def main() -> int:
    """Render the pictures of the kinds that are named, all by default; return the exit code."""
    wanted = sys.argv[1:] or [kind.name for kind in KINDS]
    for kind in KINDS:
        if kind.name in wanted:
            bpy.ops.wm.read_factory_settings(use_empty=True)
            with without_output():
                obj = make(kind.name)
            columns = compared(obj, kind)
            with without_output():
                render_picture(columns, IMAGES / f"preset_{kind.name}.webp", kind.views)
            print(f"Wrote preset_{kind.name}.webp to {IMAGES}.", flush=True)
    return 0


def make(name: str) -> bpy.types.Object:
    """Return the model of a kind."""
    if name == "part":
        return surface_object("Part", bracket())
    if name == "voxels":
        return surface_object("Bone", bone())
    makers = {"scan": make_monkey, "sculpt": make_carved_monkey, "quads": make_quad_monkey}
    return makers[name]("Monkey")


def compared(obj: bpy.types.Object, kind: Kind) -> list[Column]:
    """Return the noisy model, and what the presets make of it."""
    clean = mesh_bridge.read_surface(obj)
    noisy = clean.with_vertices(add_noise(clean, kind.sigma, 0)) if kind.sigma else clean
    first = copy_with_vertices(obj, "Noisy", noisy.vertices)
    columns = [Column(first, "Noisy" if kind.sigma else "From voxels", caption(noisy, clean, kind))]
    print(f"{kind.name}: {clean.n_vertices:,} vertices; noisy {caption(noisy, clean, kind)}")
    for key in kind.presets:
        if key not in PRESETS:
            continue
        preset = PRESETS[key]
        result = denoise(noisy, preset.settings)
        words = caption(noisy.with_vertices(result.vertices), clean, kind)
        moved = result.report.displacement_rms / result.report.mean_edge_length
        if not kind.sigma:
            words = f"moved {moved:.2f} edges (rms)"
        columns.append(Column(copy_with_vertices(obj, preset.label, result.vertices), preset.label, words))
        print(
            f"{preset.label}: {words}; moved {moved:.3f} edge lengths, "
            f"{result.report.flipped_faces} flipped, {result.report.seconds:.1f} s",
            flush=True,
        )
    return columns


def caption(surface: SurfaceMesh, clean: SurfaceMesh, kind: Kind) -> str:
    """Return the error of a surface, or its size where nobody knows the clean one."""
    if not kind.sigma:
        return f"{surface.n_faces:,} triangles"
    return f"{compare(surface, clean).mean_angle:.1f}° mean error"


if __name__ == "__main__":
    sys.exit(main())
