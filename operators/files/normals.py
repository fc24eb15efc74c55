# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Normals that a file stores, computed anew for a surface that moved."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .places import merge_equal


def renewed_normals(
    normals: NDArray[np.floating],
    place: NDArray[np.int64],
    triangles: NDArray[np.int64],
    corner_normal: NDArray[np.int64],
    positions: NDArray[np.float64],
    moved: NDArray[np.bool_],
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Compute normals anew, smooth where they were smooth.

    Parameters
    ----------
    normals : ndarray, shape (n, 3)
        The stored normals.
    place : ndarray, shape (n,), int64
        Which normals are at the same place: those with the same number.
    triangles : ndarray, shape (T, 3), int64
        Vertices of the triangles.
    corner_normal : ndarray, shape (T, 3), int64
        The stored normal of each corner; -1 for none.
    positions : ndarray, shape (N, 3), float64
        Where the vertices are now.
    moved : ndarray, shape (N,), bool
        Which of them moved.

    Returns
    -------
    normals : ndarray, shape (n, 3), float64
        The new normals, of length 1.
    is_new : ndarray, shape (n,), bool
        Which of them belong to a triangle that moved; the others are as before.

    Notes
    -----
    Normals at one place that were equal are one normal, as those at a seam of UVs: it is the mean of all
    triangles at them, by area. Those that differed, as at a sharp edge, go on differing.
    """
    alike, first = merge_equal(np.ascontiguousarray(normals, np.float32))
    groups, group = np.unique(place * len(first) + alike, return_inverse=True)
    n_groups, group = len(groups), group.reshape(-1)
    corners = positions[triangles]
    areas = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    has_moved: NDArray[np.bool_] = np.asarray(moved[triangles].any(axis=1))
    total = np.zeros((n_groups, 3))
    is_new = np.zeros(n_groups, bool)
    for column in corner_normal.T:
        has_normal = column >= 0
        of_corner = group[column[has_normal]]
        for axis in range(3):
            total[:, axis] += np.bincount(of_corner, areas[has_normal, axis], n_groups)
        is_new[of_corner[has_moved[has_normal]]] = True
    length = np.linalg.norm(total, axis=1)
    is_new &= length > 0.0
    total /= np.where(length > 0.0, length, 1.0)[:, None]
    chosen = is_new[group]
    result = np.array(normals, np.float64)
    result[chosen] = total[group[chosen]]
    return result, chosen


def renewed_tangents(
    tangents: NDArray[np.floating], normals: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Turn tangents into the planes of new normals.

    Parameters
    ----------
    tangents : ndarray, shape (n, 4)
        The stored tangents and their signs.
    normals : ndarray, shape (n, 3), float64
        The normal of each.

    Returns
    -------
    tangents : ndarray, shape (n, 4), float64
        The new tangents, at right angles to the normals, of length 1, with the same signs.
    is_new : ndarray, shape (n,), bool
        Which could be turned.
    """
    result = np.array(tangents, np.float64)
    along = result[:, :3] - normals * np.einsum("ni,ni->n", result[:, :3], normals)[:, None]
    length = np.linalg.norm(along, axis=1)
    is_new = length > 1e-6
    result[is_new, :3] = along[is_new] / length[is_new, None]
    return result, is_new
