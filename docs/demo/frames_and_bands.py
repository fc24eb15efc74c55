# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Render the pictures of the page *Frames and bands* with the operators that it explains.

Run it with the Python of a bpy environment; it reads no file and writes two pictures to `docs/images`.
"""

import sys

import bpy
from checkout import ROOT, load_framelet

load_framelet()

import framelet  # noqa: E402
from meshes import copy_object, make_monkey  # noqa: E402
from picture import Column, render_picture  # noqa: E402
from quiet import without_output  # noqa: E402

IMAGES = ROOT / "docs" / "images"
N_LEVELS = 3
GAINS = (
    ("Original", ()),
    ("Fine removed", (0.0, 1.0, 1.0)),
    ("Middle exaggerated", (1.0, 3.0, 1.0)),
    ("All removed", (0.0, 0.0, 0.0)),
)


def main() -> int:
    """Render both pictures and return the exit code."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    framelet.register()
    try:
        with without_output():
            monkey = make_monkey("Monkey")
            render_picture(show_bands(monkey), IMAGES / "bands.webp")
            render_picture(equalized(monkey), IMAGES / "equalizer.webp")
    finally:
        # A class that is still registered when Python exits crashes Blender 4.2.
        framelet.unregister()
    sys.stdout.write(f"Wrote bands.webp and equalizer.webp to {IMAGES}.\n")
    return 0


def show_bands(monkey: bpy.types.Object) -> list[Column]:
    """Return copies of a mesh that are painted with the same band of three levels."""
    columns = []
    for level in range(1, N_LEVELS + 1):
        obj = copy_object(monkey, f"Level {level}")
        select(obj)
        bpy.ops.object.framelet_analyze(levels=N_LEVELS)
        bpy.ops.object.framelet_show_band(content="BAND", level=level, band=1, component="NORMAL")
        shown = bpy.context.window_manager.framelet_band_range
        caption = f"blue −{1000 * shown.maximum:.2g} mm, red +{1000 * shown.maximum:.2g} mm"
        columns.append(Column(obj, f"Level {level}, band 1", caption, "framelet_band"))
    return columns


def equalized(monkey: bpy.types.Object) -> list[Column]:
    """Return copies of a mesh with the gains of `GAINS`."""
    columns = []
    for title, gains in GAINS:
        obj = copy_object(monkey, title)
        select(obj)
        if gains:
            named = {f"gain_{level}": gain for level, gain in enumerate(gains, 1)}
            bpy.ops.object.framelet_equalize(levels=len(gains), stencil="ADAPTIVE", **named)
        caption = ", ".join(f"{gain:g}" for gain in gains or (1.0,) * N_LEVELS)
        columns.append(Column(obj, title, f"gains {caption}"))
    return columns


def select(obj: bpy.types.Object) -> None:
    """Make an object the only selected and the active one."""
    for other in bpy.context.scene.objects:
        other.select_set(other == obj)
    bpy.context.view_layer.objects.active = obj


if __name__ == "__main__":
    sys.exit(main())
