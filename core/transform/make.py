# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Choosing the stencils of every level on a surface."""

from __future__ import annotations

import numpy as np
from numpy.typing import DTypeLike, NDArray

from ..arguments import as_identifier
from ..blocks import Blocks
from ..errors import FrameError
from ..frames import BANKS, FilterBank
from ..frames.valence_masks import FAMILIES
from ..mesh.connectivity import Connectivity, check_connectivity, connect_agreeing
from ..mesh.distance_rings import distance_rings, edge_adjacency, face_adjacency
from ..mesh.surface_mesh import SurfaceMesh
from ..precision import as_precision
from ..stencils import make_stencil
from ..stencils.dilation import dilate
from ..stencils.make import BOUNDARIES, RULES
from ..stencils.ring_points import one_ring_points
from ..value_checks import check_choice, check_number
from .adaptive_level import AdaptiveLevel, Neighbors, ring_neighbors
from .frame_transform import FrameTransform
from .lattice_level import LatticeLevel
from .level import Bands


def make_transform(
    surface: SurfaceMesh,
    frame: str | FilterBank = "AUTO",
    stencil: str = "STRAIGHT",
    levels: int = 1,
    *,
    boundary: str = "ALONG",
    connectivity: Connectivity | None = None,
    blocks: Blocks | None = None,
    dtype: DTypeLike = np.float64,
    only_used_bands: bool = False,
) -> FrameTransform:
    """Choose the stencils of every level on a surface and freeze them.

    Parameters
    ----------
    surface : SurfaceMesh
        The surface; not modified. The stencils of level j are chosen on its low-pass low_j.
    frame : str or FilterBank
        A name in `BANKS`, ADAPTIVE, PAIRWISE, AUTO for the one that fits the faces, or a bank of your own.
        Names, as those of stencils and boundaries, in any case.
    stencil : {"MEAN", "STRAIGHT", "ADAPTIVE"}
        Rule at irregular vertices; ADAPTIVE takes masks that fit the valence, whatever the frame.
    levels : int
        Number of levels, at least 1.
    boundary : {"ALONG", "FIXED", "FREE"}
        See `make_stencil`.
    connectivity : Connectivity, optional
        Neighborhoods, if they are known already.
    dtype : dtype
        Precision of the transform.
    only_used_bands : bool
        Leave out the bands that never reach the surface (Remark 4.1).

    Raises
    ------
    FrameError
        If the frame is not known or does not fit the mesh, or the mesh is too small for so many levels.
    """
    dtype = as_precision(dtype)
    blocks = blocks or Blocks(1)
    check_connectivity(connectivity, surface)
    if connectivity is None:
        surface, connectivity, _ = connect_agreeing(surface, blocks)
    stencil, boundary = as_identifier(stencil), as_identifier(boundary)
    if not isinstance(frame, FilterBank):
        word: str = as_identifier(frame)
        check_choice("The frame", word, ["AUTO", *BANKS, *FAMILIES], FrameError)
        frame = choose_frame(word, connectivity)
    check_choice("The stencil", stencil, [*RULES, "ADAPTIVE"], FrameError)
    check_choice("The boundary", boundary, BOUNDARIES, FrameError)
    check_number("The number of levels", levels, 1, is_whole=True, error=FrameError)
    if stencil == "ADAPTIVE" or frame in FAMILIES:
        name = "PAIRWISE" if frame == "PAIRWISE" else "ADAPTIVE"
        return _adaptive_transform(surface, name, levels, boundary, connectivity, blocks, dtype)
    bank = BANKS[frame] if isinstance(frame, str) else frame
    check_fit(bank, connectivity)
    bands = bank.used_bands if only_used_bands else None
    stages: list[LatticeLevel] = []
    low = surface
    for index in range(levels):
        chosen = make_stencil(low, connectivity, stencil, boundary, blocks, bank, index)
        # On a surface of one side longer walks turn to the left on one way and to the right on another.
        are_shifts = index == 0 and (bank.reach == 1 or not connectivity.is_one_sided)
        level = LatticeLevel(chosen, bank, dtype, blocks, bands, are_shifts=are_shifts)
        if index:
            _check_reached(index, _is_reached(surface, connectivity, bank, index))
        stages.append(level)
        if index + 1 < levels:
            points = np.ascontiguousarray(low.vertices.T, dtype)
            low = low.with_vertices(np.ascontiguousarray(level.forward(points, _ignore)[0].T))
    return FrameTransform.of_levels(tuple(stages), dtype, bank.name)


def choose_frame(frame: str, connectivity: Connectivity) -> str:
    """Resolve the frame AUTO: box spline on triangles, linear spline on quads, ADAPTIVE on anything else."""
    if frame != "AUTO":
        return frame
    has_face = ~connectivity.is_loose
    if (connectivity.all_triangles == has_face).all():
        return "BOX_SPLINE_111"
    return "LINEAR_SPLINE" if (connectivity.all_quads == has_face).all() else "ADAPTIVE"


def _adaptive_transform(
    surface: SurfaceMesh,
    name: str,
    levels: int,
    boundary: str,
    connectivity: Connectivity,
    blocks: Blocks,
    dtype: np.dtype,
) -> FrameTransform:
    """Choose the neighbors of every level, then pull the measures back from the coarsest."""
    family = FAMILIES[name]
    ring_points = one_ring_points(connectivity)
    adjacency = edge_adjacency(connectivity)
    one = np.ones(surface.n_vertices)
    low = surface
    neighbors: list[Neighbors] = []
    for index in range(levels):
        dilated = dilate(ring_points, low.vertices, adjacency, index, 1, blocks)
        neighbors.append(ring_neighbors(dilated, boundary))
        _check_reached(index, not index or len(neighbors[-1].rows.items) > 0)
        if index + 1 < levels:
            level = AdaptiveLevel(neighbors[-1], family, one, dtype, blocks)
            points = np.ascontiguousarray(low.vertices.T, dtype)
            low = low.with_vertices(np.ascontiguousarray(level.low_pass(points).T))
    measure: NDArray[np.floating] = one
    stages: list[AdaptiveLevel] = []
    del ring_points, dilated, low
    while neighbors:
        level = AdaptiveLevel(neighbors.pop(), family, measure, dtype, blocks)
        stages.insert(0, level)
        level.prepare()  # now, as later there is less memory left
        measure = level.measure
    return FrameTransform.of_levels(tuple(stages), dtype, name)


def _ignore(_: int, __: Bands) -> None:
    """Do nothing with the high bands of a chunk."""


def _is_reached(surface: SurfaceMesh, connectivity: Connectivity, bank: FilterBank, index: int) -> bool:
    """Return whether some vertices are 2^index steps apart on the bank's lattice.

    Vertices are tried in chunks spread over the mesh; on all but the smallest meshes the first one decides.
    """
    is_quads = bank.lattice == "QUADS" or (bank.lattice == "ANY" and connectivity.has_quads)
    adjacency = face_adjacency(surface, connectivity) if is_quads else edge_adjacency(connectivity)
    n_tried = min(surface.n_vertices, 1024)
    for vertex in np.linspace(0, surface.n_vertices - 1, n_tried).astype(int):
        if len(distance_rings(adjacency, np.array([vertex]), {2**index})[2**index].vertex):
            return True
    return False


def _check_reached(index: int, is_reached: bool) -> None:
    """Raise FrameError if no vertex has a neighbor at a level."""
    if not is_reached:
        raise FrameError(
            f"The mesh is too small for {index + 1} levels: nothing is {2**index} edges apart; "
            f"use {index} level{'s' if index != 1 else ''} or fewer."
        )


def check_fit(bank: FilterBank, connectivity: Connectivity) -> None:
    """Raise FrameError if a frame's lattice has nothing in common with the mesh."""
    if bank.lattice == "QUADS" and not connectivity.has_quads:
        raise FrameError(
            f"{bank.name} is a frame for quads, but the mesh has none; use a box spline frame or ADAPTIVE."
        )
    if bank.is_cell_centered and not (connectivity.has_quads or connectivity.has_triangle_pairs):
        raise FrameError(
            f"{bank.name} needs quads or pairs of triangles, but the mesh has none; use ADAPTIVE."
        )
