# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender meshes as arrays and back.

With `band_storage`, `shape_keys` and `kept_original` this is all that touches mesh data. What
limits a run to parts of a mesh is read through it by `region_bridge`.

In Object Mode the arrays come from the mesh, in Edit Mode from the BMesh of the edit session. With shape keys
the active key is what is read and edited, as in Blender's own Edit Mode. Nothing but positions is written.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

import bmesh
import bpy

from ..shortage import reserve_for_reading
from .own_names import names_refusal
from .shape_keys import active_key, dependent_keys, read_key_points, write_key_points, write_positions
from .typed_attributes import truth_values

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from ...core import SurfaceMesh


MODES = frozenset({"OBJECT", "EDIT", "SCULPT", "VERTEX_PAINT", "WEIGHT_PAINT", "TEXTURE_PAINT"})
"""Modes of objects in which Framelet reads and writes their meshes."""


def kind_refusal(obj: bpy.types.Object | None) -> str | None:
    """Say in one sentence why an object has no mesh; None if it has one."""
    if obj is None:
        return "There is no active object; select a mesh object."
    if obj.type != "MESH":
        return (
            f"‘{obj.name}’ is not a mesh; select mesh objects, or convert it first (Object > Convert > Mesh)."
        )
    return None


def ownership_refusal(obj: bpy.types.Object | None) -> str | None:
    """Say in one sentence why nothing can be written to the mesh of an object; None if it can be."""
    reason = kind_refusal(obj)
    if obj is None or reason is not None:
        return reason
    name, mesh = f"‘{obj.name}’", obj.data
    if mesh.library is not None:
        return (
            f"{name} uses a mesh linked from {mesh.library.filepath}; "
            "make it local first (Object > Relations > Make Local)."
        )
    if mesh.override_library is not None or not mesh.is_editable:
        return (
            f"{name} uses a mesh that is a library override; "
            "make it local first (Object > Relations > Make Local)."
        )
    return None


def mode_refusal(obj: bpy.types.Object) -> str | None:
    """Say in one sentence why the mesh of an object cannot be edited in its mode; None if it can be."""
    if obj.mode not in MODES:
        return f"‘{obj.name}’ is in another mode; switch to Object Mode, Edit Mode or Sculpt Mode."
    if obj.mode == "SCULPT" and obj.use_dynamic_topology_sculpting:
        # The mesh then is in a session that no script can read.
        return f"‘{obj.name}’ is sculpted with Dyntopo; turn it off, or switch to Object Mode."
    return None


def faces_refusal(obj: bpy.types.Object) -> str | None:
    """Say in one sentence that a mesh has no faces; None if it has."""
    mesh = obj.data
    n_faces = len(bmesh.from_edit_mesh(mesh).faces) if mesh.is_editmode else len(mesh.polygons)
    return None if n_faces else f"‘{obj.name}’ has no faces; Framelet works on surfaces."


def refusal(obj: bpy.types.Object | None) -> str | None:
    """Say in one sentence why the mesh of an object cannot be edited; None if it can be."""
    reason = ownership_refusal(obj)
    if obj is None or reason is not None:
        return reason
    name = f"‘{obj.name}’"
    reason = mode_refusal(obj)
    if reason is not None:
        return reason
    key = obj.active_shape_key
    if key is not None and key.lock_shape:
        return f"The active shape key ‘{key.name}’ of {name} is locked; unlock it or choose another one."
    return names_refusal(obj) or faces_refusal(obj)


def read_surface(obj: bpy.types.Object) -> SurfaceMesh:
    """Return the mesh of an object as arrays, with the positions of its active shape key.

    Parameters
    ----------
    obj : bpy.types.Object
        A mesh object; in Edit Mode the state of the edit session is read.

    Returns
    -------
    SurfaceMesh
        Copies of the arrays, positions in object space as float32; modifiers are not applied.
    """
    return read_surface_and_movable(obj)[0]


def read_surface_and_movable(obj: bpy.types.Object) -> tuple[SurfaceMesh, NDArray[np.bool_] | None]:
    """Return the mesh as arrays and, in Edit Mode, which vertices may move.

    Returns
    -------
    surface : SurfaceMesh
        As from `read_surface`.
    movable : ndarray of bool, shape (N,), or None
        True for the selected vertices that are not hidden; None, for all, in Object Mode.
    """
    with readable_mesh(obj) as mesh:
        if not obj.data.is_editmode:
            return read_arrays(mesh, active_key(obj)), None
        movable = truth_values(mesh, ".select_vert") & ~truth_values(mesh, ".hide_vert")
        return read_arrays(mesh, None), movable


@contextmanager
def readable_mesh(obj: bpy.types.Object) -> Iterator[bpy.types.Mesh]:
    """Give a mesh whose arrays can be read: the object's own, in Edit Mode a copy of the edit session."""
    mesh = obj.data
    if not mesh.is_editmode:
        yield mesh
        return
    # A temporary mesh gives arrays without a Python loop over the BMesh.
    temporary = bpy.data.meshes.new(".framelet")
    try:
        bmesh.from_edit_mesh(mesh).to_mesh(temporary)
        yield temporary
    finally:
        bpy.data.meshes.remove(temporary)


def has_counts_of(obj: bpy.types.Object, surface: SurfaceMesh) -> bool:
    """Tell whether a mesh has as many vertices, edges and faces as when it was read."""
    mesh = obj.data
    if mesh.is_editmode:
        edit_mesh = bmesh.from_edit_mesh(mesh)
        counts = (len(edit_mesh.verts), len(edit_mesh.edges), len(edit_mesh.faces))
    else:
        counts = (len(mesh.vertices), len(mesh.edges), len(mesh.polygons))
    return counts == (surface.n_vertices, surface.n_edges, surface.n_faces)


def read_weights(obj: bpy.types.Object, group_name: str) -> NDArray[np.float64]:
    """Return the weights of a vertex group, 0 for vertices that are not in it.

    Parameters
    ----------
    obj : bpy.types.Object
        A mesh object in Object Mode or Edit Mode.
    group_name : str
        Name of a vertex group of the object.

    Returns
    -------
    ndarray, shape (N,), float64

    Raises
    ------
    ValueError
        In one sentence, if the object has no such group.
    """
    import numpy as np

    group = obj.vertex_groups.get(group_name)
    if group is None:
        raise ValueError(f"‘{obj.name}’ has no vertex group ‘{group_name}’; choose one that it has.")
    mesh, number = obj.data, group.index
    # Blender gives no array of these weights, so that this is the one loop over vertices.
    if mesh.is_editmode:
        edit_mesh = bmesh.from_edit_mesh(mesh)
        layer = edit_mesh.verts.layers.deform.active
        if layer is None:
            return np.zeros(len(edit_mesh.verts))
        return np.array([vert[layer].get(number, 0.0) for vert in edit_mesh.verts], np.float64)
    weights = np.zeros(len(mesh.vertices))
    for index, vertex in enumerate(mesh.vertices):
        for item in vertex.groups:
            if item.group == number:
                weights[index] = item.weight
    return weights


def write_vertices(
    obj: bpy.types.Object, before: SurfaceMesh, vertices: NDArray[np.floating]
) -> NDArray[np.float32]:
    """Move the vertices of an object's mesh; those that did not move keep their bits.

    With shape keys the active key is edited. If the Key is relative, keys that depend on the active one shift
    with it, and the mesh itself follows the reference key.

    Parameters
    ----------
    obj : bpy.types.Object
        The object whose mesh is changed.
    before : SurfaceMesh
        What `read_surface` returned.
    vertices : ndarray, shape (N, 3)
        New positions in object space.

    Returns
    -------
    ndarray, shape (N, 3), float32
        What was written; see `with_moved`.
    """
    import numpy as np

    positions = with_moved(before, vertices)
    if np.array_equal(positions, before.vertices):
        return positions
    mesh = obj.data
    if mesh.is_editmode:
        _write_edit_mesh(mesh, _moved(before, positions), positions)
        return positions
    active = active_key(obj)
    if active is None:
        write_positions(mesh, positions)
    else:
        # Nothing is written before everything is there.
        points = {active.name: positions}
        dependent = dependent_keys(mesh.shape_keys, active)
        if dependent:
            moved = _moved(before, positions)
            offset = positions[moved] - before.vertices[moved]
        for key in dependent:
            points[key.name] = read_key_points(key)
            points[key.name][moved] += offset
        for name, shifted in points.items():
            write_key_points(mesh.shape_keys.key_blocks[name], shifted)
        reference = mesh.shape_keys.reference_key.name
        if reference in points:
            write_positions(mesh, points[reference])
    mesh.update()
    mesh.update_tag()  # in Sculpt Mode what is drawn is made again
    return positions


def write_key(
    key: bpy.types.ShapeKey, before: SurfaceMesh, vertices: NDArray[np.floating]
) -> NDArray[np.float32]:
    """Write positions to one shape key, and return them as `write_vertices` does."""
    positions = with_moved(before, vertices)
    write_key_points(key, positions)
    return positions


def show_positions(mesh: bpy.types.Mesh, positions: NDArray[np.float32]) -> None:
    """Write the positions of all vertices, shape (N, 3), of a mesh in Object Mode without shape keys."""
    write_positions(mesh, positions)
    mesh.update()


def with_moved(before: SurfaceMesh, vertices: NDArray[np.floating]) -> NDArray[np.float32]:
    """Return the positions that `write_vertices` writes to a mesh, shape (N, 3).

    Coordinates that are the same by value have the bits they had when read, the sign of a zero included.
    """
    import numpy as np

    new, old = np.asarray(vertices, np.float32), np.asarray(before.vertices, np.float32)
    return np.where(new != old, new, old)


def _moved(before: SurfaceMesh, positions: NDArray[np.float32]) -> NDArray[np.intp]:
    """Return which vertices moved."""
    import numpy as np

    return np.flatnonzero((positions != before.vertices).any(axis=1))


def _write_edit_mesh(mesh: bpy.types.Mesh, moved: NDArray[np.intp], vertices: NDArray[np.float32]) -> None:
    """Move vertices in the edit session of a mesh; its other modes and windows follow."""
    edit_mesh = bmesh.from_edit_mesh(mesh)
    edit_mesh.verts.ensure_lookup_table()
    verts = edit_mesh.verts
    for index, position in zip(moved.tolist(), vertices[moved].tolist(), strict=True):
        verts[index].co = position
    edit_mesh.normal_update()
    bmesh.update_edit_mesh(mesh, loop_triangles=True, destructive=False)


def read_arrays(mesh: bpy.types.Mesh, key: bpy.types.ShapeKey | None) -> SurfaceMesh:
    """Read the arrays of a mesh, with the positions of a shape key if one is given."""
    import numpy as np

    from ...core import SurfaceMesh

    reserve_for_reading(mesh)
    n_corners, n_faces = len(mesh.loops), len(mesh.polygons)
    vertices = read_positions(mesh) if key is None else read_key_points(key)
    edges = np.empty((len(mesh.edges), 2), np.int32)
    if len(edges):
        # A hundred times faster than `mesh.edges`, which asks each edge.
        mesh.attributes[".edge_verts"].data.foreach_get("value", edges.reshape(-1))
    corner_vertex = np.empty(n_corners, np.int32)
    corner_edge = np.empty(n_corners, np.int32)
    face_offset = np.full(n_faces + 1, n_corners, np.int32)
    if n_faces:
        mesh.attributes[".corner_vert"].data.foreach_get("value", corner_vertex)
        mesh.attributes[".corner_edge"].data.foreach_get("value", corner_edge)
        # Where faces begin is no attribute: this asks each face, 30 ns each.
        mesh.polygons.foreach_get("loop_start", face_offset[:-1])
    arrays = (vertices, corner_vertex, corner_edge, face_offset, edges)
    for array in arrays:
        array.flags.writeable = False  # so that nobody has to copy them to be sure
    return SurfaceMesh.trusted(*arrays)


def read_positions(mesh: bpy.types.Mesh) -> NDArray[np.float32]:
    """Read the positions of the mesh itself, shape (N, 3), in Object Mode."""
    import numpy as np

    vertices = np.empty((len(mesh.vertices), 3), np.float32)
    if len(vertices):
        mesh.attributes["position"].data.foreach_get("vector", vertices.reshape(-1))
    return vertices
