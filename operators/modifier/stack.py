# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Framelet's modifiers on objects.

A modifier reads attributes of the mesh, so that all objects of a mesh get it, and lose it, together.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import bpy

from .inputs import input_values, refresh, set_input
from .node_groups import Recipe, kind_of, remove_unused, shared_group
from .recipes import known_recipe

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

FIRST = ("MULTIRES", "SOFT_BODY")
"""Types of modifiers that take the vertices of the mesh itself, so that Blender lets no other before them."""


def find_modifier(obj: bpy.types.Object | None, kind: str) -> bpy.types.Modifier | None:
    """Return the first modifier of a kind, a group's kind up to its first space; None if there is none."""
    return next(iter(find_modifiers(obj, kind)), None)


def find_modifiers(obj: bpy.types.Object | None, kind: str) -> list[bpy.types.Modifier]:
    """Return all modifiers of a kind: one and its copies."""
    if obj is None or obj.type != "MESH":
        return []
    return [item for item in obj.modifiers if _kind(item).partition(" ")[0] == kind]


def attach(
    obj: bpy.types.Object, recipe: Recipe, values: Mapping[str, Any] | None = None
) -> bpy.types.Modifier:
    """Give all objects of a mesh a modifier.

    One of the same kind stays where it is, with the values of its inputs, and gets the present group. A new
    one is the first of all: what is added belongs to the vertices of the mesh itself.

    Parameters
    ----------
    obj : bpy.types.Object
        A mesh object.
    recipe : Recipe
        What the modifier is.
    values : mapping, optional
        Inputs of new ones, by name.

    Returns
    -------
    bpy.types.Modifier
        That of the object.
    """
    group = shared_group(recipe)
    for each in _users(obj.data):
        modifier = find_modifier(each, recipe.kind.partition(" ")[0])
        if modifier is None:
            modifier = each.modifiers.new(recipe.label, "NODES")
            modifier.node_group = group
            each.modifiers.move(len(each.modifiers) - 1, 0)
            for name, value in (values or {}).items():
                set_input(modifier, name, value)
        elif modifier.node_group != group:
            kept = input_values(modifier)
            modifier.node_group = group
            for name in input_values(modifier).keys() & kept.keys():
                set_input(modifier, name, kept[name])
        refresh(modifier)
    remove_unused()
    found = find_modifier(obj, recipe.kind.partition(" ")[0])
    assert found is not None
    return found


def place_refusal(obj: bpy.types.Object, kind: str) -> str | None:
    """Say in one sentence why an object of the mesh has no place for a modifier of a kind; None if all do."""
    for each in _users(obj.data):
        broken = next((other for other in each.modifiers if _is_broken(other, kind)), None)
        if broken is not None:
            return (
                f"The nodes of the modifier ‘{broken.name}’ of ‘{each.name}’ lost inputs that Framelet made; "
                "remove the modifier first."
            )
        first = next((other for other in each.modifiers if other.type in FIRST), None)
        if first is not None and find_modifier(each, kind) is None:
            return (
                f"The modifier ‘{first.name}’ of ‘{each.name}’ must be the first one, so that there is no "
                "place for that of Framelet; apply or remove it first."
            )
    return None


def detach(obj: bpy.types.Object, kind: str) -> bool:
    """Take the modifiers of a kind from all objects of a mesh, and unused groups; return if there was one."""
    found = False
    for each in _users(obj.data):
        while (modifier := find_modifier(each, kind)) is not None:
            each.modifiers.remove(modifier)
            found = True
    remove_unused()
    return found


def modifiers_below(modifier: bpy.types.Modifier) -> list[bpy.types.Modifier]:
    """Return the modifiers that are evaluated before one and may change vertices or faces."""
    others = modifier.id_data.modifiers
    before = list(others)[: others.find(modifier.name)]
    return [item for item in before if item.show_viewport and item.type not in KEEPERS and not _kind(item)]


_DEFORMERS = """
    ARMATURE CAST CURVE DISPLACE HOOK LAPLACIANDEFORM LATTICE MESH_DEFORM SHRINKWRAP SIMPLE_DEFORM SMOOTH
    CORRECTIVE_SMOOTH LAPLACIANSMOOTH SURFACE_DEFORM WARP WAVE MESH_CACHE MESH_SEQUENCE_CACHE
"""
_PAINTERS = """
    DATA_TRANSFER NORMAL_EDIT WEIGHTED_NORMAL UV_PROJECT UV_WARP VERTEX_WEIGHT_EDIT VERTEX_WEIGHT_MIX
    VERTEX_WEIGHT_PROXIMITY
"""
KEEPERS = frozenset((_DEFORMERS + _PAINTERS).split())
"""Types of modifiers that keep vertices, edges and faces as they are."""


def _users(mesh: bpy.types.Mesh) -> Iterator[bpy.types.Object]:
    """Yield the objects of a mesh whose modifiers can be changed."""
    for obj in bpy.data.objects:
        if obj.data == mesh and obj.is_editable:
            yield obj


def _kind(modifier: bpy.types.Modifier) -> str:
    """Return the kind of a modifier's group; empty if it is none of Framelet's."""
    recipe = known_recipe(modifier.node_group) if modifier.type == "NODES" else None
    return "" if recipe is None else recipe.kind


def _is_broken(modifier: bpy.types.Modifier, kind: str) -> bool:
    """Tell whether a modifier was of a kind, until somebody took inputs from its nodes."""
    if modifier.type != "NODES" or _kind(modifier):
        return False
    return kind_of(modifier.node_group).partition(" ")[0] == kind
