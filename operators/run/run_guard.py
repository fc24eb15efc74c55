# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether an object is still what was read from it, as it may change while a run computes.

No reference to Blender's data is kept, since undo and deleting make it invalid.
"""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING, NamedTuple

import bpy

from ..mesh_io import mesh_bridge
from ..mesh_io.shape_keys import active_key
from ..modifier.multires import finest_level, level_object

if TYPE_CHECKING:
    from ...core import SurfaceMesh


class Mark(NamedTuple):
    """What an object is recognized by."""

    name: str
    object_uid: int
    mesh_uid: int
    mode: str
    key_name: str
    """The active shape key; empty without one."""
    level: int
    """The finest level of Multires; 0 for the mesh itself."""


def mark_of(obj: bpy.types.Object) -> Mark:
    """Return what to recognize an object by."""
    key = active_key(obj)
    key_name = "" if key is None else key.name
    return Mark(obj.name, obj.session_uid, obj.data.session_uid, obj.mode, key_name, finest_level(obj))


def find_object(mark: Mark) -> bpy.types.Object | None:
    """Return the object, also if it was renamed; None if it is gone."""
    obj = bpy.data.objects.get(mark.name)
    if obj is not None and obj.session_uid == mark.object_uid:
        return obj
    return next((each for each in bpy.data.objects if each.session_uid == mark.object_uid), None)


def find_mesh(mark: Mark) -> bpy.types.Mesh | None:
    """Return the mesh, also if no object has it any more; None if it is gone."""
    return next((each for each in bpy.data.meshes if each.session_uid == mark.mesh_uid), None)


def what_changed(mark: Mark, surface: SurfaceMesh, *, in_detail: bool = False) -> str | None:
    """Say what happened to an object, as in “‘Cube’ was deleted”; None if it is as it was.

    Parameters
    ----------
    mark : Mark
        From `mark_of`, when the mesh was read.
    surface : SurfaceMesh
        The mesh as it was read.
    in_detail : bool
        Compare all positions and faces too, which takes some hundredths of a second for a million vertices;
        otherwise only what is found at once.
    """
    name = f"‘{mark.name}’"
    obj = find_object(mark)
    if obj is None:
        return f"{name} was deleted"
    if obj.data is None or obj.data.session_uid != mark.mesh_uid:
        return f"{name} got another mesh"
    if obj.mode != mark.mode:
        return f"The mode of {name} was changed"
    key = active_key(obj)
    if mark.key_name != ("" if key is None else key.name):
        return f"Another shape key of {name} became active"
    if mark.level != finest_level(obj):
        return f"The levels of {name} are others"
    if mark.level:
        return f"{name} was sculpted" if in_detail and not _is_same_level(obj, surface) else None
    if not mesh_bridge.has_counts_of(obj, surface) or (in_detail and not _is_same_mesh(obj, surface)):
        return f"The mesh of {name} was edited"
    return None


def _is_same_level(obj: bpy.types.Object, surface: SurfaceMesh) -> bool:
    """Tell whether the finest level of Multires has the values that were read."""
    with level_object(obj) as level:
        return _is_same_mesh(level, surface)


def _is_same_mesh(obj: bpy.types.Object, surface: SurfaceMesh) -> bool:
    """Tell whether all arrays of a mesh have the values that were read."""
    import numpy as np

    now = mesh_bridge.read_surface(obj)
    return all(
        np.array_equal(getattr(now, item.name), getattr(surface, item.name), equal_nan=True)
        for item in fields(surface)
    )
