# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Read mesh files and .blend files through Blender's own importers."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import bpy

from .blender_output import captured_output
from .file_types import BLEND, file_type
from .messages import CommandError, Messages
from .obj_order import add_unused_vertices, file_order
from .private_scene import private_scene

# OBJ files are turned by default; with these axes all three formats keep their coordinates.
AXES = {"forward_axis": "Y", "up_axis": "Z"}


@dataclass(frozen=True)
class Surfaces:
    """The mesh objects of a file."""

    objects: list[bpy.types.Object]
    scene: bpy.types.Scene | None
    """The scene that holds them and nothing else; None for those of a .blend file."""
    has_normals: bool
    """True if normals came with the file; they are gone, since they describe the noisy surface."""

    def without(self, refused: list[bpy.types.Object]) -> Surfaces:
        """Return what is exported: all of a mesh file, and of a .blend file what could be denoised."""
        if self.scene is not None:
            return self
        meshes = {obj.data for obj in refused}
        return replace(self, objects=[obj for obj in self.objects if obj.data not in meshes])


@contextmanager
def opened(path: Path, messages: Messages) -> Iterator[Surfaces]:
    """Open a file for as long as the context lasts.

    A .blend file takes the place of the session. Objects of other files live in a scene of their own and are
    removed in the end.

    Raises
    ------
    CommandError
        If the file cannot be read or holds no mesh.
    """
    if file_type(path) == BLEND:
        yield _open_blend(path)
        return
    with private_scene() as scene:
        yield _import(path, scene, messages)


def _open_blend(path: Path) -> Surfaces:
    """Open a .blend file; its scripts are not run."""
    _call(bpy.ops.wm.open_mainfile, path, load_ui=False, use_scripts=False)
    scene = bpy.context.scene
    objects = [obj for obj in scene.objects if obj.type == "MESH"]
    if not objects:
        raise CommandError(f"{path} has no mesh objects in its scene ‘{scene.name}’.")
    for obj in objects:
        # In Edit Mode only the selected vertices would be denoised.
        if obj.mode != "OBJECT":
            with bpy.context.temp_override(object=obj, active_object=obj):
                bpy.ops.object.mode_set(mode="OBJECT")
    return Surfaces(objects, None, has_normals=True)


def _import(path: Path, scene: bpy.types.Scene, messages: Messages) -> Surfaces:
    """Import a mesh file into an empty scene."""
    kind = file_type(path)
    if kind == ".obj":
        problems = _import_obj(path, scene, messages)
    elif kind == ".ply":
        problems = _call(bpy.ops.wm.ply_import, path, scene, **AXES)
    else:
        problems = _call(bpy.ops.wm.stl_import, path, scene, **AXES)
    objects = _meshes(scene)
    if not objects:
        raise CommandError(f"{path} holds no surface, or is no {kind} file.")
    if problems:
        more = f", and {len(problems) - 1} more like it" if len(problems) > 1 else ""
        messages.warn(f"Blender left out parts of {path.name}: {problems[0]}{more}")
    return Surfaces(objects, scene, _clear_normals(objects))


def _import_obj(path: Path, scene: bpy.types.Scene, messages: Messages) -> list[str]:
    """Import an OBJ file, as several objects only if no vertex is lost, doubled or moved by that."""
    has_groups = any(line.startswith((b"g ", b"g\t")) for line in path.open("rb"))
    options = {**AXES, "import_vertex_groups": has_groups}
    before = set(bpy.data.user_map())
    problems = _call(bpy.ops.wm.obj_import, path, scene, use_split_objects=True, **options)
    objects = _meshes(scene)
    order = file_order(path, objects)
    if order is not None:
        for obj in order:
            scene.collection.objects.unlink(obj)
        for obj in order:
            scene.collection.objects.link(obj)
        return problems
    if len(objects) > 1:
        bpy.data.batch_remove([data for data in bpy.data.user_map() if data not in before])
        problems = _call(bpy.ops.wm.obj_import, path, scene, use_split_objects=False, **options)
    for obj in _meshes(scene):
        n_left_out = add_unused_vertices(path, obj.data)
        if n_left_out:
            messages.warn(f"Blender left out {n_left_out} unused vertices of {path.name}.")
    return problems


def _call(operator: Any, path: Path, scene: bpy.types.Scene | None = None, **options: Any) -> list[str]:
    """Call an importer in a scene; return what it complains about.

    Raises
    ------
    CommandError
        If it fails.
    """
    context = {} if scene is None else {"scene": scene, "view_layer": scene.view_layers[0]}
    try:
        with captured_output() as output, bpy.context.temp_override(**context):
            operator(filepath=str(path.absolute()), **options)
    except RuntimeError as error:
        reason = str(error).strip().splitlines()[0].removeprefix("Error: ").rstrip(".")
        raise CommandError(f"{path} cannot be read: Blender says ‘{reason}’.") from error
    return output.problems()


def _meshes(scene: bpy.types.Scene) -> list[bpy.types.Object]:
    """Return the mesh objects of a scene."""
    return [obj for obj in scene.objects if obj.type == "MESH"]


def _clear_normals(objects: list[bpy.types.Object]) -> bool:
    """Let Blender compute the normals that came with a file; return whether there were any."""
    with_normals = [obj for obj in objects if obj.data.has_custom_normals]
    for obj in with_normals:
        with bpy.context.temp_override(object=obj, active_object=obj, mesh=obj.data):
            bpy.ops.mesh.customdata_custom_splitnormals_clear()
    return bool(with_normals)
