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

OWN = re.compile(
    r"framelet_(low|rest|L\d+_B\d+(_edges)?|band|heat_map|displacement|level_\d+)|\.framelet_(original|shown)"
)
"""Numbers and masks that people may make groups of are not among them."""


def names_refusal(obj: bpy.types.Object) -> str | None:
    """Say in one sentence which vertex group of an object has a name of ours; None if none has."""
    for group in obj.vertex_groups:
        if OWN.fullmatch(group.name):
            return (
                f"The vertex group ‘{group.name}’ of ‘{obj.name}’ has a name that Framelet gives to its own "
                "data; rename the group."
            )
    return None


def remove_attribute(mesh: bpy.types.Mesh, name: str) -> None:
    """Remove an attribute, where it is there, and never a vertex group.

    Blender removes by name, and takes the vertex group if there is one of the same name.
    """
    attribute = mesh.attributes.get(name)
    if attribute is not None:
        attribute.name = f"{name} away"
        mesh.attributes.remove(attribute)
