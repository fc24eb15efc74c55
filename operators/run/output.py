# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a result goes: into the mesh itself, a new shape key, or a new object."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from ..mesh_io import mesh_bridge
from ..properties.output_choices import IN_PLACE, NEW_OBJECT, SHAPE_KEY

if TYPE_CHECKING:
    from collections.abc import Iterable

    import bpy
    import numpy as np
    from numpy.typing import NDArray

    from ...core import SurfaceMesh

KEY_NAME = "Denoised"
"""Name of the shape key."""

SUFFIX = ".denoised"
"""What is added to the name of a new object."""


def refusal(obj: bpy.types.Object, output: str) -> str | None:
    """Say in one sentence why a result cannot go there; None if it can.

    Parameters
    ----------
    obj : bpy.types.Object
        The object that will be denoised.
    output : str
        One of `output_choices.OUTPUTS`.
    """
    if output == IN_PLACE:
        return mesh_bridge.refusal(obj)
    reason = mesh_bridge.kind_refusal(obj)
    if reason is None and output == SHAPE_KEY:
        reason = mesh_bridge.ownership_refusal(obj)
    if reason is not None:
        return reason
    name = f"‘{obj.name}’"
    if obj.mode != "OBJECT":
        what = "A shape key is added" if output == SHAPE_KEY else "A new object is made"
        return f"{name}: {what} in Object Mode only; leave the mode or set Output to In Place."
    if output == SHAPE_KEY and obj.data.shape_keys and not obj.data.shape_keys.use_relative:
        return f"The shape keys of {name} are not relative; turn on Relative or choose another output."
    return mesh_bridge.faces_refusal(obj)


class WrittenOutput(NamedTuple):
    """The object that has a result, the same or a new one, and the positions that were written, (N, 3)."""

    obj: bpy.types.Object
    positions: NDArray[np.float32]


def write_output(
    obj: bpy.types.Object, surface: SurfaceMesh, vertices: NDArray[np.floating], output: str
) -> WrittenOutput:
    """Write new positions of the vertices of an object.

    Parameters
    ----------
    obj : bpy.types.Object
        The object that was read; `refusal` gives no reason against it.
    surface : SurfaceMesh
        The mesh as it was read.
    vertices : ndarray, shape (N, 3)
        New positions in object space.
    output : str
        One of `output_choices.OUTPUTS`.

    Returns
    -------
    WrittenOutput
    """
    if output == SHAPE_KEY:
        return WrittenOutput(obj, _add_key(obj, surface, vertices))
    if output == NEW_OBJECT:
        obj = _add_copy(obj)
    return WrittenOutput(obj, mesh_bridge.write_vertices(obj, surface, vertices))


def select_instead(
    view_layer: bpy.types.ViewLayer, pairs: Iterable[tuple[bpy.types.Object, bpy.types.Object]]
) -> None:
    """Select new objects in the place of those that they are copies of, as duplicating does.

    Parameters
    ----------
    view_layer : bpy.types.ViewLayer
        Where objects are selected; new ones that it does not show are left out.
    pairs : iterable of (original, new)
        What is the same object twice is left as it is.
    """
    active = view_layer.objects.active
    for original, new in pairs:
        if new == original or view_layer.objects.get(new.name) != new:
            continue
        if view_layer.objects.get(original.name) == original:
            original.select_set(False, view_layer=view_layer)
        new.select_set(True, view_layer=view_layer)
        if original == active:
            view_layer.objects.active = new


def _add_key(
    obj: bpy.types.Object, surface: SurfaceMesh, vertices: NDArray[np.floating]
) -> NDArray[np.float32]:
    """Add a shape key with the result, relative to the key that was read, and return its positions."""
    base = mesh_bridge.active_key(obj)
    if base is None:
        base = obj.shape_key_add(name="Basis", from_mix=False)
    key = obj.shape_key_add(name=KEY_NAME, from_mix=False)
    # What the value blends in is the difference to the shape that was denoised, whatever else is mixed.
    key.relative_key = base
    key.value = 1.0
    positions = mesh_bridge.write_key(key, surface, vertices)
    obj.active_shape_key_index = len(obj.data.shape_keys.key_blocks) - 1
    obj.data.update()
    return positions


def _add_copy(obj: bpy.types.Object) -> bpy.types.Object:
    """Return a copy of an object with a mesh of its own, in the same collections."""
    import bpy

    new = obj.copy()
    new.data = obj.data.copy()
    new.name = f"{obj.name}{SUFFIX}"
    new.data.name = f"{obj.data.name}{SUFFIX}"
    collections = [each for each in obj.users_collection if each.library is None]
    for collection in collections or [bpy.context.scene.collection]:
        collection.objects.link(new)
    return new
