# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Shape keys of meshes: which one is edited, which ones follow it, and their points as arrays."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import bpy
    import numpy as np
    from numpy.typing import NDArray


def active_key(obj: bpy.types.Object) -> bpy.types.ShapeKey | None:
    """Return the shape key that is read and edited; None without shape keys."""
    keys = obj.data.shape_keys
    if keys is None:
        return None
    return obj.active_shape_key or keys.reference_key


def dependent_keys(keys: bpy.types.Key, active: bpy.types.ShapeKey) -> list[bpy.types.ShapeKey]:
    """Return the keys that are relative to a key, directly or through others."""
    if not keys.use_relative:
        return []
    dependent: list[bpy.types.ShapeKey] = []
    found = [active]
    while found:
        base = found.pop()
        followers = [
            key
            for key in keys.key_blocks
            if key.relative_key == base and key != active and key not in dependent
        ]
        dependent += followers
        found += followers
    return dependent


def read_key_points(key: bpy.types.ShapeKey) -> NDArray[np.float32]:
    """Read the positions of a shape key, shape (N, 3)."""
    import numpy as np

    positions = np.empty((len(key.points), 3), np.float32)
    key.points.foreach_get("co", positions.reshape(-1))
    return positions


def write_key_points(key: bpy.types.ShapeKey, positions: NDArray[np.float32]) -> None:
    """Write the positions of a shape key."""
    key.points.foreach_set("co", positions.reshape(-1))


def write_positions(mesh: bpy.types.Mesh, positions: NDArray[np.float32]) -> None:
    """Write the positions of the mesh itself."""
    mesh.attributes["position"].data.foreach_set("vector", positions.reshape(-1))


def read_followers(obj: bpy.types.Object) -> dict[str, NDArray[np.float32]]:
    """Return the points of the shape keys that `write_vertices` moves along with the active one, by name."""
    keys = obj.data.shape_keys
    if keys is None or obj.data.is_editmode:
        return {}
    return {key.name: read_key_points(key) for key in dependent_keys(keys, active_key(obj))}


def write_followers(obj: bpy.types.Object, points: Mapping[str, NDArray[np.float32]]) -> None:
    """Write what `read_followers` returned, or some of it; the mesh itself follows the reference key."""
    mesh, active = obj.data, active_key(obj)
    for name, positions in points.items():
        key = mesh.shape_keys.key_blocks[name]
        write_key_points(key, positions)
        if key == mesh.shape_keys.reference_key and key != active:
            write_positions(mesh, positions)
            mesh.update()
