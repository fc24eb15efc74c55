# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The node groups of Framelet's modifiers, made by code, shared by all objects, and removed with the last.

A group adds vectors that are attributes of the mesh: the sum of factor times attribute, times the mask. It
needs nothing of Framelet to be evaluated, so that files open where there is no Framelet.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import bpy

if TYPE_CHECKING:
    from collections.abc import Sequence

VERSION = 1
"""Grows with every change of what `_build` makes. Groups of other versions are left to the modifiers that
have them, which go on as they were."""

KIND = "framelet_kind"
"""The custom property of a group that says which one it is."""

MASK, INVERT, ON = "Mask", "Invert", "On"
"""Inputs that all groups have: the name of a vertex group or an attribute of numbers, empty for all vertices;
whether it counts the other way around; and whether anything is added at all."""


class Term(NamedTuple):
    """An attribute of vectors and its factor: an input by its name, with a neutral value at which the
    attribute adds nothing."""

    attribute: str
    name: str
    description: str
    neutral: float
    highest: float


class Recipe(NamedTuple):
    """What a group is: its kind, the name that people see, and what it adds."""

    kind: str
    label: str
    terms: Sequence[Term]


def shared_group(recipe: Recipe) -> bpy.types.NodeTree:
    """Return the group of a recipe, which is made if there is none of this version in the file."""
    wanted = f"{recipe.kind} {VERSION}"
    for group in bpy.data.node_groups:
        if group.library is None and group.get(KIND) == wanted and has_inputs(group, recipe):
            return group
    group = bpy.data.node_groups.new(recipe.label, "GeometryNodeTree")
    group[KIND] = wanted
    _build(group, recipe)
    return group


def kind_of(group: bpy.types.NodeTree | None) -> str:
    """Return the kind of a group, of whatever version; empty if it is none of Framelet's."""
    return "" if group is None else str(group.get(KIND, "")).rpartition(" ")[0]


def input_identifiers(recipe: Recipe) -> dict[str, str]:
    """Return by name the identifiers that Blender gives to the inputs of a recipe's group.

    Whoever renames an input does not change them.
    """
    names = [*(term.name for term in recipe.terms), MASK, INVERT, ON]
    return {name: f"Socket_{number}" for number, name in enumerate(names, 2)}  # after output and geometry


def has_inputs(group: bpy.types.NodeTree, recipe: Recipe) -> bool:
    """Tell whether a group still has all inputs of its recipe, and of the types that they had."""
    types = {MASK: "NodeSocketString", INVERT: "NodeSocketBool", ON: "NodeSocketBool"}
    found = {
        item.identifier: item.socket_type
        for item in group.interface.items_tree
        if item.item_type == "SOCKET" and item.in_out == "INPUT"
    }
    return all(
        found.get(identifier) == types.get(name, "NodeSocketFloat")
        for name, identifier in input_identifiers(recipe).items()
    )


def remove_unused() -> None:
    """Remove the groups of Framelet that nothing uses any more."""
    for group in list(bpy.data.node_groups):
        if kind_of(group) and not group.users and group.library is None:
            bpy.data.node_groups.remove(group)


def _build(group: bpy.types.NodeTree, recipe: Recipe) -> None:
    """Make the inputs and the nodes of a group."""
    group.is_modifier = True
    _add_sockets(group, recipe)
    source, target = group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")
    link = group.links.new
    total = None
    for term in recipe.terms:
        factor = source.outputs[term.name]
        if term.neutral:
            less = _node(group, "ShaderNodeMath", operation="SUBTRACT")
            link(factor, less.inputs[0])
            less.inputs[1].default_value = term.neutral
            factor = less.outputs[0]
        vectors = _node(group, "GeometryNodeInputNamedAttribute", data_type="FLOAT_VECTOR")
        vectors.inputs["Name"].default_value = term.attribute
        scaled = _scaled(group, vectors.outputs["Attribute"], factor)
        if total is not None:
            both = _node(group, "ShaderNodeVectorMath", operation="ADD")
            link(total, both.inputs[0])
            link(scaled, both.inputs[1])
            scaled = both.outputs[0]
        total = scaled
    moved = group.nodes.new("GeometryNodeSetPosition")
    link(source.outputs["Geometry"], moved.inputs["Geometry"])
    link(source.outputs[ON], moved.inputs["Selection"])
    link(_scaled(group, total, _mask(group, source)), moved.inputs["Offset"])
    link(moved.outputs["Geometry"], target.inputs["Geometry"])
    for number, node in enumerate(group.nodes):
        node.location = 220 * (number % 6), -180 * (number // 6)


def _add_sockets(group: bpy.types.NodeTree, recipe: Recipe) -> None:
    """Make what the modifier shows."""

    def add(name: str, kind: str, description: str = "", in_out: str = "INPUT") -> Any:
        return group.interface.new_socket(name, description=description, in_out=in_out, socket_type=kind)

    add("Geometry", "NodeSocketGeometry", in_out="OUTPUT")
    add("Geometry", "NodeSocketGeometry")
    for term in recipe.terms:
        factor = add(term.name, "NodeSocketFloat", term.description)
        factor.subtype = "FACTOR"
        factor.min_value, factor.max_value, factor.default_value = 0.0, term.highest, 1.0
    add(
        MASK,
        "NodeSocketString",
        "Name of a vertex group or an attribute of numbers, which says how much each vertex takes; empty for "
        "all of it",
    )
    add(INVERT, "NodeSocketBool", "Take one minus the mask")
    add(ON, "NodeSocketBool", "Whether anything is added").default_value = True


def _mask(group: bpy.types.NodeTree, source: bpy.types.Node) -> bpy.types.NodeSocket:
    """Return the share that each vertex takes: 1 where there is no attribute of the mask's name."""
    numbers = _node(group, "GeometryNodeInputNamedAttribute", data_type="FLOAT")
    group.links.new(source.outputs[MASK], numbers.inputs["Name"])
    less = _node(group, "ShaderNodeMath", operation="SUBTRACT")
    less.inputs[0].default_value = 1.0
    group.links.new(numbers.outputs["Attribute"], less.inputs[1])
    sides = _node(group, "GeometryNodeSwitch", input_type="FLOAT")
    group.links.new(source.outputs[INVERT], sides.inputs["Switch"])
    group.links.new(numbers.outputs["Attribute"], sides.inputs["False"])
    group.links.new(less.outputs[0], sides.inputs["True"])
    chosen = _node(group, "GeometryNodeSwitch", input_type="FLOAT")
    group.links.new(numbers.outputs["Exists"], chosen.inputs["Switch"])
    chosen.inputs["False"].default_value = 1.0
    group.links.new(sides.outputs[0], chosen.inputs["True"])
    return chosen.outputs[0]


def _scaled(
    group: bpy.types.NodeTree, vectors: bpy.types.NodeSocket, factor: bpy.types.NodeSocket
) -> bpy.types.NodeSocket:
    """Return vectors times a factor."""
    node = _node(group, "ShaderNodeVectorMath", operation="SCALE")
    group.links.new(vectors, node.inputs[0])
    group.links.new(factor, node.inputs["Scale"])
    return node.outputs[0]


def _node(group: bpy.types.NodeTree, kind: str, **options: str) -> bpy.types.Node:
    """Add a node with some of its properties set."""
    node = group.nodes.new(kind)
    for name, value in options.items():
        setattr(node, name, value)
    return node
