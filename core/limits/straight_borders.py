# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Open borders as smooth curves: what frays or zigzags along a border comes down to its course.

A border is a closed curve through its vertices. Its fray is what a narrow low-pass takes from it. Then the
curve takes the widest low-pass of a ladder that leaves no larger a rest than the fray: a straight border of
a sheet ends up straight, a round one round, and a smooth one stays as it is. Corners, which are found on
chords as long as the fray asks for, go to where the courses on both sides meet, and end them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .lines import high_pass, turning_angles

ROUNDS = 3
NARROW = 8
WIDER = (32, 128, 512)
"""m and all k of low-passes 1 - (1 - A^k)^m, where A is the mean of a vertex and of its two neighbors on the
curve: half of the height is lost by waves of 7 edges, and of twice as many with every step of the ladder."""

REST = 1.25
"""Rest of a wider low-pass, in units of the fray, up to which it counts as fray as well."""

LARGEST_MOTION = 4.0
"""Motion of a vertex, in units of the fray of its border."""

LEAST_FRAY = 0.02
"""Fray in lengths of the curve's steps from which a border is mended."""

LEAST_LENGTH = 12
"""Vertices of the shortest border that has a course."""

CORNER_TURN, CORNER_EXCESS = 55.0, 25.0
"""Degrees by which chords turn at a corner: at least the first, and by the second more than on a circle."""

LEAST_REACH, REACH_OF_FRAY, LONGEST_REACH = 8.0, 8.0, 24
"""Edges that a chord is long: the first, and as many more as the fray in steps of the curve
times the second."""


@dataclass(frozen=True, eq=False)
class BorderCurves:
    """The borders of a mesh as closed curves.

    Attributes
    ----------
    vertices : ndarray, shape (b,), int64
        Vertices on manifold borders, ascending.
    before, after : ndarray, shape (b,), int64
        Places in `vertices` of the neighbors on the curve; a vertex's own where the curve ends.
    curve : ndarray, shape (b,), int64
        Number of the curve of each.
    """

    vertices: NDArray[np.int64]
    before: NDArray[np.int64]
    after: NDArray[np.int64]
    curve: NDArray[np.int64]


def find_curves(boundary_neighbors: NDArray[np.integer]) -> BorderCurves:
    """Find the curves of borders.

    Parameters
    ----------
    boundary_neighbors : ndarray, shape (N, 2), int
        Neighbors of manifold border vertices along the border, one before and one after, else -1.

    Examples
    --------
    >>> curves = find_curves(np.array([[3, 1], [0, 2], [1, 3], [2, 0], [-1, -1]]))
    >>> curves.vertices.tolist(), curves.after.tolist(), curves.curve.tolist()
    ([0, 1, 2, 3], [1, 2, 3, 0], [0, 0, 0, 0])
    """
    vertices = np.flatnonzero((boundary_neighbors >= 0).all(axis=1)).astype(np.int64)
    place = np.full(len(boundary_neighbors), -1)
    place[vertices] = np.arange(len(vertices))
    before, after = place[boundary_neighbors[vertices]].T
    own = np.arange(len(vertices))
    ends = (before < 0) | (after < 0)
    before, after = np.where(ends, own, before), np.where(ends, own, after)
    curve, step, back = own.copy(), after.copy(), before.copy()
    for _ in range(max(len(vertices), 1).bit_length()):
        curve = np.minimum(curve, np.minimum(curve[step], curve[back]))
        step, back = step[step], back[back]
    return BorderCurves(vertices, before, after, np.unique(curve, return_inverse=True)[1].astype(np.int64))


def straightened(
    points: NDArray[np.floating], curves: BorderCurves, stays: NDArray[np.bool_]
) -> NDArray[Any]:
    """Return the motion of border vertices that makes their borders smooth.

    Parameters
    ----------
    points : ndarray, shape (3, N)
        Positions in any unit; not modified.
    curves : BorderCurves
        The borders.
    stays : ndarray, shape (N,), bool
        Vertices that may not move.

    Returns
    -------
    ndarray, shape (3, b), float64
        Zero on borders without fray, and on those with fewer than `LEAST_LENGTH` vertices.

    Examples
    --------
    A round border with a zigzag:

    >>> turn = np.linspace(0.0, 2.0 * np.pi, 60, endpoint=False)
    >>> radius = 60 / (2.0 * np.pi) + 0.3 * (-1.0) ** np.arange(60)
    >>> points = np.stack((radius * np.cos(turn), radius * np.sin(turn), 0.0 * turn))
    >>> around = (np.arange(60)[:, None] + [-1, 1]) % 60
    >>> moved = points + straightened(points, find_curves(around), np.zeros(60, bool))
    >>> bool(np.ptp(np.linalg.norm(moved, axis=0)) < 0.02)
    True
    """
    start = points[:, curves.vertices].astype(np.float64)
    if not start.size:
        return start
    curve, lengths = curves.curve, np.bincount(curves.curve)
    narrow = _low_pass(start, curves, NARROW)
    fray = _rms_of_curves(start - narrow, curves)
    # Edges of a frayed border are longer than its course.
    step = _rms_of_curves(0.5 * (narrow[:, curves.after] - narrow[:, curves.before]), curves)
    in_steps = np.divide(fray, step, out=np.zeros_like(fray), where=step > 0.0)
    reach = np.minimum(LEAST_REACH + REACH_OF_FRAY * in_steps, np.minimum(LONGEST_REACH, lengths / 10.0))
    course = _with_corners(start, curves, reach.astype(int)[curve])
    smooth = _low_pass(course.points, course.curves, NARROW)
    fray = np.minimum(fray, _rms_of_curves(start - smooth, curves))  # a corner is none
    for steps in WIDER:
        wider = _low_pass(course.points, course.curves, steps)
        fits = _rms_of_curves(start - wider, curves) <= REST * fray
        smooth = np.where(fits[curve], wider, smooth)
    motion = smooth - start
    limit = LARGEST_MOTION * fray[curve]
    length = np.sqrt(np.einsum("cb,cb->b", motion, motion))
    motion *= np.divide(limit, length, out=np.ones_like(length), where=length > limit)
    motion[:, (fray <= LEAST_FRAY * step)[curve] | (lengths < LEAST_LENGTH)[curve]] = 0.0
    motion[:, stays[curves.vertices]] = 0.0
    return motion


@dataclass(frozen=True, eq=False)
class _Course:
    """Curves that end at corners, and their points with corners where the courses beside them meet."""

    points: NDArray[np.float64]
    curves: BorderCurves


def _with_corners(start: NDArray[np.float64], curves: BorderCurves, reach: NDArray[np.integer]) -> _Course:
    """Find corners, put them where the courses on both sides meet, and let curves end there."""
    sides = []
    for following in (curves.before, curves.after):
        place, sums, moments, count = np.arange(start.shape[1]), 0.0 * start, 0.0 * start, 0.0 * start[0]
        for step in range(1, int(reach.max(initial=0)) + 1):
            place = following[place]
            counts = step <= reach
            sums += counts * start[:, place]
            moments += counts * step * start[:, place]
            count += counts
        # The straight line through so many points, by least squares over their numbers 1, 2, ...
        mean, middle = sums / np.maximum(count, 1.0), 0.5 * (count + 1.0)
        spread = count * (count**2 - 1.0) / 12.0
        slope = (moments - middle * sums) / np.where(spread > 0.0, spread, np.inf)
        sides.append((mean, slope, mean - middle * slope))
    (before, _, meeting_before), (after, _, meeting_after) = sides
    meeting = 0.5 * (meeting_before + meeting_after)
    turn = turning_angles(meeting - before, after - meeting)
    on_circle = 2.0 * np.pi * (reach + 1) / np.bincount(curves.curve)[curves.curve]
    least = np.maximum(np.radians(CORNER_TURN), np.radians(CORNER_EXCESS) + on_circle)
    is_corner = (turn > least) & (reach > 0)
    # Of corners within reach of each other the sharpest.
    highest = turn.copy()
    for _ in range(int(reach.max(initial=0))):
        highest = np.maximum(highest, np.maximum(highest[curves.before], highest[curves.after]))
    is_corner &= turn >= highest
    points = np.where(is_corner, meeting, start)
    own = np.arange(start.shape[1])
    split = BorderCurves(
        curves.vertices,
        np.where(is_corner, own, curves.before),
        np.where(is_corner, own, curves.after),
        curves.curve,
    )
    return _Course(points, split)


def _low_pass(points: NDArray[np.float64], curves: BorderCurves, steps: int) -> NDArray[np.float64]:
    """Return the points after the low-pass of `lines` with `ROUNDS`; ends of curves stay."""
    return points - high_pass(points, curves.before, curves.after, steps, ROUNDS)


def _rms_of_curves(vectors: NDArray[np.float64], curves: BorderCurves) -> NDArray[np.float64]:
    """Return the root mean square of vectors, shape (3, b), of each curve."""
    squares = np.bincount(curves.curve, np.einsum("cb,cb->b", vectors, vectors))
    return np.sqrt(squares / np.bincount(curves.curve))
