# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Dilated stencils by the paper's angle rule (section 3.2, Fig. 2).

The dilation of a member P of vertex V on the d-ring is the vertex X of the 2d-ring with the smallest angle
between X - P and P - V: the point that goes on straightest. Vertices whose 2d-ring is empty, on small meshes,
have no members there.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..surface.distance_rings import Adjacency, Ring, distance_rings
from .members import Members
from .straight import TIE

CANDIDATES_PER_BLOCK = 2**19
"""Candidates that a block may hold, so that its arrays stay small however wide the rings are."""


def dilate(
    members: Members,
    vertices: NDArray[np.floating],
    adjacency: Adjacency,
    level: int,
    far_distance: int,
    blocks: Blocks,
) -> Members:
    """Dilate the members of level 0 to the rings of a level.

    Parameters
    ----------
    members : Members
        Members of level 0.
    vertices : ndarray, shape (N, 3)
        Positions on which angles are measured: the surface handed to this level.
    adjacency : Adjacency
        What counts as one step.
    level : int
        Level l; near members are looked for on the 2^l-ring.
    far_distance : int
        Steps to the far members of level 0: 1 on quads, 2 across triangle edges.
    blocks : Blocks
        Threads to work on.

    Returns
    -------
    Members
        Dilated members in the same order; on angle ties (up to rounding) the lowest vertex number wins.
    """
    if level == 0:
        return members
    near = members.near.copy()
    far = None if members.far is None else members.far.copy()
    steps = 2 ** np.arange(1, level + 1)
    distances = {int(step) for step in steps}
    if far is not None:
        distances |= {int(step) * far_distance for step in steps}
    points = vertices.T.astype(np.float64)
    offset, labels = members.connectivity.ring_offset, members.connectivity.labels

    def kernel(start: int, stop: int) -> None:
        rings = distance_rings(adjacency, start, stop, distances)
        for step in steps:
            _dilate_once(points, near, offset, start, stop, rings[int(step)], labels)
            if far is not None:
                _dilate_once(points, far, offset, start, stop, rings[int(step) * far_distance], labels)

    widest = 8 * max(distances) * 8
    blocks.sized(max(1, CANDIDATES_PER_BLOCK // widest)).run(kernel, members.connectivity.n_vertices)
    return Members(members.connectivity, near, far)


def _dilate_once(
    points: NDArray[np.float64],
    members: NDArray[np.int32],
    offset: NDArray[np.int64],
    start: int,
    stop: int,
    ring: Ring,
    labels: NDArray[np.int32] | None,
) -> None:
    """Replace the members of vertices start to stop by their dilations on a ring, in place."""
    centers = np.arange(start, stop)
    valence = np.diff(offset[start : stop + 1])
    counts = np.bincount(ring.row, minlength=len(centers))
    begin = np.cumsum(counts) - counts
    for slot in range(int(valence.max(initial=0))):
        holding = np.flatnonzero(valence > slot)
        place = offset[start + holding] + slot
        known = members[place] >= 0
        members[place[known & (counts[holding] == 0)]] = -1
        chosen = known & (counts[holding] > 0)
        holding, place = holding[chosen], place[chosen]
        if not len(holding):
            continue
        if len(holding) == len(centers):
            row, vertex, first = ring.row, ring.vertex, begin
        else:
            spread = np.repeat(np.arange(len(holding)), counts[holding])
            first = np.cumsum(counts[holding]) - counts[holding]
            vertex = ring.vertex[np.arange(len(spread)) + (begin[holding] - first)[spread]]
            row = spread
        members[place] = _straightest(points, centers[holding], members[place], row, vertex, first, labels)


def _straightest(
    points: NDArray[np.float64],
    centers: NDArray[np.intp],
    members: NDArray[np.int32],
    row: NDArray[np.intp],
    candidates: NDArray[np.intp],
    first: NDArray[np.intp],
    labels: NDArray[np.int32] | None,
) -> NDArray[np.intp]:
    """Return, for each center and member, the candidate that goes on straightest.

    `row` (c,) says which center a candidate belongs to; `first` (n,) is where each center's candidates begin.
    """
    pivot = points[:, members]
    spoke = pivot - points[:, centers]
    length = np.sqrt((spoke * spoke).sum(axis=0))
    spoke /= np.where(length > 0, length, 1.0)
    cosine = np.zeros(len(row))
    squares = np.zeros(len(row))
    for coordinate, at, along in zip(points, pivot, spoke, strict=True):
        leap = coordinate[candidates] - at[row]
        squares += leap * leap
        leap *= along[row]
        cosine += leap
    np.sqrt(squares, out=squares)
    cosine /= np.where(squares > 0, squares, 1.0)
    cosine = np.rint(cosine / TIE)
    best = np.maximum.reduceat(cosine, first)
    hit = np.flatnonzero(cosine == best[row])[::-1]  # reversed: the lowest-numbered candidate is written last
    if labels is not None:
        hit = hit[np.argsort(-labels[candidates[hit]], kind="stable")]
    chosen = np.empty(len(first), np.intp)
    chosen[row[hit]] = candidates[hit]
    return chosen
