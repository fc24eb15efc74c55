# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What Framelet's modifiers add to the vertices of an object now, and the ways to end them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..mesh_io import custom_normals, mesh_bridge
from ..mesh_io.own_names import is_own
from . import attributes
from .inputs import get_input
from .node_groups import INVERT, MASK, ON
from .recipes import DISPLACEMENT, EQUALIZER, OURS, recipe_of
from .stack import detach, find_modifier, find_modifiers

if TYPE_CHECKING:
    import bpy
    import numpy as np
    from numpy.typing import NDArray

KINDS = (DISPLACEMENT, EQUALIZER)


def has_modifier(obj: bpy.types.Object | None) -> bool:
    """Tell whether an object has one of Framelet's modifiers."""
    return any(find_modifier(obj, kind) for kind in KINDS)


def has_traces(mesh: bpy.types.Mesh) -> bool:
    """Tell whether a mesh has attributes of Framelet's modifiers."""
    return attributes.CAGE in mesh or any(
        OURS.fullmatch(item.name) and is_own(item) for item in mesh.attributes
    )


def offset_of(obj: bpy.types.Object, kind: str) -> NDArray[np.float32] | None:
    """Return what a modifier and its copies add to the vertices of an object now, (N, 3); None without one.

    Raises
    ------
    ValueError
        With a sentence that names the object, if the mask is of a kind that cannot be read, or if anything is
        not finite.
    """
    import numpy as np

    total: NDArray[np.float32] | None = None
    for modifier in find_modifiers(obj, kind):
        with np.errstate(invalid="ignore", over="ignore"):
            offset = _offset(obj, modifier)
            total = offset if total is None else total + offset
        if not np.isfinite(total).all():
            raise ValueError(
                f"The modifier ‘{modifier.name}’ of ‘{obj.name}’ moves vertices by what is not a finite "
                "number; look at its values and its mask, or run it again."
            )
    return total


def _offset(obj: bpy.types.Object, modifier: bpy.types.Modifier) -> NDArray[np.float32]:
    """Return what a modifier of ours adds to the vertices of its object, shape (N, 3)."""
    import numpy as np

    total: NDArray[np.float32] | None = None
    for term in recipe_of(modifier).terms:
        factor = np.float32(get_input(modifier, term.name)) - np.float32(term.neutral)
        part = attributes.read_vectors(obj.data, term.attribute) * factor
        total = part if total is None else total + part
    assert total is not None
    if not get_input(modifier, ON):
        return np.zeros_like(total)
    mask = _mask(obj, get_input(modifier, MASK))
    if mask is None:
        return total
    return total * (np.float32(1.0) - mask if get_input(modifier, INVERT) else mask)[:, None]


def apply_modifier(obj: bpy.types.Object, kind: str) -> None:
    """Move the vertices of a mesh to where a modifier shows them, and remove the modifier.

    With shape keys the active key is moved, and those that depend on it.

    Raises
    ------
    ValueError
        With a sentence that names the object. Everything is as it was.
    """
    import numpy as np

    reason = mesh_bridge.refusal(obj) or _missing(obj, kind)
    if reason is not None:
        raise ValueError(reason)
    offset = offset_of(obj, kind)
    assert offset is not None  # `_missing` has looked
    surface = mesh_bridge.read_surface(obj)
    normals = custom_normals.read_normals(obj.data)
    with np.errstate(over="ignore"):
        moved = surface.vertices + offset
    if (np.isinf(moved) & np.isfinite(surface.vertices)).any():
        raise ValueError(
            f"The modifiers of ‘{obj.name}’ move vertices beyond the largest number; look at their values."
        )
    positions = mesh_bridge.write_vertices(obj, surface, moved)
    if normals is not None:
        custom_normals.settle_normals(obj.data, normals, surface, positions)
    remove_modifier(obj, kind)


def remove_modifier(obj: bpy.types.Object, kind: str) -> None:
    """Remove a modifier from all objects of a mesh, and its attributes: the mesh is as it was.

    Raises
    ------
    ValueError
        With a sentence that names the object, if its mesh cannot be written to.
    """
    reason = mesh_bridge.ownership_refusal(obj) or _missing(obj, kind)
    if reason is not None:
        raise ValueError(reason)
    modifier = find_modifier(obj, kind)
    assert modifier is not None  # `_missing` has looked
    names = [term.attribute for term in recipe_of(modifier).terms]
    detach(obj, kind)
    attributes.remove_attributes(obj.data, names)
    if not has_modifier(obj):
        attributes.unmark_cage(obj.data)


def remove_all(obj: bpy.types.Object) -> None:
    """Remove all modifiers of Framelet and all attributes of theirs, also those whose modifier is gone."""
    for kind in KINDS:
        detach(obj, kind)
    names = [item.name for item in obj.data.attributes if OURS.fullmatch(item.name)]
    attributes.remove_attributes(obj.data, names)
    attributes.unmark_cage(obj.data)


def _missing(obj: bpy.types.Object, kind: str) -> str | None:
    """Say in one sentence that an object has no modifier of a kind; None if it has."""
    if find_modifier(obj, kind) is not None:
        return None
    return f"‘{obj.name}’ has no modifier of Framelet; denoise it with the output Modifier first."


def _mask(obj: bpy.types.Object, name: str) -> NDArray[np.float32] | None:
    """Return the mask of a name, shape (N,); None where the name stands for nothing, as in the nodes."""
    import numpy as np

    if name in obj.vertex_groups:
        return mesh_bridge.read_weights(obj, name).astype(np.float32)
    attribute = obj.data.attributes.get(name) if name else None
    if attribute is None:
        return None
    if attribute.domain != "POINT" or attribute.data_type not in {"FLOAT", "INT", "BOOLEAN"}:
        raise ValueError(
            f"The mask ‘{name}’ of ‘{obj.name}’ is not numbers at the vertices; choose a vertex group or an "
            "attribute that is."
        )
    return attributes.read_numbers(obj, name)
