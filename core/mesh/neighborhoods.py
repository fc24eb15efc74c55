# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Neighborhoods wider than the one-ring."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .connectivity import Connectivity


def vertices_within(
    connectivity: Connectivity, start: int, stop: int, n_edges: int
) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Find all vertices at most `n_edges` edges away from each of a range of vertices.

    Parameters
    ----------
    connectivity : Connectivity
        One-rings.
    start, stop : int
        The range of center vertices.
    n_edges : int
        Largest edge distance.

    Returns
    -------
    center, member : ndarray, shape (P,), intp
        Pairs in ascending order of both; a vertex is not its own member.
    """
    n = connectivity.n_vertices
    center = member = np.arange(start, stop)
    front_center, front_member = center, member
    for _ in range(n_edges):
        counts = connectivity.valence[front_member].astype(np.int64)
        begin = np.repeat(connectivity.ring_offset[front_member] - (np.cumsum(counts) - counts), counts)
        reached = connectivity.ring[begin + np.arange(len(begin))]
        keys = np.unique(np.repeat(front_center, counts) * n + reached)
        keys = np.setdiff1d(keys, center * n + member, assume_unique=True)
        front_center, front_member = np.divmod(keys, n)
        order = np.argsort(np.concatenate((center * n + member, keys)), kind="stable")
        center = np.concatenate((center, front_center))[order]
        member = np.concatenate((member, front_member))[order]
    others = center != member
    return center[others], member[others]
