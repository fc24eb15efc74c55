# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The one entry point to stencils: which rule serves a bank at a level."""

from __future__ import annotations

from ..blocks import Blocks
from ..errors import FrameError
from ..frames import FilterBank
from ..frames.box_spline import BOX_SPLINE_111
from ..mesh.connectivity import Connectivity
from ..mesh.distance_rings import edge_adjacency, face_adjacency
from ..mesh.surface_mesh import SurfaceMesh
from ..value_checks import check_choice
from .builder import StencilBuilder
from .dilation import dilate
from .grid_stencil import make_grid_stencil
from .quads import fill_quads
from .ring_points import one_ring_points, quad_points, triangle_points
from .stencil import Stencil
from .triangles import ACROSS, fill_triangles

RULES = ("MEAN", "STRAIGHT")
BOUNDARIES = ("ALONG", "FIXED", "FREE")


def make_stencil(
    surface: SurfaceMesh,
    connectivity: Connectivity,
    stencil: str = "STRAIGHT",
    boundary: str = "ALONG",
    blocks: Blocks | None = None,
    bank: FilterBank = BOX_SPLINE_111,
    level: int = 0,
) -> Stencil:
    """Choose the points under the masks of a bank (sections 3.1, 3.2, 4.2, 5.1, 5.4).

    Parameters
    ----------
    surface : SurfaceMesh
        The surface on which angles and lengths are measured; not modified.
    connectivity : Connectivity
        Its neighborhoods.
    stencil : {"MEAN", "STRAIGHT"}
        The rule at irregular vertices; those that STRAIGHT cannot serve take MEAN.
    boundary : {"ALONG", "FIXED", "FREE"}
        With FREE, boundary vertices are irregular vertices like others; else missing points are mirrored.
    bank : FilterBank
        The masks to serve.
    level : int
        Dilation level; taps are 2^level edges apart.

    Returns
    -------
    Stencil
        Loose vertices have themselves under every tap.

    Raises
    ------
    FrameError
        If the stencil or the boundary is not known.
    """
    check_choice("The stencil", stencil, RULES, FrameError)
    check_choice("The boundary", boundary, BOUNDARIES, FrameError)
    blocks = blocks or Blocks(1)
    if bank.is_cell_centered or bank.reach > 1:
        return make_grid_stencil(surface, connectivity, boundary, bank, level)
    builder = StencilBuilder(surface.n_vertices, bank.offsets, blocks=blocks)
    if bank.lattice == "QUADS":
        ring_points = quad_points(surface, connectivity)
        if level:
            adjacency = face_adjacency(surface, connectivity)
            ring_points = dilate(ring_points, surface.vertices, adjacency, level, 1, blocks)
        fill_quads(builder, surface.vertices, ring_points, stencil, boundary, blocks)
    else:
        has_far = builder.has(*ACROSS)
        ring_points = triangle_points(surface, connectivity) if has_far else one_ring_points(connectivity)
        if level:
            ring_points = dilate(
                ring_points, surface.vertices, edge_adjacency(connectivity), level, 2, blocks
            )
        fill_triangles(builder, surface.vertices, ring_points, stencil, boundary, blocks)
    return builder.finish()
