# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Vectors and numbers at the vertices of a mesh, also in Edit Mode, and to which mesh they belong."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bmesh

from ..mesh_io import mesh_bridge
from ..mesh_io.band_storage import topology_fingerprint
from ..mesh_io.own_names import is_own, remove_own
from ..mesh_io.typed_attributes import typed_attribute

if TYPE_CHECKING:
    from collections.abc import Iterable

    import bpy
    import numpy as np
    from numpy.typing import NDArray

    from ...core import SurfaceMesh

_DTYPES = {"FLOAT": "float32", "INT": "int32", "BOOLEAN": "bool"}

CAGE = "framelet_cage"
"""The custom property with fingerprints of the mesh to which the vectors belong."""


def write_vectors(mesh: bpy.types.Mesh, name: str, vectors: NDArray[np.floating]) -> None:
    """Write vectors, shape (N, 3); `own_names.names_refusal` gives no reason against the name."""
    import numpy as np

    vectors = np.ascontiguousarray(vectors, np.float32)
    if mesh.is_editmode:
        edit_mesh = bmesh.from_edit_mesh(mesh)
        layers = edit_mesh.verts.layers.float_vector
        layer = layers.get(name) or layers.new(name)
        # An edit session has no arrays.
        for vert, vector in zip(edit_mesh.verts, vectors.tolist(), strict=True):
            vert[layer] = vector
        bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)
        return
    attribute = mesh.attributes.get(name) or mesh.attributes.new(name, "FLOAT_VECTOR", "POINT")
    attribute.data.foreach_set("vector", vectors.reshape(-1))
    mesh.update()


def read_vectors(mesh: bpy.types.Mesh, name: str) -> NDArray[np.float32]:
    """Read vectors, shape (N, 3); zeros where there is no such attribute."""
    import numpy as np

    if mesh.is_editmode:
        edit_mesh = bmesh.from_edit_mesh(mesh)
        layer = edit_mesh.verts.layers.float_vector.get(name)
        if layer is None:
            return np.zeros((len(edit_mesh.verts), 3), np.float32)
        return np.array([vert[layer][:] for vert in edit_mesh.verts], np.float32).reshape(-1, 3)
    vectors = np.zeros((len(mesh.vertices), 3), np.float32)
    attribute = typed_attribute(mesh, name, "FLOAT_VECTOR", "POINT")
    if attribute is not None:
        attribute.data.foreach_get("vector", vectors.reshape(-1))
    return vectors


def read_numbers(obj: bpy.types.Object, name: str) -> NDArray[np.float32]:
    """Read an attribute of numbers at the vertices of an object's mesh, shape (N,)."""
    import numpy as np

    with mesh_bridge.readable_mesh(obj) as mesh:
        attribute = mesh.attributes[name]
        values = np.empty(len(mesh.vertices), _DTYPES[attribute.data_type])
        attribute.data.foreach_get("value", values)
    return values.astype(np.float32)


def write_numbers(mesh: bpy.types.Mesh, name: str, numbers: NDArray[np.floating]) -> None:
    """Write numbers, shape (N,), in Object Mode; `own_names.kind_refusal` gives no reason against it."""
    import numpy as np

    attribute = mesh.attributes.get(name) or mesh.attributes.new(name, "FLOAT", "POINT")
    attribute.data.foreach_set("value", np.ascontiguousarray(numbers, np.float32))
    mesh.update()


def remove_attributes(mesh: bpy.types.Mesh, names: Iterable[str]) -> None:
    """Remove attributes of vertices by name, where they are there and ours."""
    if mesh.is_editmode:
        verts = bmesh.from_edit_mesh(mesh).verts
        for layers in (verts.layers.float_vector, verts.layers.float):
            for name in names:
                if name in layers and is_own(mesh.attributes[name]):
                    layers.remove(layers[name])
        return
    for name in names:
        remove_own(mesh, name)
    mesh.update()


def mark_cage(mesh: bpy.types.Mesh, surface: SurfaceMesh) -> None:
    """Keep by what to recognize the mesh to which vectors belong."""
    mesh[CAGE] = _marks(surface)


def unmark_cage(mesh: bpy.types.Mesh) -> None:
    """Take that away."""
    if CAGE in mesh:
        del mesh[CAGE]


def cage_change(mesh: bpy.types.Mesh, surface: SurfaceMesh) -> str:
    """Tell what differs from the mesh to which vectors belong: FACES, POSITIONS, or empty for nothing."""
    kept = mesh.get(CAGE)
    if kept is None:
        return ""
    marks = str(kept).split()
    if len(marks) != 2:
        return "FACES"  # somebody altered them
    faces, positions = marks
    now_faces, now_positions = _marks(surface).split()
    if faces != now_faces:
        return "FACES"
    return "" if positions == now_positions else "POSITIONS"


def _marks(surface: SurfaceMesh) -> str:
    """Return fingerprints of faces and positions."""
    from ..mesh_io.band_storage import position_fingerprint

    return f"{topology_fingerprint(surface)} {position_fingerprint(surface.vertices)}"
