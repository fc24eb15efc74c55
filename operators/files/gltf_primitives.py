# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The primitives of the meshes in a glTF file."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .convert import triangles_of
from .gltf_buffers import Buffers, Stored
from .mesh_file import FileError

TRIANGLES, STRIP, FAN = 4, 5, 6


@dataclass(frozen=True, eq=False)
class Primitive:
    """A part of a mesh: its mesh, its vertices, its triangles, and where its normals and tangents are."""

    mesh: int
    vertex: NDArray[np.int64]
    triangles: NDArray[np.int64]
    """As numbers of its own elements, shape (T, 3)."""
    normal: Stored | None
    tangent: Stored | None


def shading(buffers: Buffers, attributes: dict[str, Any], name: str, width: int, count: int) -> Stored | None:
    """Return where the normals or tangents of a primitive are; None if it has none."""
    if name not in attributes:
        return None
    stored = buffers.stored(attributes[name])
    if stored.width != width or len(stored.at) != count:
        raise FileError(f"A primitive has not one {name} for each position; the file is damaged.")
    return stored


def triangles(buffers: Buffers, primitive: dict[str, Any], mode: int, count: int) -> NDArray[np.int64]:
    """Return the triangles of a primitive as numbers of its elements, shape (T, 3)."""
    if "indices" in primitive:
        stored = buffers.stored(primitive["indices"])
        if stored.width != 1 or stored.dtype.kind != "u":
            raise FileError("The indices of a primitive are no whole numbers; the file is damaged.")
        corners = buffers.numbers(stored.at, stored.dtype, 1).reshape(-1).astype(np.int64)
    else:
        corners = np.arange(count)
    if len(corners) and corners.max() >= count:
        raise FileError(
            f"A triangle names vertex {corners.max()}, but there are {count}; the file is damaged."
        )
    if mode == TRIANGLES:
        return corners[: len(corners) // 3 * 3].reshape(-1, 3)
    if len(corners) < 3:
        return np.zeros((0, 3), np.int64)
    if mode == FAN:
        return triangles_of(np.array([0, len(corners)]), corners)
    rows = np.stack((corners[:-2], corners[1:-1], corners[2:]), axis=1)
    rows[1::2] = rows[1::2, [1, 0, 2]]
    return rows
