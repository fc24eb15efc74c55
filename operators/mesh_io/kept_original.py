# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The original positions of a mesh that shows a preview, kept in the mesh itself.

Undo steps and files that Blender saves by itself hold the mesh as it is shown. With the original beside it,
what comes back from them can be put right.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import bmesh
import bpy

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

ORIGINAL = ".framelet_original"
"""The attribute with the positions; names with a dot are not shown in lists."""

COUNT = "framelet_original_count"
"""The custom property with the number of vertices. Where it differs the mesh was joined, cut or subdivided,
and the attribute does not say where its vertices belong."""


def keep(mesh: bpy.types.Mesh, positions: NDArray[np.float32]) -> None:
    """Keep positions, shape (N, 3), as the original ones of a mesh in Object Mode."""
    attribute = mesh.attributes.get(ORIGINAL)
    if attribute is None:
        attribute = mesh.attributes.new(ORIGINAL, "FLOAT_VECTOR", "POINT")
    attribute.data.foreach_set("vector", positions.reshape(-1))
    mesh[COUNT] = len(positions)


def has_kept(mesh: bpy.types.Mesh) -> bool:
    """Tell whether a mesh has an original."""
    return COUNT in mesh


def forget(mesh: bpy.types.Mesh) -> None:
    """Take the original away and leave the positions as they are."""
    if mesh.is_editmode:
        edit_mesh = bmesh.from_edit_mesh(mesh)
        layer = edit_mesh.verts.layers.float_vector.get(ORIGINAL)
        if layer is not None:
            edit_mesh.verts.layers.float_vector.remove(layer)
    else:
        attribute = mesh.attributes.get(ORIGINAL)
        if attribute is not None:
            mesh.attributes.remove(attribute)
    if COUNT in mesh:
        del mesh[COUNT]


def put_back(mesh: bpy.types.Mesh) -> None:
    """Give a mesh its original positions, bit by bit, and take the copy away."""
    if mesh.is_editmode:
        _put_back_in_edit_mode(mesh)
    else:
        attribute = mesh.attributes.get(ORIGINAL)
        if attribute is not None and len(mesh.vertices) == mesh.get(COUNT):
            import numpy as np

            positions = np.empty(3 * len(mesh.vertices), np.float32)
            attribute.data.foreach_get("vector", positions)
            mesh.attributes["position"].data.foreach_set("vector", positions)
    forget(mesh)
    mesh.update()


def _put_back_in_edit_mode(mesh: bpy.types.Mesh) -> None:
    """Give the edit session of a mesh its original positions."""
    edit_mesh = bmesh.from_edit_mesh(mesh)
    layer = edit_mesh.verts.layers.float_vector.get(ORIGINAL)
    if layer is None or len(edit_mesh.verts) != mesh.get(COUNT):
        return
    # An edit session has no arrays. This is rare: Edit Mode was entered while a preview was shown.
    for vert in edit_mesh.verts:
        vert.co = vert[layer]
    edit_mesh.normal_update()
    bmesh.update_edit_mesh(mesh, loop_triangles=True, destructive=False)


def put_all_back(shown_uid: int = 0) -> None:
    """Put back all meshes that came with an original from an undo step or a file.

    Parameters
    ----------
    shown_uid : int
        The `session_uid` of the mesh that shows a preview now, which is left as it is.
    """
    for mesh in bpy.data.meshes:
        if has_kept(mesh) and mesh.is_editable and mesh.session_uid != shown_uid:
            put_back(mesh)
