# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Stencils and corners of open borders.

At a boundary vertex V the missing points are mirrored, P' = 2 V - P, so that across the border there is
nothing to shrink; its two boundary neighbors form one straight pair, which smooths the border along itself.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..surface.connectivity import Connectivity
from .stencil import StencilBuilder

CORNER_TURN = 50.0
"""Degrees by which a border turns within the surface, from edge to edge, for a vertex to count as a corner."""


def fill_along_boundary(
    builder: StencilBuilder, connectivity: Connectivity, wanted: NDArray[np.intp], *, is_mean: bool
) -> None:
    """Fill the six slots of manifold boundary vertices.

    The boundary neighbors take the pair (1, 4). Of the ring between them two points take slots 2 and 3: at
    regular valence the two that are there, else their mean (`is_mean`) or those a third from either end. Their
    mirror images take slots 5 and 6.

    Parameters
    ----------
    builder : StencilBuilder
        Receives slots and mirrored points.
    connectivity : Connectivity
        One-rings; those of `wanted` are open.
    wanted : ndarray, shape (n,), intp
        Vertices to fill.
    is_mean : bool
        Whether orbits are replaced by their means.
    """
    inside = connectivity.valence[wanted] - 2
    builder.slots[0, wanted] = connectivity.boundary_neighbors[wanted, 0]
    builder.slots[3, wanted] = connectivity.boundary_neighbors[wanted, 1]
    begin = connectivity.ring_offset[wanted]
    chosen = inside > 0
    if is_mean:
        averaged = inside > 2
        _fill_mirrored_means(builder, connectivity, wanted[averaged])
        chosen &= ~averaged
    center, begin, inside = wanted[chosen], begin[chosen], inside[chosen]
    near = np.maximum((inside + 1) // 3, 1)
    for row, place in ((1, near), (2, inside + 1 - near)):
        point = connectivity.ring[begin + place]
        builder.slots[row, center] = point
        builder.slots[row + 3, center] = builder.add_combined(np.stack((center, point)), (2.0, -1.0))


def _fill_mirrored_means(
    builder: StencilBuilder, connectivity: Connectivity, wanted: NDArray[np.intp]
) -> None:
    """Fill slots 2, 3 with the mean of the inner ring and slots 5, 6 with its mirror image."""
    counts = (connectivity.valence[wanted] - 2).astype(np.int64)
    begin = np.repeat(connectivity.ring_offset[wanted] + 1 - (np.cumsum(counts) - counts), counts)
    members = connectivity.ring[begin + np.arange(len(begin))]
    builder.slots[1:3, wanted] = builder.add_ragged(members, counts)
    builder.slots[4:6, wanted] = builder.add_mirrored_means(wanted, members, counts)


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
