# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Stencils and corners of open borders.

At a boundary vertex V the missing points are mirrored, P' = 2 V - P, so that across the border there is
nothing to shrink; its two boundary neighbors form one straight pair, which smooths the border along itself.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..mesh.connectivity import Connectivity
from .builder import Place, StencilBuilder
from .ring_points import RingPoints


def set_rim_pair(
    builder: StencilBuilder, ring_points: RingPoints, wanted: NDArray[np.intp], first: Place, last: Place
) -> None:
    """Put the two ring points along the border, the ends of open rings, under a pair of opposite taps."""
    offset = ring_points.connectivity.ring_offset
    builder.set(first, wanted, ring_points.near[offset[wanted]])
    builder.set(last, wanted, ring_points.near[offset[wanted + 1] - 1])


def set_mirrored(
    builder: StencilBuilder, place: Place, wanted: NDArray[np.intp], points: NDArray[np.integer]
) -> None:
    """Put points under a tap and their mirror images under the opposite one, as far as there are taps."""
    opposite = (-place[0], -place[1])
    builder.set(place, wanted, points)
    if builder.has(opposite):
        builder.set(opposite, wanted, builder.add_mirrored(wanted, points))


def inner_means(
    builder: StencilBuilder,
    values: NDArray[np.int32],
    connectivity: Connectivity,
    wanted: NDArray[np.intp],
    n_outer: int,
) -> NDArray[np.int32]:
    """Return means over open rings without their ends; the vertex itself where nothing is left.

    `n_outer` entries are left out: 2 of the near ring points, 3 of the far ones, of which there is one less.
    """
    counts = np.maximum(connectivity.valence[wanted] - n_outer, 0)
    points, is_filled = builder.add_means(values, connectivity.ring_offset[wanted] + 1, counts)
    result = wanted.astype(np.int32)
    result[is_filled] = points
    return result


CORNER_TURN = 50.0
"""Degrees by which a border turns within the surface, from edge to edge, to count as a corner."""


def boundary_corners(
    vertices: NDArray[np.floating], normals: NDArray[np.floating], connectivity: Connectivity
) -> NDArray[np.intp]:
    """Find the boundary vertices at which the border turns by more than `CORNER_TURN`.

    Smoothing a border along itself would round its corners off, even on a flat sheet; so their vertices may
    move along their normals only. The turn is measured in the tangent plane, which most noise does not touch.

    Parameters
    ----------
    vertices, normals : ndarray, shape (N, 3)
        Positions and unit vertex normals.
    connectivity : Connectivity
        Boundary neighbors.

    Returns
    -------
    ndarray of intp
        Corner vertices, ascending.
    """
    rim = np.flatnonzero(connectivity.boundary_neighbors[:, 0] >= 0)
    before, after = connectivity.boundary_neighbors[rim].T
    center, normal = vertices[rim].astype(np.float64), normals[rim]
    arriving, leaving = center - vertices[before], vertices[after] - center
    for edge in (arriving, leaving):
        edge -= normal * np.einsum("ni,ni->n", edge, normal)[:, None]
    scale = np.linalg.norm(arriving, axis=1) * np.linalg.norm(leaving, axis=1)
    return rim[np.einsum("ni,ni->n", arriving, leaving) < np.cos(np.radians(CORNER_TURN)) * scale]
