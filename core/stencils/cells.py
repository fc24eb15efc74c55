# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Cells and their stencils: quads, and pairs of triangles with their common edge as the diagonal."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..frames import FilterBank
from ..frames.filter_bank import CELL_CORNERS
from ..mesh.connectivity import Connectivity
from ..mesh.half_edges import find_half_edges
from ..mesh.ragged import starts, stretches
from ..mesh.surface_mesh import SurfaceMesh
from .builder import StencilBuilder
from .grid import Grid


class Cells(NamedTuple):
    """Cells of a mesh: first the quads, then the pairs of triangles.

    Attributes
    ----------
    corners : ndarray, shape (n_cells, 4), int32
        Corner vertices in order around the cell, at the places `CELL_CORNERS`. A quad starts at its
        lowest-numbered vertex, a pair at the lower-numbered end of its common edge.
    owner : ndarray, shape (n_cells,), int32
        The face of a quad cell, the edge of a pair of triangles.
    n_quads : int
        Number of quad cells.
    """

    corners: NDArray[np.int32]
    owner: NDArray[np.int32]
    n_quads: int


def find_cells(surface: SurfaceMesh, *, with_triangles: bool) -> Cells:
    """Find the cells of a mesh: its quads and, if wanted, its interior edges between two triangles."""
    sizes = surface.face_sizes()
    quads = np.flatnonzero(sizes == 4).astype(np.int32)
    corners = surface.corner_vertex[surface.face_offset[:-1][quads, None] + np.arange(4)]
    first = corners.argmin(axis=1)
    corners = np.take_along_axis(corners, (first[:, None] + np.arange(4)) % 4, axis=1)
    if not with_triangles:
        return Cells(corners, quads, len(quads))
    half_edges = find_half_edges(surface)
    partner, vertex = half_edges.partner, surface.corner_vertex
    size = np.repeat(sizes, sizes)
    start, stop = vertex, vertex[half_edges.next_corner]
    corner = np.arange(surface.n_corners)
    # Of the two half-edges of a pair, the one from the lower-numbered end; of two alike, the first.
    is_rising, other_rises = start < stop, (start < stop)[partner]
    is_first = np.where(is_rising == other_rises, corner < partner, is_rising)
    h = np.flatnonzero((partner >= 0) & (size == 3) & (size[partner] == 3) & is_first)
    left, right = vertex[half_edges.previous_corner[h]], vertex[half_edges.previous_corner[partner[h]]]
    pairs = np.stack((np.minimum(start[h], stop[h]), right, np.maximum(start[h], stop[h]), left), axis=1)
    return Cells(
        np.concatenate((corners, pairs)), np.concatenate((quads, surface.corner_edge[h])), len(quads)
    )


def fill_cells(
    builder: StencilBuilder, grid: Grid, connectivity: Connectivity, cells: Cells, bank: FilterBank
) -> None:
    """Fill the taps of every cell: its corners, and what lies straight out through them.

    Parameters
    ----------
    builder : StencilBuilder
        Receives the points.
    grid : Grid
        Walks on the mesh.
    connectivity : Connectivity
        One-rings.
    cells : Cells
        The cells.
    bank : FilterBank
        Cell-centered masks.
    """
    everything = np.arange(len(cells.corners))
    for place, corner in zip(CELL_CORNERS, cells.corners.T, strict=True):
        builder.set(place, everything, corner)
    is_quad = everything < cells.n_quads
    for k in range(4):
        # Around the common edge of two triangles the ways out of its ends are two spokes apart.
        for sites, swing in ((everything[is_quad], 1), (everything[~is_quad], 1 if k % 2 == 0 else 2)):
            _fill_corner(builder, grid, connectivity, cells.corners[sites], sites, k, swing, bank.reach)


def _fill_corner(
    builder: StencilBuilder,
    grid: Grid,
    connectivity: Connectivity,
    corners: NDArray[np.int32],
    sites: NDArray[np.intp],
    k: int,
    swing: int,
    reach: int,
) -> None:
    """Fill the taps beyond corner k of cells."""
    here, ahead, behind = corners[:, k], corners[:, (k + 1) % 4], corners[:, k - 1]
    first = grid.march(grid.find(ahead, here), 1)
    second = grid.march(grid.find(behind, here), 1)
    is_extraordinary = connectivity.is_irregular() & ~connectivity.is_boundary & ~connectivity.is_non_manifold
    is_extraordinary = is_extraordinary[here]
    origin, from_ahead, from_behind = (np.array(CELL_CORNERS[i % 4]) for i in (k, k + 1, k - 1))
    for a in range(reach + 1):
        for b in range(reach + 1):
            place = tuple((origin + a * (origin - from_ahead) + b * (origin - from_behind)).tolist())
            if a == b == 0 or not builder.has(place):
                continue
            one, two = grid.sector(first, second, swing, a, b)
            points = builder.add_midpoints(one, two)
            _set_orbit_means(builder, grid, connectivity, corners, k, is_extraordinary, (a, b, swing), points)
            missing = points < 0
            # The mirror image, in the corner, of the tap as far inside; where that is none, the corner.
            inside = tuple((2 * origin - np.array(place)).tolist())
            inner = corners[:, CELL_CORNERS.index(inside)] if inside in CELL_CORNERS else here
            points[missing] = builder.add_mirrored(here[missing], inner[missing])
            builder.set(place, sites, points)


def _set_orbit_means(
    builder: StencilBuilder,
    grid: Grid,
    connectivity: Connectivity,
    corners: NDArray[np.int32],
    k: int,
    wanted: NDArray[np.bool_],
    walk: tuple[int, int, int],
    points: NDArray[np.int32],
) -> None:
    """Replace points beyond extraordinary corners by the mean over all ways out, in place."""
    cells = np.flatnonzero(wanted)
    here = corners[cells, k]
    counts = connectivity.valence[here]
    front = starts(counts)
    spokes = stretches(connectivity.ring_offset[here], counts)
    row = np.repeat(cells, counts)
    target = connectivity.ring[spokes]
    is_way_out = (target != corners[row, (k + 1) % 4]) & (target != corners[row, k - 1])
    spokes[~is_way_out] = -1
    a, b, swing = walk
    walks = grid.orbit(spokes, swing, max(a, b), min(a, b))
    values = np.stack(walks, axis=1).ravel().astype(np.int32)
    means, is_filled = builder.add_means(values, front * len(walks), counts * len(walks))
    points[cells[is_filled]] = means
