# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Attributes by name and by kind: one that only has the name is somebody else's, and is not read.

Nodes and scripts may give any name to numbers of any type, those of Blender's own attributes included.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import bpy
    import numpy as np
    from numpy.typing import NDArray

_DTYPES = {"FLOAT": "float32", "INT": "int32", "BOOLEAN": "bool"}


def typed_attribute(
    mesh: bpy.types.Mesh, name: str, data_type: str, domain: str
) -> bpy.types.Attribute | None:
    """Return the attribute of a name, if it is of this type and on this domain; None otherwise."""
    attribute = mesh.attributes.get(name)
    if attribute is None or (attribute.data_type, attribute.domain) != (data_type, domain):
        return None
    return attribute


def typed_values(mesh: bpy.types.Mesh, name: str, data_type: str, domain: str) -> NDArray[Any]:
    """Return the numbers of an attribute of a mesh that is not in Edit Mode.

    Parameters
    ----------
    mesh : bpy.types.Mesh
        The mesh.
    name : str
        The name of the attribute.
    data_type : str
        FLOAT, INT or BOOLEAN.
    domain : str
        POINT, EDGE or FACE.

    Returns
    -------
    ndarray, shape (elements of the domain,)
        All false or 0 where there is no such attribute: Blender leaves its own away then.
    """
    import numpy as np

    elements = {"POINT": mesh.vertices, "EDGE": mesh.edges, "FACE": mesh.polygons}[domain]
    values = np.zeros(len(elements), _DTYPES[data_type])
    attribute = typed_attribute(mesh, name, data_type, domain)
    if attribute is not None:
        attribute.data.foreach_get("value", values)
    return values


def truth_values(mesh: bpy.types.Mesh, name: str, domain: str = "POINT") -> NDArray[np.bool_]:
    """Return the truth values of an attribute, as `typed_values` does."""
    return typed_values(mesh, name, "BOOLEAN", domain)
