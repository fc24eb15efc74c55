# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is wrong with the faces of a file, by the numbers of the file, where it can be mended."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .mesh_file import MeshFile

N_FIRST = 5
"""How many of a kind are named by their numbers."""

FLAT = 1e-12
"""Area of a face from which on it is none, as a share of the square of its longest edge."""


def defects_of(file: MeshFile) -> list[dict[str, Any]]:
    """Return the defects of a file as it was read.

    Parameters
    ----------
    file : MeshFile

    Returns
    -------
    list of dict
        For each kind that there is: ``kind``; ``count``; ``of``, "face" or "vertex"; and ``first``, the
        numbers of the first few in the file, from 0.

    Examples
    --------
    >>> from framelet.operators.files.obj import ObjFile
    >>> text = b"v 0 0 0\\nv 1 0 0\\nv 0 1 0\\nv 5 5 5\\nf 1 2 3\\nf 2 3 1\\nf 1 1 2\\n"
    >>> for defect in defects_of(ObjFile(text, "triangles")):
    ...     print(defect["kind"], defect["count"], defect["first"])
    degenerate faces 1 [2]
    double faces 1 [1]
    open borders 3 [0, 1, 2]
    loose vertices 1 [3]
    """
    offset, corner = np.asarray(file.face_offset, np.int64), np.asarray(file.corner_vertex, np.int64)
    n, sizes = len(file.positions), np.diff(offset)
    face = np.repeat(np.arange(len(sizes)), sizes)
    following = np.arange(1, len(corner) + 1)
    following[offset[1:][sizes > 0] - 1] = offset[:-1][sizes > 0]
    is_flat, is_double = _flat(file.positions, offset, corner), _double(offset, corner)
    counts = ~(is_flat | is_double)[face]
    joined = corner
    if file.always_welded and n:
        # The format splits what is one vertex, as at a seam of UVs; that is no border.
        _places, first, number = np.unique(file.positions, axis=0, return_index=True, return_inverse=True)
        joined = first[number.reshape(-1)][corner]
    start, end = joined[counts], joined[following][counts]
    low, high = np.minimum(start, end), np.maximum(start, end)
    # Each edge is one number; how many faces it has, and how many of them pass it upwards.
    keys, edge = np.unique(low * n + high, return_inverse=True)
    n_faces = np.bincount(edge, minlength=len(keys))
    n_up = np.bincount(edge[start < end], minlength=len(keys))

    def at(is_meant: NDArray[np.bool_]) -> NDArray[np.bool_]:
        ends = np.zeros(n, bool)
        ends[keys[is_meant] // max(n, 1)] = ends[keys[is_meant] % max(n, 1)] = True
        return ends

    is_used = np.zeros(n, bool)
    is_used[corner] = True
    found = (
        ("degenerate faces", "face", is_flat),
        ("double faces", "face", is_double),
        ("edges with more than two faces", "vertex", at(n_faces > 2)),
        ("neighbors that are turned over", "vertex", at((n_faces == 2) & (n_up != 1))),
        ("open borders", "vertex", at(n_faces == 1)),
        ("loose vertices", "vertex", ~is_used),
    )
    return [
        {
            "kind": kind,
            "count": int(np.count_nonzero(mask)),
            "of": of,
            "first": np.flatnonzero(mask)[:N_FIRST].tolist(),
        }
        for kind, of, mask in found
        if mask.any()
    ]


def _flat(
    positions: NDArray[np.float64], offset: NDArray[np.int64], corner: NDArray[np.int64]
) -> NDArray[np.bool_]:
    """Return which faces have next to no area, shape (F,)."""
    sizes = np.diff(offset)
    is_flat = sizes < 3
    for size in np.unique(sizes[sizes >= 3]).tolist():
        faces = np.flatnonzero(sizes == size)
        points = positions[corner[offset[faces][:, None] + np.arange(size)]]
        points = points - points[:, :1]
        area = np.cross(points[:, 1:-1], points[:, 2:]).sum(axis=1)
        edges = points - np.roll(points, 1, axis=1)
        longest = (edges * edges).sum(axis=2).max(axis=1)
        is_flat[faces] = ~(np.sqrt((area * area).sum(axis=1)) > FLAT * longest)
    return is_flat


def _double(offset: NDArray[np.int64], corner: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Return which faces have the vertices of one before them, shape (F,)."""
    sizes = np.diff(offset)
    is_double = np.zeros(len(sizes), bool)
    for size in np.unique(sizes[sizes >= 3]).tolist():
        faces = np.flatnonzero(sizes == size)
        rows = np.sort(corner[offset[faces][:, None] + np.arange(size)], axis=1)
        order = np.lexsort(rows.T[::-1])  # stable: of equal ones the first comes first
        same = (rows[order[1:]] == rows[order[:-1]]).all(axis=1)
        is_double[faces[order[1:][same]]] = True
    return is_double
