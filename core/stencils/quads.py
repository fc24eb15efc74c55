# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Stencils of quad lattices with the nine taps of Fig. 7."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from .boundary import inner_means, set_mirrored, set_rim_pair
from .builder import StencilBuilder
from .mean import fill_mean
from .ring_points import RingPoints
from .straight import HIGHEST_VALENCE, complete_rings, pair_positions

NEAR = ((0, -1), (-1, 0), (0, 1), (1, 0))
"""Places of the edge neighbors in ring order, the odd slots."""

FAR = ((-1, -1), (-1, 1), (1, 1), (1, -1))
"""Places of the far corners in ring order, the even slots; FAR[i] lies between NEAR[i] and NEAR[i + 1]."""


def fill_quads(
    builder: StencilBuilder,
    vertices: NDArray[np.floating],
    ring_points: RingPoints,
    rule: str,
    boundary: str,
    blocks: Blocks,
) -> None:
    """Fill the taps of every vertex.

    A regular vertex, inside and with four quads, takes its ring from the lowest-numbered neighbor on.

    Parameters
    ----------
    builder : StencilBuilder
        Receives the points.
    vertices : ndarray, shape (N, 3)
        Positions on which angles and lengths are measured.
    ring_points : RingPoints
        Edge neighbors and far corners, at level 0 or dilated.
    rule, boundary : str
        See `make_stencil`.
    """
    assert ring_points.far is not None
    connectivity = ring_points.connectivity
    found = ring_points.is_found()
    is_regular = connectivity.is_regular_quad()
    builder.is_irregular[:] = ~connectivity.is_loose & ~is_regular
    is_rim = connectivity.boundary_neighbors[:, 0] >= 0
    if boundary == "FREE":
        is_rim[:] = False
    regular = np.flatnonzero(found & is_regular)
    for places, rows in ((NEAR, ring_points.near_rows(regular, 4)), (FAR, ring_points.far_rows(regular, 4))):
        for place, points in zip(places, rows, strict=True):
            builder.set(place, regular, points)
    _fill_rim(builder, ring_points, np.flatnonzero(found & is_rim))
    irregular = np.flatnonzero(found & ~is_regular & ~is_rim)
    if rule == "STRAIGHT":
        irregular = _fill_straight(builder, vertices, ring_points, irregular, blocks)
    fill_mean(builder, ring_points.near, connectivity, irregular, NEAR)
    # Without a quad there is no far corner; the mean of the ring keeps those taps on the surface.
    without = fill_mean(builder, ring_points.far, connectivity, irregular, FAR)
    fill_mean(builder, ring_points.near, connectivity, without, FAR)


def _fill_rim(builder: StencilBuilder, ring_points: RingPoints, wanted: NDArray[np.intp]) -> None:
    """Fill the taps of manifold boundary vertices: what lies inside, and its mirror image outside.

    With two quads these are the lattice's own points; with another number their means.
    """
    assert ring_points.far is not None
    connectivity = ring_points.connectivity
    set_rim_pair(builder, ring_points, wanted, NEAR[0], NEAR[2])
    set_mirrored(builder, NEAR[1], wanted, inner_means(builder, ring_points.near, connectivity, wanted, 2))
    offset = connectivity.ring_offset[wanted]
    is_pair = connectivity.all_quads[wanted] & (connectivity.valence[wanted] == 3)
    pair = wanted[is_pair]
    for place, step in ((FAR[0], 0), (FAR[1], 1)):
        set_mirrored(builder, place, pair, ring_points.far[offset[is_pair] + step])
    other = wanted[~is_pair]
    points, is_filled = builder.add_means(ring_points.far, offset[~is_pair], connectivity.valence[other])
    for place in FAR[:2]:
        set_mirrored(builder, place, other[is_filled], points)


def _fill_straight(
    builder: StencilBuilder,
    vertices: NDArray[np.floating],
    ring_points: RingPoints,
    wanted: NDArray[np.intp],
    blocks: Blocks,
) -> NDArray[np.intp]:
    """Fill taps by the rule of Algorithm-Quad-2 (section 5.4, Fig. 10).

    Valence 5 and more: of the 2 K vertices around, four pairs by largest angle are kept in ring order.
    Valence 3: the six are completed by the midpoints of the two longest rim edges. Of the eight spokes, the
    four alternating ones whose total length is larger are dropped: they lead to the far corners.

    Returns those of `wanted` that the rule cannot serve: other valences, or faces other than quads.
    """
    connectivity = ring_points.connectivity
    valence = connectivity.valence[wanted]
    is_served = connectivity.all_quads[wanted] & ~connectivity.is_non_manifold[wanted]
    is_served &= ~connectivity.is_boundary[wanted]
    is_served &= (valence == 3) | ((valence >= 5) & (valence <= HIGHEST_VALENCE // 2))
    coordinates = np.ascontiguousarray(vertices.T, np.float64)
    for value in np.unique(valence[is_served]):
        group = wanted[is_served & (valence == value)]
        if value == 3:
            ring = _rim(ring_points, group, 3)
            _set_alternating(builder, vertices, group, np.stack(complete_rings(builder, vertices, ring, 8)))
            continue

        def kernel(start: int, stop: int, group: NDArray[np.intp] = group, value: int = int(value)) -> None:
            part = group[start:stop]
            ring = _rim(ring_points, part, value)
            positions = pair_positions(coordinates, part, ring, 4)
            kept = np.sort(np.stack([place for pair in positions for place in pair]), axis=0)
            _set_alternating(builder, vertices, part, np.take_along_axis(ring, kept, axis=0))

        blocks.with_block_size(max(1, 2**18 // (4 * int(value) ** 2))).run(kernel, len(group))
    return wanted[~is_served]


def _rim(ring_points: RingPoints, group: NDArray[np.intp], valence: int) -> NDArray[np.int32]:
    """Return near and far ring points in turn, shape (2 * valence, n)."""
    rim = np.empty((2 * valence, len(group)), np.int32)
    rim[0::2] = ring_points.near_rows(group, valence)
    rim[1::2] = ring_points.far_rows(group, valence)
    return rim


def _set_alternating(
    builder: StencilBuilder, vertices: NDArray[np.floating], group: NDArray[np.intp], ring: NDArray[np.int32]
) -> None:
    """Put the alternating four of eight ring points (8, n) with the shorter spokes near, the others far."""
    points = builder.positions(vertices, ring)
    lengths = np.linalg.norm(points - vertices[group].astype(np.float64), axis=2)
    is_turned = lengths[0::2].sum(axis=0) > lengths[1::2].sum(axis=0) * (1.0 + 1e-9)
    ring = np.where(is_turned, np.roll(ring, -1, axis=0), ring)
    for step in range(4):
        builder.set(NEAR[step], group, ring[2 * step])
        builder.set(FAR[step], group, ring[2 * step + 1])
