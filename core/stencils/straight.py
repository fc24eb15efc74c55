# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The STRAIGHT rule of Algorithm-Tri-2 at irregular vertices of triangle stencils (section 4.2)."""

from __future__ import annotations

from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..surface.connectivity import Connectivity
from .mean import fill_mean
from .stencil import StencilBuilder

HIGHEST_VALENCE = 1024
"""Above it the search over all pairs would take more memory than such a fan is worth; MEAN serves there."""

TIE = 2.0**-20
"""Angles (their cosines) and relative lengths closer than this count as equal; the first in ring order wins.

Rounding then does not decide on symmetric meshes, so that rotating one does not change its stencils."""


def fill_straight(
    builder: StencilBuilder,
    vertices: NDArray[np.floating],
    connectivity: Connectivity,
    wanted: NDArray[np.intp],
    blocks: Blocks,
) -> NDArray[np.intp]:
    """Fill the six slots of irregular vertices with straight pairs.

    Valence 5 and more: three pairs of ring vertices with the largest angles at the vertex. Valence 4 and 3:
    the ring is completed to six by midpoints of its longest edges, and opposite is three places on. Where the
    ring has no such edges (faces other than triangles, non-manifold spots) valence 4 gives two pairs by angle,
    and the mean of the ring fills the third.

    Parameters
    ----------
    builder : StencilBuilder
        Receives slots and midpoints.
    vertices : ndarray, shape (N, 3)
        Positions on which angles and lengths are measured.
    connectivity : Connectivity
        One-rings.
    wanted : ndarray, shape (n,), intp
        Vertices to fill.
    blocks : Blocks
        Threads to work on.

    Returns
    -------
    ndarray of intp
        Those of `wanted` that the rule cannot serve: fewer than three neighbors, fewer than four without
        edges between them, or more than `HIGHEST_VALENCE`.
    """
    valence = connectivity.valence[wanted]
    has_ring_edges = connectivity.all_triangles[wanted] & ~connectivity.is_non_manifold[wanted]
    is_completable = has_ring_edges & (valence >= 3) & (valence < 5)
    is_pairable = (valence >= 4) & (valence <= HIGHEST_VALENCE) & ~is_completable
    fill_mean(builder, connectivity, wanted[is_pairable & (valence == 4)])  # for the third pair
    for value in np.unique(valence[is_pairable]):
        group = wanted[is_pairable & (valence == value)]
        # Keep the table of pairs of one block in the cache.
        step = blocks.sized(max(1, 2**18 // (int(value) ** 2)))

        def kernel(start: int, stop: int, group: NDArray[np.intp] = group, value: int = int(value)) -> None:
            part = group[start:stop]
            pairs = _straight_pairs(vertices, part, connectivity.ring_rows(part, value))
            n_pairs = len(pairs) // 2
            builder.slots[:n_pairs, part] = pairs[:n_pairs]
            builder.slots[3 : 3 + n_pairs, part] = pairs[n_pairs:]

        step.run(kernel, len(group))
    for value in (4, 3):
        group = wanted[is_completable & (valence == value)]
        if len(group):
            builder.slots[:, group] = _completed_rings(builder, vertices, connectivity.ring_rows(group, value))
    return wanted[~is_pairable & ~is_completable]


def _straight_pairs(
    vertices: NDArray[np.floating], centers: NDArray[np.intp], rings: NDArray[np.int32]
) -> NDArray[np.int32]:
    """Choose straight pairs of each ring (K, n), K >= 4, greedily by largest angle.

    Returns the first vertices of the pairs, then the second ones: shape (6, n), or (4, n) for K = 4.
    """
    valence, n = rings.shape
    first, second = np.triu_indices(valence, 1)
    cosine = _pair_cosines(vertices, centers, rings, first, second)
    remaining = cosine.copy()
    columns = np.arange(n)
    chosen = []
    left = np.full(n, 10)  # the positions 0 to 4 of a ring of five sum to 10
    for _ in range(min(valence // 2, 3)):
        best = remaining.argmin(axis=0)
        a, b = first[best], second[best]
        chosen.append((a, b))
        left -= a + b
        used = (first[:, None] == a) | (first[:, None] == b) | (second[:, None] == a) | (second[:, None] == b)
        remaining[used] = np.inf
    if valence == 5:
        # The vertex left over is paired once more with the used one that makes the largest angle.
        cosine[(first[:, None] != left) & (second[:, None] != left)] = np.inf
        best = cosine.argmin(axis=0)
        chosen.append((first[best], second[best]))
    ends = [rings[a, columns] for a, _ in chosen] + [rings[b, columns] for _, b in chosen]
    return np.stack(ends)


def _pair_cosines(
    vertices: NDArray[np.floating],
    centers: NDArray[np.intp],
    rings: NDArray[np.int32],
    first: NDArray[np.intp],
    second: NDArray[np.intp],
) -> NDArray[np.float64]:
    """Return the cosine of the angle between each pair of spokes, in steps of `TIE`, shape (pairs, n)."""
    center = vertices[centers].T.astype(np.float64)
    spokes = vertices[rings].transpose(2, 0, 1) - center[:, None]
    length = np.sqrt(spokes[0] ** 2 + spokes[1] ** 2 + spokes[2] ** 2)
    spokes /= np.where(length > 0, length, 1.0)
    cosine = spokes[0, first] * spokes[0, second]
    cosine += spokes[1, first] * spokes[1, second]
    cosine += spokes[2, first] * spokes[2, second]
    return np.rint(cosine / TIE)


def _completed_rings(
    builder: StencilBuilder, vertices: NDArray[np.floating], rings: NDArray[np.int32]
) -> NDArray[np.int32]:
    """Insert midpoints of the longest ring edges until each ring (K, n), K = 3 or 4, has six; shape (6, n)."""
    valence, n = rings.shape
    points = vertices[rings].astype(np.float64)
    lengths = np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=2)
    longest = lengths.max(axis=0)
    lengths = np.rint(lengths / np.where(longest > 0, longest, 1.0) / TIE)
    chosen = np.sort(np.argsort(-lengths, axis=0, kind="stable")[: 6 - valence], axis=0)
    slots = np.empty((6, n), np.int32)
    for edges in combinations(range(valence), 6 - valence):
        columns = np.flatnonzero((chosen == np.array(edges)[:, None]).all(axis=0))
        row = 0
        for place in range(valence):
            slots[row, columns] = rings[place, columns]
            row += 1
            if place in edges:
                ends = rings[[place, (place + 1) % valence]][:, columns]
                slots[row, columns] = builder.add_combined(ends, (0.5, 0.5))
                row += 1
    return slots
