# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The original positions of a mesh that shows a preview, kept in the mesh itself.

Undo steps and files that Blender saves by itself hold the mesh as it is shown. With the original beside it,
what comes back from them can be put right. Beside the original there is what was shown instead: where the
vertices still lie so, or all in the same way from it (after a join, which moves them into the space of
another object, or after a scale was applied), the original can be put back; elsewhere nothing says where it
belongs. Vertices that came from other meshes have zeros in both, and stay.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import bmesh
import bpy

from .own_names import remove_attribute
from .typed_attributes import typed_attribute

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

ORIGINAL = ".framelet_original"
SHOWN = ".framelet_shown"
"""The attributes with the positions; names with a dot are not shown in lists."""

NAMES = (ORIGINAL, SHOWN)

PRECISION = 1e-5
"""Largest deviation, as a share of the size of the mesh, of vertices that lie where they were shown."""


def keep(mesh: bpy.types.Mesh, original: NDArray[np.float32], shown: NDArray[np.float32]) -> None:
    """Keep the original positions, shape (N, 3), of a mesh in Object Mode, and what it shows instead."""
    for name, positions in zip(NAMES, (original, shown), strict=True):
        attribute = typed_attribute(mesh, name, "FLOAT_VECTOR", "POINT")
        if attribute is None:
            remove_attribute(mesh, name)
            attribute = mesh.attributes.new(name, "FLOAT_VECTOR", "POINT")
        attribute.data.foreach_set("vector", positions.reshape(-1))


def has_kept(mesh: bpy.types.Mesh) -> bool:
    """Tell whether a mesh has an original, or what is left of one."""
    return any(name in mesh.attributes for name in NAMES)


def has_both(mesh: bpy.types.Mesh) -> bool:
    """Tell whether a mesh has an original and what it showed instead, both at its vertices."""
    return all(typed_attribute(mesh, name, "FLOAT_VECTOR", "POINT") for name in NAMES)


def forget(mesh: bpy.types.Mesh) -> None:
    """Take the original away and leave the positions as they are."""
    if mesh.is_editmode:
        layers = bmesh.from_edit_mesh(mesh).verts.layers.float_vector
        for name in NAMES:
            if name in layers:
                layers.remove(layers[name])
        return
    for name in NAMES:
        remove_attribute(mesh, name)


def put_back(mesh: bpy.types.Mesh) -> bool:
    """Give a mesh its original positions, and take the copy away.

    Returns
    -------
    bool
        False if nothing says where the original belongs, so that the positions stay as they are.
    """
    is_edited = mesh.is_editmode
    read = _read_edit_mesh if is_edited else _read_mesh
    original, shown, now = (read(mesh, name) for name in (*NAMES, "position"))
    back = _put_back(original, shown, now)
    forget(mesh)
    if back is not None:
        (_write_edit_mesh if is_edited else _write_mesh)(mesh, back)
    if not is_edited:
        mesh.update()
    return back is not None


def put_all_back(shown_uid: int = 0) -> None:
    """Put back all meshes that came with an original from an undo step, a file, or by a copy or a join.

    Parameters
    ----------
    shown_uid : int
        The `session_uid` of the mesh that shows a preview now, which is left as it is.
    """
    for mesh in bpy.data.meshes:
        if has_kept(mesh) and mesh.is_editable and mesh.session_uid != shown_uid:
            put_back(mesh)


def _put_back(
    original: NDArray[np.float32], shown: NDArray[np.float32], now: NDArray[np.float32]
) -> NDArray[np.float32] | None:
    """Return the positions, shape (N, 3), without the preview; None if that cannot be told.

    With the positions now = L shown + t, they are now + L (original - shown).
    """
    import numpy as np

    is_ours = original.any(axis=1) | shown.any(axis=1)
    ours, present = shown[is_ours].astype(np.float64), now[is_ours].astype(np.float64)
    if np.array_equal(ours, present, equal_nan=True):
        # With the original's own bits. It has zeros for the others, which stay.
        return np.where(np.expand_dims(is_ours, 1), original, now)
    if not (np.isfinite(ours).all() and np.isfinite(present).all()):
        return None
    source, target = ours - ours.mean(axis=0), present - present.mean(axis=0)
    linear = _linear_map(source, target)
    deviation = np.abs(source @ linear.T - target).max()
    if not deviation <= PRECISION * max(np.abs(present).max(), np.ptp(present, axis=0).max()):
        return None
    back = now.copy()
    back[is_ours] = present + (original[is_ours].astype(np.float64) - ours) @ linear.T
    return back


def _linear_map(source: NDArray[np.float64], target: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the matrix, shape (3, 3), that takes centered points, shape (n, 3), to others, by least squares.

    What lies in a plane says nothing of the direction across it: that one is taken to the direction across
    the plane of the others, and scaled as the lengths in it are.
    """
    import numpy as np

    scale = np.abs(source).max() or 1.0
    _, sizes, axes = np.linalg.svd(source.T @ source / scale**2)
    rank = int(np.count_nonzero(sizes > 1e-12 * sizes[0]))
    axes = axes[:rank]
    images = np.linalg.lstsq(source @ axes.T, target, rcond=None)[0]
    if rank == 2:
        across = np.cross(images[0], images[1])
        images = np.vstack((images, across / np.sqrt(np.linalg.norm(across) or 1.0)))
        axes = np.vstack((axes, np.cross(axes[0], axes[1])))
    return images.T @ axes


def _read_mesh(mesh: bpy.types.Mesh, name: str) -> NDArray[np.float32]:
    """Read vectors at the vertices, shape (N, 3); zeros where there are none of this name.

    Nodes that were applied may have brought the original to other elements, where it is of no use.
    """
    import numpy as np

    vectors = np.zeros((len(mesh.vertices), 3), np.float32)
    attribute = typed_attribute(mesh, name, "FLOAT_VECTOR", "POINT")
    if attribute is not None and len(vectors):
        attribute.data.foreach_get("vector", vectors.reshape(-1))
    return vectors


def _write_mesh(mesh: bpy.types.Mesh, positions: NDArray[np.float32]) -> None:
    """Write positions."""
    if len(positions):
        mesh.attributes["position"].data.foreach_set("vector", positions.reshape(-1))


def _read_edit_mesh(mesh: bpy.types.Mesh, name: str) -> NDArray[np.float32]:
    """Read the same from an edit session, which has no arrays.

    This is rare: Edit Mode was entered while a preview was shown.
    """
    import numpy as np

    edit_mesh = bmesh.from_edit_mesh(mesh)
    layer = edit_mesh.verts.layers.float_vector.get(name)
    if name == "position":
        vectors = [vert.co[:] for vert in edit_mesh.verts]
    elif layer is None:
        vectors = [(0.0, 0.0, 0.0)] * len(edit_mesh.verts)
    else:
        vectors = [vert[layer][:] for vert in edit_mesh.verts]
    return np.array(vectors, np.float32).reshape(-1, 3)


def _write_edit_mesh(mesh: bpy.types.Mesh, positions: NDArray[np.float32]) -> None:
    """Write positions to an edit session."""
    edit_mesh = bmesh.from_edit_mesh(mesh)
    for vert, position in zip(edit_mesh.verts, positions.tolist(), strict=True):
        vert.co = position
    edit_mesh.normal_update()
    bmesh.update_edit_mesh(mesh, loop_triangles=True, destructive=False)
