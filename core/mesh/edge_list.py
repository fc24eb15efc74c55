# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The edges of faces: every pair of vertices that follow each other around a face, each pair once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def find_edges(
    start: NDArray[np.integer],
    end: NDArray[np.integer],
    loose_edges: NDArray[np.integer],
    n_vertices: int,
) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Number the edges of a mesh in ascending order of their lower and then their higher vertex.

    Parameters
    ----------
    start, end : ndarray, shape (C,), int
        The vertex of each corner, and that of the next corner of its face.
    loose_edges : ndarray, shape (L, 2), int
        Further pairs of vertices.
    n_vertices : int
        Number of vertices, below 2^31.

    Returns
    -------
    edges : ndarray, shape (E, 2), int32
        The two vertices of each edge, the lower one first.
    corner_edge : ndarray, shape (C,), int32
        Edge of each corner.

    Examples
    --------
    >>> edges, corner_edge = find_edges(np.array([0, 1, 2]), np.array([1, 2, 0]), np.zeros((0, 2), int), 3)
    >>> edges.tolist(), corner_edge.tolist()
    ([[0, 1], [0, 2], [1, 2]], [0, 2, 1])
    """
    if len(loose_edges):
        start = np.concatenate((start, loose_edges[:, 0]))
        end = np.concatenate((end, loose_edges[:, 1]))
    n_corners, n_keys = len(start) - len(loose_edges), len(start)
    vertex_bits = max(int(n_vertices - 1).bit_length(), 1)
    key = np.minimum(start, end).astype(np.int64)
    key <<= vertex_bits
    key |= np.maximum(start, end)
    place_bits = max(int(n_keys - 1).bit_length(), 1)
    if 2 * vertex_bits + place_bits <= 63:
        # The place of a key travels in its lowest bits: to sort numbers takes a third of sorting places.
        key <<= place_bits
        key |= np.arange(n_keys)
        key.sort()
        order = key & (2**place_bits - 1)
        key >>= place_bits
    else:
        order = np.argsort(key, kind="stable")
        key = key[order]
    is_new = np.ones(n_keys, bool)
    np.not_equal(key[1:], key[:-1], out=is_new[1:])
    number = np.empty(n_keys, np.int32)
    number[order] = np.cumsum(is_new, dtype=np.int32) - np.int32(1)
    key = key[is_new]
    edges = np.empty((len(key), 2), np.int32)
    edges[:, 0] = key >> vertex_bits
    edges[:, 1] = key & (2**vertex_bits - 1)
    return edges, number[:n_corners]
