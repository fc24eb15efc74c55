# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What Blender's OBJ exporter leaves to be done in the text: all digits of positions, short texture paths."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .obj_order import mesh_positions

if TYPE_CHECKING:
    import bpy

# The exporter writes six decimals, which leaves nothing of a surface that is a millionth wide.
EXPORTER_PRECISION = 1e-6
N_CHECKED = 1000


def write_all_digits(path: Path, objects: list[bpy.types.Object]) -> None:
    """Write the positions in an OBJ file again, so that reading them gives the same 32-bit numbers.

    Parameters
    ----------
    path : Path
        A file from Blender's exporter; left alone if its vertices are not those expected.
    objects : list of bpy.types.Object
        The objects in it, in the order of the file.
    """
    exact = np.concatenate([_world_positions(obj) for obj in objects if obj.type == "MESH"])
    with path.open("rb") as file:
        lines = file.readlines()
    numbers = [number for number, line in enumerate(lines) if line.startswith(b"v ")]
    if len(numbers) != len(exact) or not _agree(lines, numbers, exact):
        return
    words = exact.astype("S")
    for number, row in zip(numbers, words.tolist(), strict=True):
        lines[number] = b" ".join([b"v", *row, *lines[number].split()[4:]]) + b"\n"
    with path.open("wb") as file:
        file.writelines(lines)


def shorten_texture_paths(path: Path, folder: Path) -> None:
    """Make the paths of textures below a folder relative to it, in a .mtl file that will be moved there."""
    if not path.is_file():
        return
    text = path.read_text(encoding="utf-8", errors="surrogateescape")
    prefix = str(folder.absolute())
    for beginning in {prefix + os.sep, prefix.replace("\\", "/") + "/"}:
        text = text.replace(" " + beginning, " ")
    path.write_text(text, encoding="utf-8", errors="surrogateescape", newline="\n")


def _world_positions(obj: bpy.types.Object) -> NDArray[np.float32]:
    """Return the positions of an object's mesh as the exporter transforms them, shape (N, 3)."""
    positions = mesh_positions(obj.data)
    matrix = np.array(obj.matrix_world, np.float64)
    if np.array_equal(matrix, np.eye(4)):
        return positions
    return (positions @ matrix[:3, :3].T + matrix[:3, 3]).astype(np.float32)


def _agree(lines: list[bytes], numbers: list[int], exact: NDArray[np.float32]) -> bool:
    """Return whether a sample of the vertex lines tells the same positions."""
    step = max(1, len(numbers) // N_CHECKED)
    written = [lines[number].split()[1:4] for number in numbers[::step]]
    return bool(np.allclose(np.array(written, np.float64), exact[::step], rtol=1e-6, atol=EXPORTER_PRECISION))
