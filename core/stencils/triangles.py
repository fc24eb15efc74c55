# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Stencils of triangle lattices: seven taps (Fig. 1), or all nine of 3x3 (Fig. 3)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from .boundary import inner_means, set_mirrored, set_rim_pair
from .builder import StencilBuilder
from .mean import fill_mean
from .ring_points import RingPoints
from .straight import fill_straight

RING = ((-1, -1), (-1, 0), (0, 1), (1, 1), (1, 0), (0, -1))
"""Places of the one-ring in ring order; opposite is three places on."""

ACROSS = ((-1, 1), (1, -1))
"""Places across the ring edges 2-3 and 5-6."""


def fill_triangles(
    builder: StencilBuilder,
    vertices: NDArray[np.floating],
    ring_points: RingPoints,
    rule: str,
    boundary: str,
    blocks: Blocks,
) -> None:
    """Fill the taps of every vertex.

    A regular vertex, inside and with six triangles, takes its ring from the lowest-numbered neighbor on.

    Parameters
    ----------
    builder : StencilBuilder
        Receives the points.
    vertices : ndarray, shape (N, 3)
        Positions on which angles and lengths are measured.
    ring_points : RingPoints
        One-rings, at level 0 or dilated; with far ring points if the stencil has taps across ring edges.
    rule, boundary : str
        See `make_stencil`.
    """
    connectivity = ring_points.connectivity
    found = ring_points.is_found(blocks)
    is_regular = connectivity.is_regular_triangle()
    builder.is_irregular[:] = ~connectivity.is_loose & ~is_regular
    is_rim = connectivity.boundary_neighbors[:, 0] >= 0
    if boundary == "FREE":
        is_rim[:] = False
    regular = np.flatnonzero(found & is_regular)

    def fill_regular(start: int, stop: int) -> None:
        part = regular[start:stop]
        for place, points in zip(RING, ring_points.near_rows(part, 6), strict=True):
            builder.set(place, part, points)

    blocks.run(fill_regular, len(regular))
    _fill_rim(builder, ring_points, np.flatnonzero(found & is_rim), is_mean=rule == "MEAN")
    irregular = np.flatnonzero(found & ~is_regular & ~is_rim)
    unserved = irregular
    if rule == "STRAIGHT":
        unserved = fill_straight(builder, vertices, ring_points, irregular, RING, blocks)
    fill_mean(builder, ring_points.near, connectivity, unserved, RING)
    if builder.has(*ACROSS):
        assert ring_points.far is not None
        fill_mean(builder, ring_points.far, connectivity, irregular, ACROSS)
        rim = np.flatnonzero(found & is_rim)
        # The outermost two lie on the border or beyond; with three triangles one is left, the lattice's own.
        set_mirrored(builder, ACROSS[0], rim, inner_means(builder, ring_points.far, connectivity, rim, 3))
        _fill_across(builder, ring_points, regular)


def _fill_rim(
    builder: StencilBuilder, ring_points: RingPoints, wanted: NDArray[np.intp], *, is_mean: bool
) -> None:
    """Fill the taps of manifold boundary vertices.

    The boundary neighbors take the first pair. Of the ring between them two points take the next two taps: at
    regular valence the two that are there, else their mean (`is_mean`) or those a third from either end.
    Their mirror images take the taps opposite.
    """
    connectivity = ring_points.connectivity
    set_rim_pair(builder, ring_points, wanted, RING[0], RING[3])
    inside = connectivity.valence[wanted] - 2
    near = np.maximum((inside + 1) // 3, 1)
    means = inner_means(builder, ring_points.near, connectivity, wanted, 2)
    for place, position in ((RING[1], near), (RING[2], inside + 1 - near)):
        single = ring_points.near[connectivity.ring_offset[wanted] + np.maximum(position, 0)]
        takes_mean = (inside > 2) if is_mean else (inside < 1)
        set_mirrored(builder, place, wanted, np.where(takes_mean | (inside < 1), means, single))


def _fill_across(builder: StencilBuilder, ring_points: RingPoints, regular: NDArray[np.intp]) -> None:
    """Fill the taps across ring edges of regular vertices; near a border a missing one is mirrored."""
    far = ring_points.far_rows(regular, 6)
    for place, own, opposite in ((ACROSS[0], far[1], far[4]), (ACROSS[1], far[4], far[1])):
        if not builder.has(place):
            continue
        mirrored = (own < 0) & (opposite >= 0)
        builder.set(place, regular[own >= 0], own[own >= 0])
        builder.set(place, regular[mirrored], builder.add_mirrored(regular[mirrored], opposite[mirrored]))
