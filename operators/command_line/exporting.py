# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Write mesh files and .blend files through Blender's own exporters."""

from __future__ import annotations

from contextlib import nullcontext
from pathlib import Path
from typing import Any

import bpy

from ..mesh_io.mesh_bridge import read_surface
from . import obj_text, ply_attributes
from .blender_output import captured_output
from .file_types import BLEND, file_type
from .importing import AXES, Surfaces
from .messages import CommandError, Messages
from .private_scene import scene_showing
from .staging import Staging


def export(surfaces: Surfaces, target: Path, staging: Staging, messages: Messages) -> None:
    """Write the objects into the staging area of a file.

    Parameters
    ----------
    surfaces : Surfaces
        What is written; modifiers are not applied.
    target : Path
        The file in the end; its suffix tells the format.
    staging : Staging
        Gives the place to write to.
    messages : Messages
        Takes warnings about what the format cannot carry.

    Raises
    ------
    CommandError
        If Blender reports an error.
    """
    if file_type(target) == BLEND:
        _save_blend(surfaces, target, staging)
        return
    path = staging.path_for(target)
    for obj in surfaces.objects:
        _show_active_key(obj)
    context = scene_showing(surfaces.objects) if surfaces.scene is None else nullcontext(surfaces.scene)
    with context as scene:
        kind = file_type(target)
        if kind == ".ply":
            _export_ply(surfaces, path, scene, messages)
        elif kind == ".obj":
            _export_obj(surfaces, path, scene)
        else:
            _call(bpy.ops.wm.stl_export, path, scene, evaluation_mode="DAG_EVAL_VIEWPORT", **AXES)


def _export_ply(surfaces: Surfaces, path: Path, scene: bpy.types.Scene, messages: Messages) -> None:
    """Write a PLY file with the vertices in their order."""
    for obj in surfaces.objects:
        ply_attributes.round_colors(obj.data)
        if not ply_attributes.store_uv_by_vertex(obj.data):
            messages.warn(
                f"The UV map of ‘{obj.name}’ has seams, which a PLY file cannot hold without more vertices; "
                "it was left out."
            )
    _call(
        bpy.ops.wm.ply_export,
        path,
        scene,
        export_uv=False,  # would sort the vertices anew
        export_normals=surfaces.has_normals and surfaces.scene is not None,
        export_colors="SRGB",
        export_attributes=True,
        **AXES,
    )


def _export_obj(surfaces: Surfaces, path: Path, scene: bpy.types.Scene) -> None:
    """Write an OBJ file with all digits, and a .mtl file if there are materials."""
    meshes = [obj.data for obj in surfaces.objects]
    _call(
        bpy.ops.wm.obj_export,
        path,
        scene,
        export_eval_mode="DAG_EVAL_VIEWPORT",
        export_normals=surfaces.has_normals,
        export_colors=any(mesh.color_attributes for mesh in meshes),
        export_materials=any(any(mesh.materials) for mesh in meshes),
        export_vertex_groups=surfaces.scene is not None
        and any(obj.vertex_groups for obj in surfaces.objects),
        path_mode="AUTO",
        **AXES,
    )
    obj_text.write_all_digits(path, list(scene.objects))
    obj_text.shorten_texture_paths(path.with_suffix(".mtl"), path.parent.parent)


def _show_active_key(obj: bpy.types.Object) -> None:
    """Give the mesh itself the positions of the shape key that was denoised; exporters know no other."""
    if obj.data.shape_keys is not None:
        positions = read_surface(obj).vertices
        obj.data.attributes["position"].data.foreach_set("vector", positions.ravel())


def _save_blend(surfaces: Surfaces, target: Path, staging: Staging) -> None:
    """Save the opened .blend file as a copy, or a new one with the imported objects."""
    path = staging.sibling_for(target)
    if surfaces.scene is None:
        _call(bpy.ops.wm.save_as_mainfile, path, None, copy=True)
        return
    try:
        with captured_output():
            bpy.data.libraries.write(str(path.absolute()), {surfaces.scene}, path_remap="RELATIVE")
    except (OSError, RuntimeError) as error:
        raise CommandError(f"{target} could not be written: {error}") from error


def _call(operator: Any, path: Path, scene: bpy.types.Scene | None, **options: Any) -> None:
    """Call an exporter in a scene, with those options that this version of Blender knows."""
    context = {} if scene is None else {"scene": scene, "view_layer": scene.view_layers[0]}
    wanted = {"check_existing": False, "apply_modifiers": False, **options}
    known = {prop.identifier for prop in operator.get_rna_type().properties}
    try:
        with captured_output(), bpy.context.temp_override(**context):
            operator(
                filepath=str(path.absolute()), **{name: wanted[name] for name in wanted if name in known}
            )
    except RuntimeError as error:
        reason = str(error).strip().splitlines()[0].removeprefix("Error: ").rstrip(".")
        raise CommandError(f"{path.name} could not be written: Blender says ‘{reason}’.") from error
