# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The primitives of the meshes in a glTF file."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..machine import available_bytes
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
    indices: Stored | None
    """Where the triangles are; None if the elements in their order are the corners."""


def shading(buffers: Buffers, attributes: dict[str, Any], name: str, width: int, count: int) -> Stored | None:
    """Return where the normals or tangents of a primitive are; None if it has none."""
    if name not in attributes:
        return None
    stored = buffers.stored(attributes[name])
    if stored.width != width or len(stored.at) != count:
        raise FileError(f"A primitive has not one {name} for each position; the file is damaged.")
    return stored


def triangles(buffers: Buffers, stored: Stored | None, mode: int, count: int) -> NDArray[np.int64]:
    """Return the triangles of a primitive as numbers of its elements, shape (T, 3)."""
    if stored is not None:
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


def check_overlaps(buffers: Buffers, positions: list[Stored], primitives: list[Primitive]) -> None:
    """Raise FileError if an index lies where coordinates are written: faces would be others then."""
    shadings = [stored for each in primitives for stored in (each.normal, each.tangent) if stored is not None]
    indices = [each.indices for each in primitives if each.indices is not None]
    written, read = (
        [stored for stored in dict.fromkeys(many) if len(stored.at)]
        for many in ([*positions, *shadings], indices)
    )
    if not buffers.is_apart(written, read):
        raise FileError("Indices and coordinates share bytes; the file is damaged.")


def check_room(shown: list[Primitive]) -> None:
    """Raise FileError if a scene that shows primitives again and again is larger than the memory."""
    n_vertices, n_triangles = (
        sum(len(each.vertex) for each in shown),
        sum(len(each.triangles) for each in shown),
    )
    available = available_bytes()
    if available is not None and 72 * (n_vertices + n_triangles) > available:
        raise FileError(
            f"The scene shows {n_vertices:,} vertices, as its nodes use meshes again, and memory is too "
            "small for them; write a .glb file instead."
        )
