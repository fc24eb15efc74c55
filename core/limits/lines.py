# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Feature lines: edges that stay sharp and are smoothed along themselves only.

A vertex with two feature edges lies on a line. It takes the low-pass 1 - (1 - A^k)^m of the line, where A is
the mean of a vertex and of its two neighbors on the line; of the motion the part across the line counts, up
to three times the noise that is measured on the lines themselves. Ends, crossings and corners of lines stay.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

LOW_PASS_STEPS = 8
LOW_PASS_ROUNDS = 3
"""k and m: a wave of 16 edges loses 2 %, one of 7 edges half; of white noise half of the height is left."""

LARGEST_MOTION = 3.0
"""Motion of a line's vertex, in units of the noise on the lines."""

CORNER_TURN = 60.0
CORNER_REACH = 3
CORNER_SHARE = 0.6
"""A line has a corner where chords over so many edges turn by more degrees, most of it at the vertex."""


@dataclass(frozen=True, eq=False)
class FeatureLines:
    """The lines of a mesh.

    Attributes
    ----------
    vertices : ndarray, shape (v,), int64
        All vertices with feature edges, ascending.
    inner : ndarray, shape (l,), int64
        Those of them that may move: with two feature edges, and not at a corner.
    neighbors : ndarray, shape (l, 2), int64
        The two neighbors on the line of each of these.
    """

    vertices: NDArray[np.int64]
    inner: NDArray[np.int64]
    neighbors: NDArray[np.int64]


def find_lines(
    points: NDArray[np.floating], edges: NDArray[np.integer], pinned: NDArray[np.integer]
) -> FeatureLines:
    """Find the lines that feature edges form.

    Parameters
    ----------
    points : ndarray, shape (3, N)
        Positions, which say where corners are.
    edges : ndarray, shape (E, 2), int
        Feature edges; those that occur twice count once, those of a vertex with itself do not count.
    pinned : ndarray, shape (p,), int
        Vertices that may not move.
    """
    ends = np.sort(edges[edges[:, 0] != edges[:, 1]].astype(np.int64), axis=1)
    ends = np.unique(ends, axis=0)
    both = np.concatenate((ends, ends[:, ::-1]))
    both = both[np.argsort(both[:, 0], kind="stable")]
    vertices, begin, counts = np.unique(both[:, 0], return_index=True, return_counts=True)
    on_line = begin[counts == 2]
    inner, neighbors = both[on_line, 0], np.stack((both[on_line, 1], both[on_line + 1, 1]), axis=1)
    # Corners are found on the whole line, whoever may move, so that they do not depend on a selection.
    stays = _corners(points, inner, neighbors, points.shape[1])
    stays[pinned] = True
    free = ~stays[inner]
    return FeatureLines(vertices, inner[free], neighbors[free])


def smoothing_of(points: NDArray[np.floating], lines: FeatureLines, strength: float) -> NDArray[np.float64]:
    """Return the motion, shape (3, l), of the inner vertices of lines.

    Parameters
    ----------
    points : ndarray, shape (3, N)
        Noisy positions; not modified.
    lines : FeatureLines
        The lines.
    strength : float
        Factor of the largest motion.

    Returns
    -------
    ndarray, shape (3, l), float64
        In the unit of the positions; zero where the lines have no noise.
    """
    inner = lines.inner
    noise = line_noise(points, lines)
    if not len(inner) or noise == 0.0 or strength == 0.0:
        return np.zeros((3, len(inner)))
    # On all vertices of the lines; those that stay are their own neighbors.
    rank = np.full(points.shape[1], -1)
    rank[lines.vertices] = own = np.arange(len(lines.vertices))
    before, after = own.copy(), own.copy()
    moving = rank[inner]
    before[moving], after[moving] = rank[lines.neighbors].T
    start = points[:, lines.vertices].astype(np.float64)
    rest = high_pass(start, before, after, LOW_PASS_STEPS, LOW_PASS_ROUNDS)
    smooth = start - rest
    rest, before, after = rest[:, moving], before[moving], after[moving]
    along = smooth[:, after] - smooth[:, before]
    motion = -_across(rest, along)
    length = np.sqrt(np.einsum("cl,cl->l", motion, motion))
    limit = LARGEST_MOTION * strength * noise
    return motion * np.divide(limit, length, out=np.ones_like(length), where=length > limit)


def high_pass(
    points: NDArray[np.float64],
    before: NDArray[np.integer],
    after: NDArray[np.integer],
    steps: int,
    rounds: int,
) -> NDArray[np.float64]:
    """Return what the low-pass 1 - (1 - A^k)^m takes away from points of curves, shape (3, n).

    `before` and `after`, shape (n,), are the neighbors of each point on its curve, and itself where it stays;
    A is the mean of a point and of its two neighbors, k and m are `steps` and `rounds`.
    """
    rest = points
    for _ in range(rounds):
        smooth = rest
        for _ in range(steps):
            smooth = 0.5 * smooth + 0.25 * (smooth[:, before] + smooth[:, after])
        rest = rest - smooth
    return rest


def line_noise(points: NDArray[np.floating], lines: FeatureLines) -> float:
    """Return the root mean square of the noise across the lines, in the unit of the positions.

    From the median of squared fourth differences, of which a smooth line has next to nothing; where no line
    is long enough for one, of second differences.
    """
    if not len(lines.inner):
        return 0.0
    start = points.astype(np.float64)
    rank = np.full(points.shape[1], -1)
    rank[lines.inner] = np.arange(len(lines.inner))
    before, after = rank[lines.neighbors].T
    second = start[:, lines.neighbors].sum(axis=2) - 2.0 * start[:, lines.inner]
    along = start[:, lines.neighbors[:, 1]] - start[:, lines.neighbors[:, 0]]
    is_inside = (before >= 0) & (after >= 0)
    differences, scale = _across(second, along), 6.0
    if is_inside.any():
        fourth = second[:, before] + second[:, after] - 2.0 * second
        differences, scale = _across(fourth, along)[:, is_inside], 70.0
    squares = np.einsum("cl,cl->l", differences, differences)
    # 0.6 lies between the medians for noise in one direction, 0.45, and in the plane across the line, 0.69.
    return float(np.sqrt(np.median(squares) / (0.6 * scale)))


def _across(vectors: NDArray[np.float64], along: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return vectors, shape (3, l), without their parts along directions of any length."""
    squared = np.einsum("cl,cl->l", along, along)
    part = np.einsum("cl,cl->l", vectors, along)
    part = np.divide(part, squared, out=np.zeros_like(part), where=squared > 0.0)
    return vectors - part * along


def _corners(
    points: NDArray[np.floating], inner: NDArray[np.int64], neighbors: NDArray[np.int64], n_vertices: int
) -> NDArray[np.bool_]:
    """Return a mask, shape (N,), of the inner vertices at which a line has a corner."""
    rank = np.full(n_vertices, -1)
    rank[inner] = np.arange(len(inner))
    reached = []
    for side in (0, 1):
        last, here = inner, neighbors[:, side]
        for _ in range(CORNER_REACH - 1):
            place = rank[here]
            pair = neighbors[place]
            following = np.where(pair[:, 0] == last, pair[:, 1], pair[:, 0])
            last, here = np.where(place < 0, last, here), np.where(place < 0, here, following)
        reached.append(here)
    center = points[:, inner].astype(np.float64)
    turn = turning_angles(center - points[:, neighbors[:, 0]], points[:, neighbors[:, 1]] - center)
    wide = turning_angles(center - points[:, reached[0]], points[:, reached[1]] - center)
    at_vertex = np.zeros(n_vertices)
    at_vertex[inner] = turn
    is_corner = (wide > np.radians(CORNER_TURN)) & (turn > CORNER_SHARE * wide)
    is_corner &= turn >= at_vertex[neighbors].max(axis=1, initial=0.0)  # of neighbors the sharpest
    mask = np.zeros(n_vertices, bool)
    mask[inner[is_corner]] = True
    return mask


def turning_angles(arriving: NDArray[np.float64], leaving: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the angles between vectors, shape (l,), in radians; 0 where one of them is zero."""
    scale = np.sqrt((arriving * arriving).sum(axis=0) * (leaving * leaving).sum(axis=0))
    cosine = np.divide((arriving * leaving).sum(axis=0), scale, out=np.ones_like(scale), where=scale > 0.0)
    return np.arccos(np.clip(cosine, -1.0, 1.0))
