# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a result goes: into the mesh itself, a new shape key, a new object, or a modifier."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

from bpy.app.translations import pgettext_n as n_
from bpy.app.translations import pgettext_rpt as rpt_

from ..mesh_io import custom_normals, mesh_bridge
from ..mesh_io.shape_keys import active_key
from ..modifier import displacement
from ..modifier.multires import find_multires, finest_level, multires_refusal, reshape
from ..modifier.offsets import remove_modifier
from ..modifier.recipes import DISPLACEMENT
from ..modifier.stack import find_modifier
from ..properties.output_choices import IN_PLACE, MODIFIER, NEW_OBJECT, SHAPE_KEY

if TYPE_CHECKING:
    from collections.abc import Iterable

    import bpy
    import numpy as np
    from numpy.typing import NDArray

    from ...core import SurfaceMesh

KEY_NAME = "Denoised"
"""Name of the shape key."""

_NORMALS = {
    "KEPT": n_("clean custom normals stay as they are"),
    "RENEWED": n_("custom normals, which were those of the noisy surface, are those of the result"),
}

_KEY_NAMES = re.compile(rf"{KEY_NAME}(\.\d+)?")

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
    reason = mesh_bridge.kind_refusal(obj) or multires_refusal(obj, output)
    if reason is not None:
        return reason
    if find_multires(obj) is not None:
        return mesh_bridge.ownership_refusal(obj)
    if output == IN_PLACE:
        return mesh_bridge.refusal(obj)
    if output == MODIFIER:
        return displacement.refusal(obj)
    if output == SHAPE_KEY:
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
    """The object that has a result, the same or a new one, and the positions that were written, (N, 3).

    `note` says in words what else was done, and is empty if nothing was.
    """

    obj: bpy.types.Object
    positions: NDArray[np.float32]
    note: str = ""
    amount: float = 1.0
    """How much of the motion is shown."""


def write_output(
    obj: bpy.types.Object,
    surface: SurfaceMesh,
    vertices: NDArray[np.floating],
    output: str,
    amount: float = 1.0,
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
    amount : float
        How much of the motion is shown. A modifier or a shape key that was there keeps its own.

    Returns
    -------
    WrittenOutput
    """
    normals = custom_normals.read_normals(obj.data)
    if output == MODIFIER:
        positions = displacement.store_displacement(obj, surface, vertices, amount)
        note = _normals_note(obj.data, normals, surface, positions)
        return WrittenOutput(obj, positions, note, displacement.shown_amount(obj))
    if output == NEW_OBJECT:
        obj = _add_copy(obj)
    # What was read is the mesh without the modifier of a run before, which would move the result once more.
    note = ""
    if find_modifier(obj, DISPLACEMENT) is not None:
        remove_modifier(obj, DISPLACEMENT)
        note = rpt_("the modifier of the run before was removed")
    if output == SHAPE_KEY:
        note = _both(note, _normals_note(obj.data, normals, surface, vertices))
        return _write_key(obj, surface, vertices, amount, note)
    if amount != 1.0:
        vertices = surface.vertices + amount * (vertices.astype("float64") - surface.vertices)
    positions = mesh_bridge.write_vertices(obj, surface, vertices)
    if normals is not None:
        settled = custom_normals.settle_normals(obj.data, normals, surface, positions)
        note = _both(note, rpt_(_NORMALS[settled]) if settled else "")
    return WrittenOutput(obj, positions, note, amount)


def write_level(
    obj: bpy.types.Object,
    surface: SurfaceMesh,
    vertices: NDArray[np.floating],
    output: str,
    amount: float = 1.0,
) -> WrittenOutput:
    """Write new positions of the finest level of Multires, or to that of a new object.

    Takes what `write_output` takes. A modifier that adds to the mesh would not reach the level, so that the
    output MODIFIER is as IN_PLACE.
    """
    vertices = surface.vertices + amount * (vertices.astype("float64") - surface.vertices)
    copy = _add_copy(obj) if output == NEW_OBJECT else None
    obj = copy or obj
    try:
        reshape(obj, vertices)
    except ValueError:
        if copy is not None:
            import bpy

            bpy.data.meshes.remove(copy.data)  # and the copy with it
        raise
    note = rpt_("level {level} of Multires, the finest, was denoised")
    return WrittenOutput(obj, vertices.astype("float32"), note.format(level=finest_level(obj)), amount)


def _both(first: str, second: str) -> str:
    """Return two notes as one."""
    return "; ".join(filter(None, (first, second)))


def _normals_note(
    mesh: bpy.types.Mesh,
    normals: NDArray[np.float32] | None,
    surface: SurfaceMesh,
    vertices: NDArray[np.floating],
) -> str:
    """Say that custom normals become or stay noisy, as they follow a mesh that is not changed itself."""
    if normals is None:
        return ""
    if custom_normals.fit_better_after(normals, surface, vertices):
        return rpt_("custom normals are cleaner than the mesh; with the output In Place they stay so")
    if custom_normals.stay_noisy(mesh, normals, surface, vertices):
        return rpt_("custom normals are noisy; with the output In Place they become those of the result")
    return ""


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


def _write_key(
    obj: bpy.types.Object,
    surface: SurfaceMesh,
    vertices: NDArray[np.floating],
    amount: float,
    note: str,
) -> WrittenOutput:
    """Write the result to a shape key that is relative to the key that was read.

    What the value of a key blends in is the difference to the shape that was denoised, whatever else is
    mixed.
    So a key of a run before that is relative to the same one is replaced, with the value that it has, unless
    it is locked; all others of earlier runs are set to 0, since two results at once are too much.
    """
    notes = [note] if note else []
    base = active_key(obj)
    if base is None:
        base = obj.shape_key_add(name="Basis", from_mix=False)
    blocks = obj.data.shape_keys.key_blocks
    earlier = [key for key in blocks if _KEY_NAMES.fullmatch(key.name) and key != base]
    key = next((each for each in earlier if each.relative_key == base and not each.lock_shape), None)
    if key is None:
        key = obj.shape_key_add(name=KEY_NAME, from_mix=False)
        key.relative_key = base
        key.slider_max = max(key.slider_max, amount)
        key.value = amount
    else:
        notes.append(rpt_("the shape key ‘{name}’ was replaced").format(name=key.name))
    for other in earlier:
        if other != key and other.value:
            other.value = 0.0
            notes.append(rpt_("the shape key ‘{name}’ was set to 0").format(name=other.name))
    positions = mesh_bridge.write_key(key, surface, vertices)
    obj.active_shape_key_index = blocks.find(key.name)
    obj.data.update()
    return WrittenOutput(obj, positions, "; ".join(notes), key.value)


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
