# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Stencils of masks wider than 3x3 and of cell-centered masks, filled by walking the grid (3.3, 5.3)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..frames import FilterBank
from ..mesh.connectivity import Connectivity
from ..mesh.ragged import starts, stretches
from ..mesh.surface_mesh import SurfaceMesh
from .builder import Place, StencilBuilder
from .cells import fill_cells, find_cells
from .grid import Grid, Steps
from .quads import NEAR
from .stencil import Stencil
from .triangles import RING


def make_grid_stencil(
    surface: SurfaceMesh, connectivity: Connectivity, boundary: str, bank: FilterBank, level: int
) -> Stencil:
    """Choose the points under the masks of a wide or cell-centered bank; see `make_stencil`.

    The taps of level l are 2^l edges apart. Around a cell that can only be so at level 0; the taps of coarser
    levels lie evenly around a vertex, at odd multiples of 2^(l - 1), and so their coefficients live on
    vertices.
    """
    grid = Grid(connectivity, surface.vertices)
    if bank.is_cell_centered and level == 0:
        cells = find_cells(surface, with_triangles=bank.lattice != "QUADS")
        builder = StencilBuilder(surface.n_vertices, bank.offsets, len(cells.corners))
        fill_cells(builder, grid, connectivity, cells, bank)
        return builder.finish()
    places = bank.offsets * 2**level
    if bank.is_cell_centered:
        places = (2 * bank.offsets - 1) * 2 ** (level - 1)
    builder = StencilBuilder(surface.n_vertices, places, is_vertex_centered=not bank.is_cell_centered)
    is_triangular = connectivity.all_triangles | (bank.lattice == "TRIANGLES")
    if bank.lattice == "QUADS":
        is_triangular[:] = False
    for ring, chosen in ((RING, is_triangular), (NEAR, ~is_triangular)):
        _fill(builder, grid, connectivity, chosen & ~connectivity.is_loose, ring, boundary)
    return builder.finish()


def _fill(
    builder: StencilBuilder,
    grid: Grid,
    connectivity: Connectivity,
    chosen: NDArray[np.bool_],
    ring: tuple[Place, ...],
    boundary: str,
) -> None:
    """Fill the taps of the chosen vertices, on the lattice whose directions are `ring`."""
    n_directions = len(ring)
    is_regular = chosen & (
        connectivity.is_regular_triangle() if n_directions == 6 else connectivity.is_regular_quad()
    )
    is_rim = chosen & (connectivity.boundary_neighbors[:, 0] >= 0)
    if boundary == "FREE":
        is_rim[:] = False
    builder.is_irregular |= chosen & ~is_regular
    regular = np.flatnonzero(is_regular)
    _fill_directed(
        builder, grid, regular, connectivity.ring_offset[regular] + np.arange(n_directions)[:, None], ring
    )
    rim = np.flatnonzero(is_rim)
    _fill_directed(builder, grid, rim, _rim_directions(connectivity, rim, n_directions), ring)
    _fill_orbit_means(builder, grid, connectivity, np.flatnonzero(chosen & ~is_regular & ~is_rim), ring)


def _rim_directions(connectivity: Connectivity, rim: NDArray[np.intp], n_directions: int) -> Steps:
    """Return steps in each direction from boundary vertices, -1 across the border, shape (directions, n).

    The border takes a pair of opposite directions; the inner ones are spread evenly over the ring between.
    """
    inside = connectivity.valence[rim] - 2
    directions = np.full((n_directions, len(rim)), -1)
    half = n_directions // 2
    directions[0] = connectivity.ring_offset[rim]
    directions[half] = connectivity.ring_offset[rim] + connectivity.valence[rim] - 1
    if half == 2:
        middle = connectivity.ring_offset[rim] + 1 + np.maximum(inside - 1, 0) // 2
        directions[1] = np.where(inside > 0, middle, -1)
    else:
        near = np.maximum((inside + 1) // 3, 1)
        directions[1] = np.where(inside > 0, connectivity.ring_offset[rim] + near, -1)
        directions[2] = np.where(inside > 0, connectivity.ring_offset[rim] + inside + 1 - near, -1)
    return directions


def _sector_of(place: Place, ring: tuple[Place, ...]) -> tuple[int, int, int]:
    """Write a place as a * ring[s] + b * ring[s + 1] with a > 0, b >= 0; return s, a, b."""
    for s, (first, second) in enumerate(zip(ring, (*ring[1:], ring[0]), strict=True)):
        determinant = first[0] * second[1] - first[1] * second[0]
        a = (place[0] * second[1] - place[1] * second[0]) // determinant
        b = (first[0] * place[1] - first[1] * place[0]) // determinant
        if a > 0 and b >= 0:
            return s, a, b
    raise AssertionError(f"{place} lies in no sector")


def _fill_directed(
    builder: StencilBuilder, grid: Grid, sites: NDArray[np.intp], directions: Steps, ring: tuple[Place, ...]
) -> None:
    """Fill every tap by walking into its sector; what is missing is mirrored, or the vertex itself."""
    swing = 2 if len(ring) == 6 else 1
    found: dict[Place, tuple[NDArray[np.int64], NDArray[np.int64]]] = {}

    def walk_to(place: Place) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        if place not in found:
            s, a, b = _sector_of(place, ring)
            found[place] = grid.sector(directions[s], directions[(s + 1) % len(ring)], swing, a, b)
        return found[place]

    for place in builder.row_of:
        if place == (0, 0):
            continue
        own = builder.add_midpoints(*walk_to(place))
        is_own = own >= 0
        builder.set(place, sites[is_own], own[is_own])
        missing = np.flatnonzero(~is_own)
        if len(missing):
            one, two = walk_to((-place[0], -place[1]))
            opposite = builder.add_midpoints(one[missing], two[missing])
            is_opposite = opposite >= 0
            mirrored = sites[missing[is_opposite]]
            builder.set(place, mirrored, builder.add_mirrored(mirrored, opposite[is_opposite]))


def _fill_orbit_means(
    builder: StencilBuilder,
    grid: Grid,
    connectivity: Connectivity,
    sites: NDArray[np.intp],
    ring: tuple[Place, ...],
) -> None:
    """Fill every tap of irregular vertices with the mean over its orbit: all walks of its shape."""
    sites = sites[connectivity.valence[sites] >= 2]
    counts = connectivity.valence[sites]
    front = starts(counts)
    spokes = stretches(connectivity.ring_offset[sites], counts)
    swing = 2 if len(ring) == 6 else 1
    means: dict[tuple[int, int], tuple[NDArray[np.int32], NDArray[np.bool_]]] = {}
    for place in builder.row_of:
        if place == (0, 0):
            continue
        _, a, b = _sector_of(place, ring)
        orbit = (max(a, b), min(a, b))
        if orbit not in means:
            walks = grid.orbit(spokes, swing, *orbit)
            values = np.stack(walks, axis=1).ravel().astype(np.int32)
            means[orbit] = builder.add_means(values, front * len(walks), counts * len(walks))
        points, is_filled = means[orbit]
        builder.set(place, sites[is_filled], points)
