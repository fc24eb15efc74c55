# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The legend in 3D Views whose meshes show a heat map or a band."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import blf
import bpy
import gpu
from bpy.app.translations import pgettext_iface as iface_
from gpu_extras.batch import batch_for_shader

from ...operators.mesh_io import band_storage
from ...operators.properties.scene_units import value_texts
from .legend_layout import FONT_POINTS, LegendLayout, Rectangle, free_area, lay_out_legend, tick_values

BACKDROP = (0.0, 0.0, 0.0, 0.55)
INK = (0.95, 0.95, 0.95, 1.0)
"""Light on a dark backdrop, which can be read over any theme and any mesh."""

FONT = 0

_handle: Any = None


def is_wanted(context: bpy.types.Context) -> bool:
    """Tell whether a 3D View shows a mesh in the colors that the legend explains."""
    space = context.space_data
    shown = context.window_manager.framelet_band_range
    if not shown.objects or not space.overlay.show_overlays:
        return False
    if (space.shading.type, space.shading.color_type) != ("SOLID", "VERTEX"):
        return False
    name = band_storage.HEAT_COLORS if shown.quantity else band_storage.COLORS
    objects = (context.view_layer.objects.get(each) for each in _names(shown))
    return any(
        obj is not None
        and obj.type == "MESH"
        and name in obj.data.attributes
        and obj.data.attributes.active_color_name == name
        and obj.visible_get(viewport=space)
        for obj in objects
    )


def _names(shown: bpy.types.PropertyGroup) -> list[str]:
    """Return the names of the objects that are colored."""
    return [item.name for item in shown.objects]


def legend_texts(scene: bpy.types.Scene, shown: bpy.types.PropertyGroup) -> tuple[str, list[str], str]:
    """Return the title, the labels from the lowest value up, and the note of the legend."""
    values = tick_values(shown.minimum, shown.maximum, shown.is_signed)
    labels = value_texts(scene, values, shown.unit)
    note = "" if shown.share >= 99.95 else iface_("{:.1f}% in this range").format(shown.share)
    if shown.tolerance:
        (tolerance,) = value_texts(scene, [shown.tolerance], shown.unit)
        note = iface_("Green: up to {tolerance}, {share:.3g}%").format(tolerance=tolerance, share=shown.green)
    return iface_(shown.title), labels, note


def stripe_colors(
    is_signed: bool, values: Iterable[float], tolerance: float | None = None
) -> list[tuple[float, float, float, float]]:
    """Return the colors of places along the bar, from 0 to 1, as the screen wants them.

    What is at most `tolerance`, as a share of the largest value, is green.
    """
    from ...operators.colors.colormaps import DIVERGING, SEQUENTIAL, map_colors

    colormap = DIVERGING if is_signed else SEQUENTIAL
    span = colormap.high - colormap.low
    linear = map_colors(colormap, [colormap.low + value * span for value in values], tolerance)
    red, green, blue = ([_to_srgb(float(part)) for part in linear[:, axis]] for axis in range(3))
    return [(*color, 1.0) for color in zip(red, green, blue, strict=True)]


def _to_srgb(part: float) -> float:
    """Return the sRGB value of a scene-linear one; regions with text are drawn in sRGB."""
    return 12.92 * part if part <= 0.0031308 else 1.055 * part ** (1 / 2.4) - 0.055


def ui_scale(context: bpy.types.Context) -> float:
    """Return the number of pixels for one unit of the interface."""
    return context.preferences.system.ui_scale or 1.0


def find_layout(context: bpy.types.Context, region: bpy.types.Region) -> LegendLayout | None:
    """Return where the legend goes in a region of a 3D View; None if there is no room."""
    scale = ui_scale(context)
    title, texts, note = legend_texts(context.scene, context.window_manager.framelet_band_range)
    blf.size(FONT, FONT_POINTS * scale)
    others = [_rectangle(each) for each in context.area.regions if each.type not in {"WINDOW", "HUD", "XR"}]
    area = free_area(_rectangle(region), others)
    return lay_out_legend(area, scale, title, texts, note, lambda text: blf.dimensions(FONT, text))


def _rectangle(region: bpy.types.Region) -> Rectangle:
    return Rectangle(region.x, region.y, region.width, region.height)


def _draw() -> None:
    """Draw the legend into the region that Blender is drawing."""
    context = bpy.context
    if not is_wanted(context):
        return
    layout = find_layout(context, context.region)
    if layout is None:
        return
    shown = context.window_manager.framelet_band_range
    gpu.state.blend_set("ALPHA")
    _fill([layout.backdrop], [BACKDROP])
    tolerance = shown.tolerance / shown.maximum if shown.tolerance else None
    _fill(layout.stripes, stripe_colors(shown.is_signed, layout.values, tolerance))
    _fill(layout.ticks, [INK] * len(layout.ticks))
    gpu.state.blend_set("NONE")
    blf.size(FONT, FONT_POINTS * ui_scale(context))
    blf.color(FONT, *INK)
    for label in layout.labels:
        blf.position(FONT, round(label.x), round(label.y), 0.0)
        blf.draw(FONT, label.text)


def _fill(rectangles: list[Rectangle], colors: list[tuple[float, float, float, float]]) -> None:
    """Fill rectangles, each with a color."""
    points: list[tuple[float, float]] = []
    corner_colors: list[tuple[float, float, float, float]] = []
    triangles: list[tuple[int, int, int]] = []
    for rectangle, color in zip(rectangles, colors, strict=True):
        first = len(points)
        x, y, right, top = rectangle.x, rectangle.y, rectangle.right, rectangle.top
        points += [(x, y), (right, y), (right, top), (x, top)]
        corner_colors += [color] * 4
        triangles += [(first, first + 1, first + 2), (first, first + 2, first + 3)]
    shader = gpu.shader.from_builtin("FLAT_COLOR")
    batch = batch_for_shader(shader, "TRIS", {"pos": points, "color": corner_colors}, indices=triangles)
    batch.draw(shader)


def register() -> None:
    """Let 3D Views draw the legend."""
    global _handle
    _handle = bpy.types.SpaceView3D.draw_handler_add(_draw, (), "WINDOW", "POST_PIXEL")


def unregister() -> None:
    """Take the legend away."""
    global _handle
    bpy.types.SpaceView3D.draw_handler_remove(_handle, "WINDOW")
    _handle = None
