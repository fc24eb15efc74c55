# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""From one format to another: positions and faces go over, everything else is named and dropped."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.mesh.ragged import stretches
from .mesh_file import FileError, MeshFile, check_range


def triangles_of(face_offset: NDArray[Any], corner_vertex: NDArray[Any]) -> NDArray[np.int64]:
    """Return the faces of a surface as triangles, shape (T, 3); larger ones as fans around a corner.

    Examples
    --------
    >>> triangles_of(np.array([0, 3, 7]), np.array([0, 1, 2, 0, 2, 3, 4])).tolist()
    [[0, 1, 2], [0, 2, 3], [0, 3, 4]]
    """
    sizes = np.diff(face_offset)
    n_triangles = np.maximum(sizes - 2, 0)
    second = stretches(face_offset[:-1] + 1, n_triangles)
    corners = np.stack((np.repeat(face_offset[:-1], n_triangles), second, second + 1), axis=1)
    return np.asarray(corner_vertex, np.int64)[corners]


def converted(file: MeshFile, positions: NDArray[np.floating], kind: str) -> tuple[bytes, list[str]]:
    """Return a surface as a file of another format, and what is lost.

    Parameters
    ----------
    file : MeshFile
        What was read.
    positions : ndarray, shape (N, 3), float64
        Where its vertices are now.
    kind : str
        The suffix of the new file, in lower case.

    Returns
    -------
    data : bytes
        The file.
    lost : list of str
        What the file held besides.

    Raises
    ------
    FileError
        In one sentence, if the format cannot be written without the file that it patches, or if it cannot
        hold the positions.
    """
    from . import gltf, obj, ply, stl

    positions = np.asarray(positions, np.float64)
    if file.precision == np.float32:
        positions = positions.astype(np.float32)
    positions, face_offset, corner_vertex = file.scene(positions)
    check_range(positions, np.dtype(np.float32) if kind in (".stl", ".glb") else positions.dtype)
    lost = list(file.extras)
    if kind in (".stl", ".glb") and len(face_offset) > 1 and np.diff(face_offset).max() > 3:
        lost.append("faces with more than three corners, which become triangles")
    if kind in (".stl", ".glb") and positions.dtype == np.float64:
        lost.append("double precision")
    if len(file.loose_edges):
        lost.append("loose edges")
    if kind == ".ply":
        return ply.new_file(positions, face_offset, corner_vertex), lost
    if kind == ".obj":
        return obj.new_file(positions, face_offset, corner_vertex), lost
    if kind == ".stl":
        return stl.new_file(positions, face_offset, corner_vertex), lost
    if kind == ".glb":
        return gltf.new_file(positions, face_offset, corner_vertex), lost
    raise FileError(
        f"A {kind} file cannot be made of another format; write .glb, .ply, .obj or .stl instead."
    )
