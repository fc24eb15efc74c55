# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects whose sculpted shape is in a Multires modifier, and not in their mesh.

The finest level, which has all that was sculpted, is read as a mesh of its own, and results go back to it by
Blender's Reshape. That is exact on the finest level only: on coarser ones it smooths what it is given.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

import bpy

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


def find_multires(obj: bpy.types.Object) -> bpy.types.Modifier | None:
    """Return the Multires modifier that has levels; None without one."""
    return next((each for each in obj.modifiers if each.type == "MULTIRES" and each.total_levels), None)


def finest_level(obj: bpy.types.Object) -> int:
    """Return the finest level of Multires; 0 if that is the mesh itself."""
    modifier = find_multires(obj)
    return 0 if modifier is None else modifier.total_levels


def multires_refusal(obj: bpy.types.Object, output: str) -> str | None:
    """Say in one sentence why the finest level cannot be denoised; None if it can, or there is none.

    Parameters
    ----------
    obj : bpy.types.Object
        A mesh object.
    output : str
        One of `output_choices.OUTPUTS`.
    """
    modifier = find_multires(obj)
    if modifier is None:
        return None
    has = f"‘{obj.name}’ has a Multires modifier"
    if obj.mode != "OBJECT":
        return f"{has}, whose finest level is reached in Object Mode; switch to it, or apply the modifier."
    if modifier != obj.modifiers[0] or not modifier.show_viewport:
        return f"{has} that is not the first one or is off; move it to the top and turn it on, or apply it."
    if obj.data.shape_keys is not None:
        return f"{has} and shape keys; apply the modifier, or remove the keys."
    if output == "SHAPE_KEY":
        return f"{has}, whose levels have no shape keys; choose the output In Place or New Object."
    return None


@contextmanager
def level_object(obj: bpy.types.Object) -> Iterator[bpy.types.Object]:
    """Give an object whose mesh is the finest level of Multires, with the groups of the original.

    It has no modifiers, is in no collection, and is gone afterwards.
    """
    modifier = find_multires(obj)
    assert modifier is not None
    copy = obj.copy()
    copy.animation_data_clear()
    mesh = None
    try:
        for other in list(copy.modifiers):
            if other.type != "MULTIRES" or other.name != modifier.name:
                copy.modifiers.remove(other)
            else:
                other.levels = other.total_levels
        bpy.context.scene.collection.objects.link(copy)
        graph = bpy.context.evaluated_depsgraph_get()
        mesh = bpy.data.meshes.new_from_object(
            copy.evaluated_get(graph), preserve_all_data_layers=True, depsgraph=graph
        )
        bpy.context.scene.collection.objects.unlink(copy)
        copy.modifiers.clear()
        copy.data = mesh
        yield copy
    finally:
        bpy.data.objects.remove(copy)
        if mesh is not None:
            bpy.data.meshes.remove(mesh)


def reshape(obj: bpy.types.Object, vertices: NDArray[np.floating]) -> None:
    """Give the finest level of Multires new positions, shape (N, 3), in the space of the object.

    Raises
    ------
    ValueError
        In one sentence, if Blender does not take them.
    """
    import numpy as np

    modifier = find_multires(obj)
    assert modifier is not None
    shown = modifier.levels
    mesh = bpy.data.meshes.new(".framelet")
    source = bpy.data.objects.new(".framelet", mesh)
    try:
        mesh.vertices.add(len(vertices))
        mesh.vertices.foreach_set("co", np.ascontiguousarray(vertices, np.float32).ravel())
        bpy.context.scene.collection.objects.link(source)
        modifier.levels = modifier.total_levels
        with bpy.context.temp_override(
            object=obj,
            active_object=obj,
            selected_objects=[obj, source],
            selected_editable_objects=[obj, source],
        ):
            done = bpy.ops.object.multires_reshape(modifier=modifier.name)
    except RuntimeError as error:
        raise ValueError(f"‘{obj.name}’: its Multires modifier took no new shape: {error}") from error
    finally:
        modifier.levels = shown
        bpy.data.objects.remove(source)
        bpy.data.meshes.remove(mesh)
    if done != {"FINISHED"}:
        raise ValueError(f"‘{obj.name}’: its Multires modifier took no new shape; apply it and try again.")
