# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Names of attributes that belong to Framelet.

Vertex groups are attributes too, but Blender does not keep their names apart from those of the others: a new
attribute of the name of a group gets another name, under which nobody would find it again.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import bpy

_KINDS = (
    (re.compile(r"framelet_(low|rest|displacement|level_\d+)"), "FLOAT_VECTOR", ("POINT",)),
    (re.compile(r"framelet_L\d+_B\d+"), "FLOAT_VECTOR", ("POINT", "FACE", "EDGE")),
    (re.compile(r"framelet_L\d+_B\d+_edges"), "FLOAT_VECTOR", ("EDGE",)),
    (re.compile(r"framelet_band"), "FLOAT_COLOR", ("POINT",)),
    (re.compile(r"framelet_heat_map"), "FLOAT_COLOR", ("POINT", "CORNER")),
    (re.compile(r"framelet_(noise|noise_width|mask)"), "FLOAT", ("POINT",)),
)
"""Names of attributes, and the type and the domains of those that Framelet makes."""

OWN = re.compile(
    r"framelet_(low|rest|L\d+_B\d+(_edges)?|band|heat_map|displacement|level_\d+)|\.framelet_(original|shown)"
)
"""Numbers and masks that people may make groups of are not among them."""


def is_own(attribute: bpy.types.Attribute) -> bool:
    """Tell whether an attribute has a name of ours and is of the kind that we give it.

    What has the name only was made, or converted, by somebody else, and is not ours to remove.
    """
    return any(
        name.fullmatch(attribute.name) and attribute.data_type == data_type and attribute.domain in domains
        for name, data_type, domains in _KINDS
    )


def names_refusal(obj: bpy.types.Object) -> str | None:
    """Say in one sentence which vertex group of an object has a name of ours; None if none has."""
    for group in obj.vertex_groups:
        if OWN.fullmatch(group.name):
            return (
                f"The vertex group ‘{group.name}’ of ‘{obj.name}’ has a name that Framelet gives to its own "
                "data; rename the group."
            )
    return None


def kind_refusal(obj: bpy.types.Object, names: str) -> str | None:
    """Say in one sentence which attribute of an object only has a name of ours; None if none has.

    Parameters
    ----------
    obj : bpy.types.Object
        A mesh object.
    names : str
        A regular expression of the names that will be written.
    """
    for attribute in obj.data.attributes:
        name = attribute.name
        if is_own(attribute) or not re.fullmatch(names, name):
            continue
        for pattern, data_type, domains in _KINDS:
            if pattern.fullmatch(name):
                return (
                    f"The attribute {name} of ‘{obj.name}’ is {attribute.data_type} on {attribute.domain} "
                    f"instead of {data_type} on {' or '.join(domains)}, as Framelet makes it; rename it or "
                    "remove it."
                )
    return None


def remove_own(mesh: bpy.types.Mesh, name: str) -> None:
    """Remove an attribute of one of our names, where it is there and ours."""
    attribute = mesh.attributes.get(name)
    if attribute is not None and is_own(attribute):
        remove_attribute(mesh, name)


def remove_attribute(mesh: bpy.types.Mesh, name: str) -> None:
    """Remove an attribute, where it is there, and never a vertex group.

    Blender removes by name, and takes the vertex group if there is one of the same name.
    """
    attribute = mesh.attributes.get(name)
    if attribute is not None:
        attribute.name = f"{name} away"
        mesh.attributes.remove(attribute)
