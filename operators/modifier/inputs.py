# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The inputs of Framelet's Geometry Nodes modifiers by their names, in all versions of Blender.

Up to Blender 5.1 an input is a custom property of the modifier, afterwards a property of its own.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .node_groups import input_identifiers
from .recipes import recipe_of

if TYPE_CHECKING:
    import bpy


def input_names(modifier: bpy.types.Modifier) -> list[str]:
    """Return the names of the inputs with values, in the order of the group."""
    return list(input_identifiers(recipe_of(modifier)))


def get_input(modifier: bpy.types.Modifier, name: str) -> Any:
    """Return the value of an input."""
    owner, key = input_property(modifier, name)
    return getattr(owner, key) if owner is not modifier else owner[key[2:-2]]


def set_input(modifier: bpy.types.Modifier, name: str, value: Any) -> None:
    """Set the value of an input."""
    owner, key = input_property(modifier, name)
    if owner is modifier:
        owner[key[2:-2]] = value
    else:
        setattr(owner, key, value)
    refresh(modifier)


def refresh(modifier: bpy.types.Modifier) -> None:
    """Have the object of a modifier evaluated, and drawn in all 3D Views.

    Inputs do not do so when Python sets them, and tagging the object draws nothing; other properties of the
    modifier do both, whatever they are set to.
    """
    modifier.show_viewport = modifier.show_viewport


def input_property(modifier: bpy.types.Modifier, name: str) -> tuple[Any, str]:
    """Return owner and name of the property behind an input, as `layout.prop` takes them.

    The path of keyframes and drivers begins with `owner.path_from_id()`, and goes on with the name.
    """
    identifier = input_identifiers(recipe_of(modifier))[name]
    if hasattr(modifier, "properties"):
        return getattr(modifier.properties.inputs, identifier), "value"
    return modifier, f'["{identifier}"]'


def input_values(modifier: bpy.types.Modifier) -> dict[str, Any]:
    """Return the values of all inputs, by name."""
    return {name: get_input(modifier, name) for name in input_names(modifier)}
