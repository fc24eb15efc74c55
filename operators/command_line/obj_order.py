# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The vertices of an OBJ file in the order of the file.

Blender's importer sorts objects by name, doubles vertices that two objects share, and leaves out vertices
that no face uses. The positions in the text tell what happened.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import bpy


def file_order(path: Path, objects: list[bpy.types.Object]) -> list[bpy.types.Object] | None:
    """Return the objects in the order of the file.

    Parameters
    ----------
    path : Path
        The OBJ file.
    objects : list of bpy.types.Object
        The mesh objects made from it.

    Returns
    -------
    list of bpy.types.Object or None
        None unless the vertices of the objects, one after the other, are exactly those of the file.
    """
    n_imported = sum(len(obj.data.vertices) for obj in objects)
    if n_imported != _count_vertices(path):
        return None
    if len(objects) < 2:
        return objects
    in_file = _read_positions(path)
    remaining = [(obj, mesh_positions(obj.data)) for obj in objects]
    order, start = [], 0
    while remaining:
        for index, (obj, positions) in enumerate(remaining):
            if _same(in_file[start : start + len(positions)], positions):
                order.append(obj)
                start += len(positions)
                del remaining[index]
                break
        else:
            return None
    return order


def add_unused_vertices(path: Path, mesh: bpy.types.Mesh) -> int:
    """Give the vertices of a file that no face uses their places in the mesh made from it.

    Returns
    -------
    int
        Number of vertices of the file that are still missing.
    """
    n_imported = len(mesh.vertices)
    n_missing = _count_vertices(path) - n_imported
    if n_missing <= 0:
        return 0
    in_file = _read_positions(path)
    numbers = _numbers_in_file(in_file, mesh_positions(mesh))
    if numbers is None or not np.isfinite(in_file).all():
        return n_missing
    import bmesh

    missing = np.setdiff1d(np.arange(len(in_file)), numbers).tolist()
    number_of = numbers + missing
    edited = bmesh.new()
    edited.from_mesh(mesh)
    for index, number in enumerate(missing, n_imported):
        edited.verts.new(in_file[number].tolist()).index = index
    edited.verts.sort(key=lambda vertex: number_of[vertex.index])
    edited.to_mesh(mesh)
    edited.free()
    _restore_colors(path, mesh)
    return 0


def _restore_colors(path: Path, mesh: bpy.types.Mesh) -> None:
    """Give all vertices their colors; Blender 4.2 goes wrong after the first vertex it leaves out."""
    colors = mesh.color_attributes.active_color
    in_file = _read_numbers(path, slice(4, 7))
    if colors is None or in_file.shape != (len(colors.data), 3) or not np.isfinite(in_file).all():
        return
    opaque = np.ones((len(in_file), 4), np.float32)
    opaque[:, :3] = in_file
    colors.data.foreach_set("color_srgb", opaque.ravel())


def mesh_positions(mesh: bpy.types.Mesh) -> NDArray[np.float32]:
    """Return the positions of a mesh, shape (N, 3)."""
    positions = np.empty((len(mesh.vertices), 3), np.float32)
    if len(positions):
        mesh.attributes["position"].data.foreach_get("vector", positions.ravel())
    return positions


def _count_vertices(path: Path) -> int:
    """Count the vertices in the text."""
    with path.open("rb") as file:
        return sum(line.startswith((b"v ", b"v\t")) for line in file)


def _read_positions(path: Path) -> NDArray[np.float32]:
    """Return the positions in the text, shape (N, 3); NaN where it cannot be understood."""
    return _read_numbers(path, slice(1, 4))


def _read_numbers(path: Path, words: slice) -> NDArray[np.float32]:
    """Return some words of the lines of vertices as numbers; NaN where they cannot be understood."""
    with path.open("rb") as file:
        rows = [line.split()[words] for line in file if line.startswith((b"v ", b"v\t"))]
    try:
        return np.array(rows, dtype=np.float64).astype(np.float32)
    except ValueError:
        return np.full((len(rows), 3), np.nan, np.float32)


def _numbers_in_file(in_file: NDArray[np.float32], imported: NDArray[np.float32]) -> list[int] | None:
    """Return the numbers in the file of the imported vertices, which are some of them in the same order."""
    numbers = []
    candidates = enumerate(_rows(in_file))
    for row in _rows(imported):
        number = next((number for number, candidate in candidates if candidate == row), None)
        if number is None:
            return None
        numbers.append(number)
    return numbers


def _rows(positions: NDArray[np.float32]) -> list[bytes]:
    """Return positions as things that compare fast; both zeros are one."""
    return np.ascontiguousarray(positions + np.float32(0.0)).view("V12").ravel().tolist()


def _same(first: NDArray[np.float32], second: NDArray[np.float32]) -> bool:
    """Return whether two arrays of positions are equal up to the rounding of text."""
    return first.shape == second.shape and bool(np.allclose(first, second, rtol=1e-6, atol=0.0))
