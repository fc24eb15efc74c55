# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""The picture of the demo: meshes side by side, whole and close up, with captions, rendered by Cycles."""

from collections.abc import Sequence
from math import radians
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import bpy
import numpy as np
from mathutils import Vector


class Column(NamedTuple):
    """What stands in one column of the picture; `colors` names a color attribute to paint the mesh with."""

    obj: bpy.types.Object
    title: str
    caption: str  # may have several lines
    colors: str = ""


class View(NamedTuple):
    """What the camera looks at; lengths in scene units, the tile's height in pixels."""

    center: tuple[float, float, float]
    width: float
    height: int


TILE_WIDTH = 280
GAP = 8
TEXT_HEIGHT = 76
LINE_HEIGHT = 24
VIEWS = (
    View((0.07, 0.0, -0.02), 2.82, 250),
    View((0.25, -0.7, 0.2), 1.0, 280),
)
DIRECTION = Vector((0.22, -1.0, 0.10))
"""From the mesh towards the camera."""

KEY_DIRECTION = Vector((-0.80, -0.50, 0.80))
FILL_DIRECTION = Vector((0.60, -0.75, 0.30))
"""From the mesh towards the lights."""

FILL_STRENGTH = (0.03, 0.20)
"""Of the fill light, on faces turned away from it and towards it."""

SAMPLES = 16
CLAY = 0.73
"""The share of light that the meshes throw back."""

PAPER = 0.955
INK = 0.11
PALE_INK = 0.39
"""Grays as they are on the screen (sRGB)."""


def render_picture(columns: Sequence[Column], path: Path, views: Sequence[View] = VIEWS) -> None:
    """Render meshes side by side into a PNG file.

    Parameters
    ----------
    columns : sequence of Column
        The meshes from left to right, which stay hidden but for their own tiles.
    path : Path
        The file to write.
    views : sequence of View, optional
        What the rows show, from top to bottom; by default the monkey and its face.
    """
    scene = bpy.context.scene
    _prepare(scene)
    width = len(columns) * (TILE_WIDTH + GAP) + GAP
    n_lines = max(len(column.caption.splitlines()) for column in columns)
    text_height = TEXT_HEIGHT + (max(n_lines, 1) - 1) * LINE_HEIGHT
    height = text_height + sum(view.height + GAP for view in views)
    sheet = np.ones((height, width, 4), np.float32)
    sheet[:, :, :3] = PAPER
    with TemporaryDirectory(prefix="framelet-") as folder:
        temporary = Path(folder) / "tile.png"
        _light(scene)
        for number, column in enumerate(columns):
            left = GAP + number * (TILE_WIDTH + GAP)
            column.obj.data.materials.clear()
            column.obj.data.materials.append(_clay(column.colors))
            column.obj.data.shade_flat()
            column.obj.hide_render = False
            top = text_height
            for view in views:
                _aim(scene, view)
                tile = _render(scene, temporary, TILE_WIDTH, view.height)
                _paste(sheet, tile, left, top)
                top += view.height + GAP
            column.obj.hide_render = True
        _remove(scene, "LIGHT")
        _paste(sheet, _render_captions(scene, columns, temporary, (width, text_height)), 0, 0)
        _remove(scene, "FONT")
        _remove(scene, "CAMERA")
    _save(scene, sheet, path)


def _remove(scene: bpy.types.Scene, kind: str) -> None:
    """Remove the objects of a type."""
    for obj in [obj for obj in scene.objects if obj.type == kind]:
        bpy.data.objects.remove(obj)


def _prepare(scene: bpy.types.Scene) -> None:
    """Set up the renderer and the camera."""
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.samples = SAMPLES
    scene.cycles.use_denoising = False
    scene.cycles.max_bounces = 0
    scene.cycles.seed = 0
    scene.render.film_transparent = True
    scene.render.use_persistent_data = True
    scene.render.image_settings.file_format = "PNG"
    scene.render.image_settings.color_mode = "RGBA"
    scene.view_settings.view_transform = "Standard"
    camera = bpy.data.cameras.new("Camera")
    camera.type = "ORTHO"
    scene.camera = bpy.data.objects.new("Camera", camera)
    scene.collection.objects.link(scene.camera)


def _light(scene: bpy.types.Scene) -> None:
    """Light from the side, so that small bumps show."""
    sun = bpy.data.lights.new("Key", "SUN")
    sun.energy = 3.0
    sun.angle = radians(6.0)
    obj = bpy.data.objects.new("Key", sun)
    obj.rotation_euler = KEY_DIRECTION.to_track_quat("Z", "Y").to_euler()
    scene.collection.objects.link(obj)


def _clay(colors: str) -> bpy.types.Material:
    """Make the material of a mesh: gray, or painted with a color attribute.

    It glows by how much a face is turned to the fill light. Such a light costs no rays and is free of noise,
    and with a single real one few samples are enough.
    """
    material = bpy.data.materials.new("Clay")
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    geometry = nodes.new("ShaderNodeNewGeometry")
    facing = nodes.new("ShaderNodeVectorMath")
    facing.operation = "DOT_PRODUCT"
    facing.inputs[1].default_value = FILL_DIRECTION.normalized()
    strength = nodes.new("ShaderNodeMapRange")
    for place, value in enumerate((-1.0, 1.0, *FILL_STRENGTH), start=1):
        strength.inputs[place].default_value = value
    fill = nodes.new("ShaderNodeEmission")
    diffuse = nodes.new("ShaderNodeBsdfDiffuse")
    fill.inputs["Color"].default_value = diffuse.inputs["Color"].default_value = (CLAY, CLAY, CLAY, 1.0)
    if colors:
        paint = nodes.new("ShaderNodeVertexColor")
        paint.layer_name = colors
        links.new(paint.outputs["Color"], fill.inputs["Color"])
        links.new(paint.outputs["Color"], diffuse.inputs["Color"])
    both = nodes.new("ShaderNodeAddShader")
    links.new(geometry.outputs["Normal"], facing.inputs[0])
    links.new(facing.outputs["Value"], strength.inputs[0])
    links.new(strength.outputs[0], fill.inputs["Strength"])
    links.new(fill.outputs[0], both.inputs[0])
    links.new(diffuse.outputs[0], both.inputs[1])
    links.new(both.outputs[0], nodes["Material Output"].inputs["Surface"])
    # Else every triangle would be sampled as a lamp.
    material.cycles.emission_sampling = "NONE"
    return material


def _aim(scene: bpy.types.Scene, view: View) -> None:
    """Point the camera at a view."""
    camera = scene.camera
    camera.data.ortho_scale = view.width
    camera.location = Vector(view.center) + 10.0 * DIRECTION.normalized()
    camera.rotation_euler = DIRECTION.to_track_quat("Z", "Y").to_euler()


def _render_captions(
    scene: bpy.types.Scene, columns: Sequence[Column], temporary: Path, size: tuple[int, int]
) -> np.ndarray:
    """Render the texts above the columns; one scene unit is one pixel."""
    width, height = size
    lift = 0.5 * (height - TEXT_HEIGHT)
    for number, column in enumerate(columns):
        center = GAP + number * (TILE_WIDTH + GAP) + 0.5 * TILE_WIDTH - 0.5 * width
        _write(scene, column.title, (center, lift + 7.0), 28.0, INK)
        for line_number, line in enumerate(column.caption.splitlines()):
            _write(scene, line, (center, lift - 21.0 - line_number * LINE_HEIGHT), 19.0, PALE_INK)
    scene.camera.data.ortho_scale = width
    scene.camera.location = (0.0, 0.0, 10.0)
    scene.camera.rotation_euler = (0.0, 0.0, 0.0)
    return _render(scene, temporary, width, height)


def _write(
    scene: bpy.types.Scene,
    text: str,
    place: tuple[float, float],
    size: float,
    gray: float,
) -> None:
    """Put a centered line of text into the plane of the sheet."""
    curve = bpy.data.curves.new("Text", "FONT")
    curve.body = text
    curve.size = size
    curve.align_x = "CENTER"
    curve.materials.append(_glow(gray))
    obj = bpy.data.objects.new("Text", curve)
    obj.location = (*place, 0.0)
    scene.collection.objects.link(obj)


def _glow(gray: float) -> bpy.types.Material:
    """Make a material that shows an sRGB gray as it is, whatever the light."""
    material = bpy.data.materials.new("Glow")
    material.use_nodes = True
    nodes = material.node_tree.nodes
    emission = nodes.new("ShaderNodeEmission")
    linear = ((gray + 0.055) / 1.055) ** 2.4
    emission.inputs["Color"].default_value = (linear, linear, linear, 1.0)
    material.node_tree.links.new(emission.outputs[0], nodes["Material Output"].inputs["Surface"])
    return material


def _render(scene: bpy.types.Scene, temporary: Path, width: int, height: int) -> np.ndarray:
    """Render the scene; return its pixels from the top, shape (height, width, 4), 0 to 1."""
    scene.render.resolution_x = width
    scene.render.resolution_y = height
    scene.render.resolution_percentage = 100
    scene.render.filepath = str(temporary)
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(str(temporary))
    pixels = np.empty(width * height * 4, np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    return pixels.reshape(height, width, 4)[::-1]


def _paste(sheet: np.ndarray, tile: np.ndarray, left: int, top: int) -> None:
    """Lay a tile with transparency over the sheet, in place."""
    target = sheet[top : top + tile.shape[0], left : left + tile.shape[1], :3]
    alpha = tile[:, :, 3:]
    target += alpha * (tile[:, :, :3] - target)


def _save(scene: bpy.types.Scene, sheet: np.ndarray, path: Path) -> None:
    """Write the sheet as WebP, which takes a fifth of what PNG takes."""
    height, width = sheet.shape[:2]
    image = bpy.data.images.new("Sheet", width, height, alpha=False)
    image.pixels.foreach_set(sheet[::-1].reshape(-1))
    scene.render.image_settings.file_format = "WEBP"
    scene.render.image_settings.color_mode = "RGB"
    scene.render.image_settings.quality = 82
    image.save_render(str(path), scene=scene)
