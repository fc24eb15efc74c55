# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Face sets, which Sculpt Mode shows by colors, as numbers.

Which of them is active Blender tells no script: it is the one under the mouse when a brush begins. So the one
to work on is set by its number, or picked in the view.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from .typed_attributes import typed_attribute, typed_values

if TYPE_CHECKING:
    import bpy
    import numpy as np
    from mathutils import Vector
    from numpy.typing import NDArray

    from ...core import SurfaceMesh

FACE_SET = ".sculpt_face_set"
"""Blender's name of the attribute, which a mesh without face sets does not have."""

DEFAULT = 1
"""The set of all faces of such a mesh."""


def read_face_sets(mesh: bpy.types.Mesh) -> NDArray[np.int32]:
    """Return the number of the face set of each face, shape (F,)."""
    import numpy as np

    if typed_attribute(mesh, FACE_SET, "INT", "FACE") is None:
        return np.full(len(mesh.polygons), DEFAULT, np.int32)
    return typed_values(mesh, FACE_SET, "INT", "FACE")


def vertices_of_face_set(
    obj: bpy.types.Object, mesh: bpy.types.Mesh, surface: SurfaceMesh, number: int
) -> NDArray[np.bool_]:
    """Return the vertices of a face set, those on its border included, as brushes take them, shape (N,).

    Parameters
    ----------
    obj : bpy.types.Object
        Whose name errors give.
    mesh : bpy.types.Mesh
        Where the sets are read.
    surface : SurfaceMesh
        Its faces.
    number : int
        The number of the set.

    Raises
    ------
    ValueError
        In one sentence, if no face is in this set.
    """
    import numpy as np

    numbers = read_face_sets(mesh)
    is_own = numbers == number
    if not is_own.any():
        known = np.unique(numbers)
        shown = ", ".join(map(str, known[:8].tolist())) + (", ..." if len(known) > 8 else "")
        raise ValueError(
            f"‘{obj.name}’ has no face set {number}; pick one in the view, or choose one of {shown}."
        )
    inside = np.zeros(surface.n_vertices, bool)
    inside[surface.corner_vertex[np.repeat(is_own, np.diff(surface.face_offset))]] = True
    return inside


def face_set_under(
    obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph, origin: Vector, direction: Vector
) -> int | None:
    """Return the number of the face set that a ray meets first on an object; None where it meets none.

    `origin` and `direction` are in the space of the scene.
    """
    seen = obj.evaluated_get(depsgraph)
    to_object = obj.matrix_world.inverted_safe()
    hit, _, _, face = seen.ray_cast(to_object @ origin, to_object.to_3x3() @ direction)
    if not hit:
        return None
    attribute = seen.data.attributes.get(FACE_SET)
    return DEFAULT if attribute is None else attribute.data[face].value
