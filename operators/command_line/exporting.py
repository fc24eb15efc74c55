# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Write files through Blender's own exporters."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bpy

from ..mesh_io.mesh_bridge import read_surface
from .file_types import BLEND, file_type
from .importing import AXES, call, exists
from .messages import Messages

_SHOWN = "DAG_EVAL_VIEWPORT"
_PLAIN = {"check_existing": False, "apply_modifiers": False}

# The first that this version of Blender has is used.
_EXPORTERS: dict[str, tuple[tuple[str, dict[str, Any]], ...]] = {
    # With UVs the exporter would sort the vertices anew.
    ".ply": (
        ("wm.ply_export", {**AXES, "export_uv": False, "export_colors": "SRGB", "export_attributes": True}),
    ),
    ".obj": (("wm.obj_export", {**AXES, "export_eval_mode": _SHOWN, "path_mode": "ABSOLUTE"}),),
    ".stl": (("wm.stl_export", {**AXES, "evaluation_mode": _SHOWN}),),
    ".glb": (("export_scene.gltf", {"export_format": "GLB", "export_apply": False}),),
    ".gltf": (("export_scene.gltf", {"export_format": "GLTF_SEPARATE", "export_apply": False}),),
    ".fbx": (("export_scene.fbx", {"use_mesh_modifiers": False, "path_mode": "ABSOLUTE"}),),
    ".abc": (("wm.alembic_export", {"as_background_job": False, "evaluation_mode": "VIEWPORT"}),),
    ".usd": (("wm.usd_export", {"evaluation_mode": "VIEWPORT"}),),
}


def export(
    objects: list[bpy.types.Object], source: Path, target: Path, path: Path, messages: Messages
) -> None:
    """Write objects into a file.

    Parameters
    ----------
    objects : list of bpy.types.Object
        What is written to formats that hold meshes only; a .blend file is saved as a whole. Modifiers are not
        applied.
    source : Path
        Where they come from.
    target, path : Path
        The file in the end, and where it is to be written.
    messages : Messages
        Takes warnings about what the format cannot carry.

    Raises
    ------
    CommandError
        If Blender reports an error.
    """
    kind = file_type(target)
    if kind == BLEND:
        call("wm.save_as_mainfile", path, copy=True, check_existing=False)
        return
    for obj in objects:
        _show_active_key(obj)
    if kind == ".ply" and any(obj.data.uv_layers for obj in objects):
        messages.warn("A .ply file that Blender writes holds no UV maps here; they were left out.")
    _show_only(objects)
    if kind == ".obj" and not any(any(obj.data.materials) for obj in objects):
        plain = {**_PLAIN, "export_materials": False}
    else:
        plain = _PLAIN
    for name, options in _EXPORTERS[".usd" if kind.startswith(".usd") else kind]:
        if exists(name):
            call(name, path, **{**plain, **options})
            break


def _show_active_key(obj: bpy.types.Object) -> None:
    """Give the mesh itself the positions of the shape key that was denoised; exporters know no other."""
    if obj.data.shape_keys is not None:
        positions = read_surface(obj).vertices
        obj.data.attributes["position"].data.foreach_set("vector", positions.ravel())


def _show_only(objects: list[bpy.types.Object]) -> None:
    """Leave these objects alone in the scene, and show them, since hidden ones are not exported."""
    scene = bpy.data.scenes.new("Framelet")
    for obj in objects:
        obj.hide_viewport = obj.hide_render = False
        scene.collection.objects.link(obj)
    scene.view_layers[0].update()
    if bpy.context.window is not None:
        bpy.context.window.scene = scene
    for other in bpy.data.scenes[:]:
        if other != scene:
            bpy.data.scenes.remove(other)
