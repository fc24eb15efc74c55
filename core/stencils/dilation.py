# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Dilated stencils by the paper's angle rule (section 3.2, Fig. 2).

The dilation of a member P of vertex V on the d-ring is the vertex X of the 2d-ring with the smallest angle
between X - P and P - V: the point that goes on straightest. Vertices whose 2d-ring is empty, on small meshes,
have no ring points there.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..mesh.distance_rings import Ring, distance_rings
from ..mesh.locality import spatial_order
from ..mesh.ragged import Ragged, starts
from .ring_points import RingPoints
from .straight import TIE

CANDIDATES_AT_ONCE = 2**15
"""Candidates whose angles are measured at once, in the cache."""


def dilate(
    ring_points: RingPoints,
    vertices: NDArray[np.floating],
    adjacency: Ragged,
    level: int,
    far_distance: int,
    blocks: Blocks,
) -> RingPoints:
    """Dilate the ring points of level 0 to the rings of a level.

    Parameters
    ----------
    ring_points : RingPoints
        RingPoints of level 0.
    vertices : ndarray, shape (N, 3)
        Positions on which angles are measured: the surface handed to this level.
    adjacency : Ragged
        What counts as one step.
    level : int
        Level l; near ring points are looked for on the 2^l-ring.
    far_distance : int
        Steps to the far ring points of level 0: 1 on quads, 2 across triangle edges.

    Returns
    -------
    RingPoints
        Dilated ring points in the same order; on angle ties (up to rounding) the lowest vertex number wins.
    """
    if level == 0:
        return ring_points
    near = ring_points.near.copy()
    far = None if ring_points.far is None else ring_points.far.copy()
    steps = 2 ** np.arange(1, level + 1)
    distances = {int(step) for step in steps}
    if far is not None:
        distances |= {int(step) * far_distance for step in steps}
    points = np.ascontiguousarray(vertices.T, np.float64)  # `take` would copy all of it each time
    offset, order = ring_points.connectivity.ring_offset, _Order(ring_points.connectivity.labels)

    near_by = spatial_order(vertices)  # the search shares its work among centers that lie close together

    def kernel(start: int, stop: int) -> None:
        centers = near_by[start:stop]
        rings = distance_rings(adjacency, centers, distances)
        for step in steps:
            _dilate_once(points, near, offset, centers, rings[int(step)], order)
            if far is not None:
                _dilate_once(points, far, offset, centers, rings[int(step) * far_distance], order)

    # About as many candidates in a block, however wide the rings are.
    small = blocks.with_block_size(max(1, blocks.block_size // max(distances)))
    small.run(kernel, ring_points.connectivity.n_vertices)
    return RingPoints(ring_points.connectivity, near, far)


def _dilate_once(
    points: NDArray[np.float64],
    ring_points: NDArray[np.int32],
    offset: NDArray[np.int64],
    centers: NDArray[np.int32],
    ring: Ring,
    order: _Order,
) -> None:
    """Replace the ring points of some vertices by their dilations on a ring, in place."""
    valence = offset[centers + 1] - offset[centers]
    counts = np.bincount(ring.row, minlength=len(centers))
    begin = starts(counts)
    # Vertices with as many ring points, and candidates up to a multiple of four, go together.
    width = -(-counts // 4) * 4
    kind = valence * (int(width.max(initial=0)) + 1) + width
    for value in np.unique(kind[valence > 0]):
        group = np.flatnonzero(kind == value)
        n_members, n_candidates = int(valence[group[0]]), int(width[group[0]])
        step = max(1, CANDIDATES_AT_ONCE // max(n_candidates, 1))
        for part in np.split(group, range(step, len(group), step)):
            place = offset[centers[part]] + np.arange(n_members)[:, None]
            old = ring_points[place]
            if not n_candidates:
                ring_points[place] = -1
                continue
            # Rows that are too short repeat their last candidate, which changes nothing.
            column = np.minimum(np.arange(n_candidates)[:, None], counts[part] - 1)
            candidates = ring.vertex[begin[part] + column]
            chosen = _straightest(points, centers[part], old, candidates, order)
            ring_points[place] = np.where(old >= 0, chosen, -1)


def _straightest(
    points: NDArray[np.float64],
    centers: NDArray[np.int32],
    ring_points: NDArray[np.int32],
    candidates: NDArray[np.intp],
    order: _Order,
) -> NDArray[np.integer]:
    """Return the candidates (c, n) that go on straightest from ring points (m, n) of centers (n,), (m, n)."""
    pivots = points.take(ring_points, axis=1, mode="clip")
    spokes = pivots - points.take(centers, axis=1)[:, None]
    length = np.sqrt((spokes * spokes).sum(axis=0))
    spokes /= np.where(length > 0, length, 1.0)
    targets = points.take(candidates, axis=1)
    last = order.codes_of(candidates)
    best = np.empty(ring_points.shape, np.int64)
    for one in range(len(ring_points)):
        leap = targets - pivots[:, one, None]
        along = leap * spokes[:, one, None]
        cosine = np.add(along[0], along[1], out=along[0])
        cosine += along[2]
        leap *= leap
        squares = np.add(leap[0], leap[1], out=leap[0])
        squares += leap[2]
        np.sqrt(squares, out=squares)
        # Points that differ by rounding alone are one place, from which no direction leads away.
        least = TIE * squares.max(axis=0)
        squares[(squares <= least) | (length[one] <= least)] = np.inf
        cosine /= squares
        cosine *= 1.0 / TIE
        np.rint(cosine, out=cosine)
        # One number for both: whole steps of the cosine, then which candidate comes first.
        cosine *= _CODES
        cosine += last
        best[one] = cosine.max(axis=0)
    return order.decode(best)


_CODES = 2**31


class _Order:
    """Codes by which the lowest-numbered of several candidates wins a maximum.

    They are below 2^31, and cosines have 2^21 steps: together they are exact in double precision.
    """

    def __init__(self, labels: NDArray[np.int32] | None) -> None:
        self._labels = labels
        self._vertex_of: NDArray[np.int32] | None = None
        if labels is not None:
            self._vertex_of = np.empty(int(labels.max(initial=-1)) + 1, np.int32)
            self._vertex_of[labels] = np.arange(len(labels), dtype=np.int32)

    def codes_of(self, vertices: NDArray[np.intp]) -> NDArray[np.float64]:
        """Return the codes of vertices, larger for lower numbers."""
        numbers = vertices if self._labels is None else self._labels[vertices]
        return np.subtract(_CODES - 1, numbers, dtype=np.float64)

    def decode(self, best: NDArray[np.int64]) -> NDArray[np.integer]:
        """Return the vertices from codes, whatever stands before the code."""
        numbers = (_CODES - 1) - (best & (_CODES - 1))
        return numbers if self._vertex_of is None else self._vertex_of[numbers]
