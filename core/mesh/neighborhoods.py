# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Neighborhoods wider than the one-ring."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .connectivity import Connectivity
from .distance_rings import edge_adjacency


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
    rings = edge_adjacency(connectivity)
    center = member = np.arange(start, stop)
    front_center, front_member = center, member
    for _ in range(n_edges):
        reached, counts = rings.taken(front_member)
        keys = np.unique(np.repeat(front_center, counts) * n + reached)
        keys = np.setdiff1d(keys, center * n + member, assume_unique=True)
        front_center, front_member = np.divmod(keys, n)
        order = np.argsort(np.concatenate((center * n + member, keys)), kind="stable")
        center = np.concatenate((center, front_center))[order]
        member = np.concatenate((member, front_member))[order]
    others = center != member
    return center[others], member[others]
