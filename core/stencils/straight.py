# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The STRAIGHT rule of Algorithm-Tri-2 at irregular vertices of triangle stencils (section 4.2)."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..mesh.geometry import coordinate_rows
from .builder import Place, StencilBuilder
from .mean import fill_mean
from .ring_points import RingPoints

HIGHEST_VALENCE = 1024
"""Above it the search over all pairs would take more memory than such a fan is worth; MEAN serves there."""

TIE = 2.0**-20
"""Angles (their cosines) and relative lengths closer than this count as equal.

Rounding then does not decide on symmetric meshes, so that rotating one does not change its stencils. Of equal
angles the pair with the shorter spokes wins, of equal spokes the first in ring order."""


WIDEST_CODE = 32
"""Rings up to this size have few enough pairs to choose them by arithmetic instead of by search."""

_CODES = 2**12


def fill_straight(
    builder: StencilBuilder,
    vertices: NDArray[np.floating],
    ring_points: RingPoints,
    wanted: NDArray[np.intp],
    places: Sequence[Place],
    blocks: Blocks,
) -> NDArray[np.intp]:
    """Fill the six taps of irregular vertices with straight pairs.

    Valence 5 and more: three pairs of ring vertices with the largest angles at the vertex. Valence 4 and 3:
    the ring is completed to six by midpoints of its longest edges, and opposite is three places on. Where the
    ring has no such edges (faces other than triangles, non-manifold spots) valence 4 gives two pairs by
    angle, and the mean of the ring fills the third.

    Parameters
    ----------
    builder : StencilBuilder
        Receives slots and midpoints.
    vertices : ndarray, shape (N, 3)
        Positions on which angles and lengths are measured.
    ring_points : RingPoints
        One-rings, at level 0 or dilated.
    wanted : ndarray, shape (n,), intp
        Vertices to fill; all have near ring_points.
    places : sequence of six (row, column)
        The ring of taps; opposite is three places on.

    Returns
    -------
    ndarray of intp
        Those of `wanted` that the rule cannot serve: fewer than three neighbors, fewer than four without
        edges between them, or more than `HIGHEST_VALENCE`.
    """
    connectivity = ring_points.connectivity

    def sort(start: int, stop: int) -> list[NDArray[np.intp]]:
        part = wanted[start:stop]
        valence = connectivity.valence[part]
        has_ring_edges = connectivity.all_triangles[part] & ~connectivity.is_non_manifold[part]
        is_completable = has_ring_edges & (valence >= 3) & (valence < 5)
        is_pairable = (valence >= 4) & (valence <= HIGHEST_VALENCE) & ~is_completable
        four, three = is_completable & (valence == 4), is_completable & (valence == 3)
        return [part[which] for which in (is_pairable, four, three, ~is_pairable & ~is_completable)]

    sorts = zip(*blocks.run(sort, len(wanted)), strict=True)
    pairable, four, three, unserved = map(np.concatenate, sorts) if len(wanted) else (wanted,) * 4
    third = pairable[connectivity.valence[pairable] == 4]
    fill_mean(builder, ring_points.near, connectivity, third, places)  # its third pair
    _fill_pairs(builder, coordinate_rows(vertices, blocks), ring_points, pairable, places, blocks)
    for value, group in ((4, four), (3, three)):
        if len(group):
            completed = complete_rings(builder, vertices, ring_points.near_rows(group, value), 6, blocks)
            for place, points in zip(places, completed, strict=True):
                builder.set(place, group, points)
    return unserved


def _fill_pairs(
    builder: StencilBuilder,
    points: NDArray[np.float64],
    ring_points: RingPoints,
    wanted: NDArray[np.intp],
    places: Sequence[Place],
    blocks: Blocks,
) -> None:
    """Put the pairs of `pair_positions` under the taps of vertices; `points` (3, N) are the positions."""

    def kernel(start: int, stop: int) -> None:
        valence = ring_points.connectivity.valence[wanted[start:stop]]
        for value in map(int, np.flatnonzero(np.bincount(valence))):
            group = wanted[start:stop][valence == value]
            size = max(1, 2**18 // value**2)  # so that the table of pairs stays in the cache
            for begin in range(0, len(group), size):
                part = group[begin : begin + size]
                rings, columns = ring_points.near_rows(part, value), np.arange(len(part))
                for number, (one, two) in enumerate(pair_positions(points, part, rings, min(value // 2, 3))):
                    builder.set(places[number], part, rings[one, columns])
                    builder.set(places[number + 3], part, rings[two, columns])

    blocks.run(kernel, len(wanted))


def pair_positions(
    points: NDArray[np.float64], centers: NDArray[np.intp], rings: NDArray[np.int32], n_pairs: int
) -> list[tuple[NDArray[np.intp], NDArray[np.intp]]]:
    """Choose pairs of ring vertices greedily by largest angle at the center, each ring vertex once.

    Parameters
    ----------
    points : ndarray, shape (3, N), float64
        Positions, coordinates in rows.
    centers : ndarray, shape (n,), intp
        Center vertices.
    rings : ndarray, shape (K, n), int32
        Their rings.
    n_pairs : int
        Number of pairs, at most K // 2. In a ring of five the vertex left over is paired once more with the
        used one that makes the largest angle.

    Returns
    -------
    list of (first, second)
        For each pair the places of its vertices in the rings, shape (n,) each.
    """
    valence = len(rings)
    first, second = np.triu_indices(valence, 1)
    ranks = _pair_ranks(points, centers, rings)
    if valence > WIDEST_CODE:
        return _choose_by_search(ranks, n_pairs, first, second)
    # The number of a pair in the last bits, so that the least value tells which pair it is.
    ranks *= _CODES / TIE
    ranks += np.arange(len(ranks))[:, None]
    ends = ((1 << first) | (1 << second)).astype(np.uint32)[:, None]
    chosen = []
    used = np.zeros(rings.shape[1], np.uint32)
    free = ranks
    for _ in range(n_pairs):
        best = free.min(axis=0).astype(np.int64) & (_CODES - 1)
        chosen.append((first[best], second[best]))
        used |= ends[best, 0]
        if len(chosen) < n_pairs:
            free = np.where(ends & used, np.inf, ranks)
    if valence == 5:
        free = np.where(ends & ~used, ranks, np.inf)  # four are used: pairs with the one left over
        best = free.min(axis=0).astype(np.int64) & (_CODES - 1)
        chosen.append((first[best], second[best]))
    return chosen


def _choose_by_search(
    ranks: NDArray[np.float64], n_pairs: int, first: NDArray[np.intp], second: NDArray[np.intp]
) -> list[tuple[NDArray[np.intp], NDArray[np.intp]]]:
    """Return the ring positions of the pairs of lowest rank, each position once, on rings of any size."""
    chosen = []
    for _ in range(n_pairs):
        best = ranks.argmin(axis=0)
        a, b = first[best], second[best]
        chosen.append((a, b))
        used = (first[:, None] == a) | (first[:, None] == b) | (second[:, None] == a) | (second[:, None] == b)
        ranks[used] = np.inf
    return chosen


def _pair_ranks(
    points: NDArray[np.float64], centers: NDArray[np.intp], rings: NDArray[np.int32]
) -> NDArray[np.float64]:
    """Rank all pairs of spokes by the cosine of their angle, then by their length, shape (pairs, n).

    The cosine is in whole steps of `TIE`; the length takes what is behind the point.
    """
    spokes = points.take(rings, axis=1, mode="clip")
    spokes -= points.take(centers, axis=1)[:, None]
    length = np.sqrt(spokes[0] ** 2 + spokes[1] ** 2 + spokes[2] ** 2)
    reach = length.max(axis=0)
    spokes /= np.where(length > TIE * reach, length, np.inf)  # a shorter one has its direction by rounding
    reach = 1.0 / np.where(reach > 0, 4.0 * TIE * reach, 1.0)
    length *= reach
    valence, n = rings.shape
    ranks = np.empty((valence * (valence - 1) // 2, n))
    begin = 0
    for one in range(valence - 1):
        part = ranks[begin : begin + valence - 1 - one]
        begin += len(part)
        products = spokes[:, one, None] * spokes[:, one + 1 :]
        np.add(products[0], products[1], out=part)
        part += products[2]
        part *= 1.0 / TIE
        np.rint(part, out=part)
        lengths = np.add(length[one], length[one + 1 :], out=products[0])
        np.rint(lengths, out=lengths)
        lengths *= TIE
        part += lengths
    return ranks


def complete_rings(
    builder: StencilBuilder,
    vertices: NDArray[np.floating],
    rings: NDArray[np.int32],
    size: int,
    blocks: Blocks | None = None,
) -> list[NDArray[np.int32]]:
    """Insert midpoints of the longest ring edges until rings have the wanted size.

    Parameters
    ----------
    builder : StencilBuilder
        Receives the midpoints.
    vertices : ndarray, shape (N, 3)
        Positions.
    rings : ndarray, shape (K, n), int32
        Closed rings of vertices.
    size : int
        Wanted number of points, at least K and at most 2 K.

    Returns
    -------
    list of ndarray, shape (n,), int32
        The points in ring order.
    """
    valence, n = rings.shape
    parts = (blocks or Blocks(1)).run(
        lambda start, stop: longest_edges(vertices, rings[:, start:stop], size - valence), n
    )
    chosen = np.concatenate(parts) if parts else np.zeros(0, np.int32)
    completed = np.empty((size, n), np.int32)
    for edges in combinations(range(valence), size - valence):
        columns = np.flatnonzero(chosen == sum(1 << edge for edge in edges))
        own = rings.take(columns, axis=1)
        row = 0
        for place in range(valence):
            completed[row, columns] = own[place]
            row += 1
            if place in edges:
                ends = own[[place, (place + 1) % valence]]
                completed[row, columns] = builder.add_combined(ends, (0.5, 0.5))
                row += 1
    return list(completed)


def longest_edges(
    vertices: NDArray[np.floating], rings: NDArray[np.int32], n_edges: int
) -> NDArray[np.int32]:
    """Return the longest edges of rings, the first of equals, as a number with a bit for each, shape (n,).

    Parameters
    ----------
    vertices : ndarray, shape (N, 3)
        Positions.
    rings : ndarray, shape (K, n), int32
        Closed rings; edge k runs from point k to the next one.
    n_edges : int
        How many to choose.
    """
    valence = len(rings)
    corners = vertices.take(rings, axis=0, mode="clip").transpose(2, 0, 1).astype(np.float64, order="C")
    steps = np.roll(corners, -1, axis=1)
    steps -= corners
    steps *= steps
    lengths = np.sqrt(steps.sum(axis=0))
    longest = lengths.max(axis=0)
    lengths /= np.where(longest > 0, longest, 1.0)
    lengths /= TIE
    np.rint(lengths, out=lengths)
    chosen = np.zeros(rings.shape[1], np.int32)
    for edge in range(valence):
        rank = np.zeros(len(chosen), np.int8)
        for other in range(valence):
            if other != edge:
                is_before = np.greater_equal if other < edge else np.greater
                rank += is_before(lengths[other], lengths[edge])
        chosen |= np.where(rank < n_edges, np.int32(1 << edge), np.int32(0))
    return chosen
