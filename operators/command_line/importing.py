# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Read files through Blender's own importers, into a Blender that holds nothing else."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bpy
import numpy as np

from ..mesh_io.mesh_bridge import read_surface
from .file_types import BLEND, file_type
from .file_work import warn_of_coarseness
from .messages import CommandError, Messages

# OBJ files are turned by default; with these axes the formats keep their coordinates.
AXES = {"forward_axis": "Y", "up_axis": "Z"}

# The first that this version of Blender has is used.
_IMPORTERS: dict[str, tuple[tuple[str, dict[str, Any]], ...]] = {
    ".ply": (("wm.ply_import", AXES),),
    ".obj": (("wm.obj_import", {**AXES, "use_split_objects": True}),),
    ".stl": (("wm.stl_import", AXES),),
    ".glb": (("import_scene.gltf", {}),),
    ".gltf": (("import_scene.gltf", {}),),
    ".fbx": (("wm.fbx_import", {}), ("import_scene.fbx", {})),
    ".abc": (("wm.alembic_import", {"as_background_job": False}),),
    ".usd": (("wm.usd_import", {}),),
}


def open_source(path: Path, messages: Messages) -> list[bpy.types.Object]:
    """Open a file, and return its mesh objects in the order of the scene.

    Parameters
    ----------
    path : Path
        The file; its scripts are not run.
    messages : Messages
        Takes warnings about coordinates that single precision cannot hold well.

    Raises
    ------
    CommandError
        If the file cannot be read or holds no mesh.
    """
    kind = file_type(path)
    if kind == BLEND:
        call("wm.open_mainfile", path, load_ui=False, use_scripts=False)
    else:
        for name, options in _IMPORTERS[".usd" if kind.startswith(".usd") else kind]:
            if exists(name):
                call(name, path, **options)
                break
    scene = bpy.context.scene
    objects = [obj for obj in scene.objects if obj.type == "MESH"]
    if not objects:
        raise CommandError(f"{path} has no mesh objects in its scene ‘{scene.name}’.")
    for obj in objects:
        # In Edit Mode only the selected vertices would be denoised.
        if obj.mode != "OBJECT":
            with bpy.context.temp_override(object=obj, active_object=obj):
                bpy.ops.object.mode_set(mode="OBJECT")
        _check_indices(path, obj)
        if len(obj.data.polygons):
            warn_of_coarseness(path, obj.name, read_surface(obj), messages)
    return objects


def exists(name: str) -> bool:
    """Return whether this version of Blender has an operator."""
    group, _dot, own = name.partition(".")
    return own in dir(getattr(bpy.ops, group))


def call(name: str, path: Path, **options: Any) -> None:
    """Call an importer or exporter with those options that this version of Blender knows.

    Raises
    ------
    CommandError
        If it fails.
    """
    group, _dot, own = name.partition(".")
    operator = getattr(getattr(bpy.ops, group), own)
    known = {prop.identifier for prop in operator.get_rna_type().properties}
    try:
        operator(filepath=str(path.absolute()), **{key: options[key] for key in options if key in known})
    except RuntimeError as error:
        reason = str(error).strip().splitlines()[0].removeprefix("Error: ").rstrip(".")
        what = "written" if "export" in name or "save" in name else "read"
        raise CommandError(f"{path.name} cannot be {what}: Blender says ‘{reason}’.") from error


def _check_indices(path: Path, obj: bpy.types.Object) -> None:
    """Raise CommandError if faces name vertices or edges that do not exist, as in a damaged file."""
    mesh = obj.data
    for name, limit in ((".corner_vert", len(mesh.vertices)), (".corner_edge", len(mesh.edges))):
        attribute = mesh.attributes.get(name)
        values = np.zeros(len(mesh.loops), np.int32)
        if attribute is not None and len(values):
            attribute.data.foreach_get("value", values)
        if len(values) and (values.min() < 0 or values.max() >= limit):
            raise CommandError(
                f"The faces of ‘{obj.name}’ in {path} name what does not exist; the file is damaged."
            )
    ends = np.zeros((len(mesh.edges), 2), np.int32)
    if len(ends):
        mesh.attributes[".edge_verts"].data.foreach_get("value", ends.reshape(-1))
        if ends.min() < 0 or ends.max() >= len(mesh.vertices):
            raise CommandError(
                f"The edges of ‘{obj.name}’ in {path} name what does not exist; the file is damaged."
            )
