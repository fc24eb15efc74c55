# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Data-matrix generation: from the one-rings of a mesh to the points under each mask."""

from __future__ import annotations

import numpy as np

from ..blocks import Blocks
from ..surface.connectivity import Connectivity
from ..surface.surface_mesh import SurfaceMesh
from .boundary import fill_along_boundary
from .mean import fill_mean
from .stencil import Stencil, StencilBuilder
from .straight import fill_straight

__all__ = ["Stencil", "make_stencil"]


def make_stencil(
    surface: SurfaceMesh,
    connectivity: Connectivity,
    rule: str = "STRAIGHT",
    boundary: str = "ALONG",
    blocks: Blocks | None = None,
) -> Stencil:
    """Choose the points of the seven triangle taps at every vertex (section 3.1; Algorithm-Tri-2: 4.2).

    A regular vertex, inside and with six triangles, takes its one-ring, from the lowest-numbered neighbor on.

    Parameters
    ----------
    surface : SurfaceMesh
        The surface on which angles and lengths are measured; not modified.
    connectivity : Connectivity
        Its neighborhoods.
    rule : {"MEAN", "STRAIGHT"}
        The rule at irregular vertices; those that STRAIGHT cannot serve take MEAN.
    boundary : {"ALONG", "FIXED", "FREE"}
        With FREE, boundary vertices are irregular vertices like others; else missing points are mirrored.
    blocks : Blocks, optional
        Threads to work on.

    Returns
    -------
    Stencil
        Loose vertices have themselves in every slot.

    Raises
    ------
    ValueError
        If the rule is not known.
    """
    if rule not in ("MEAN", "STRAIGHT"):
        raise ValueError(f"The stencil rule is {rule!r}; choose one of MEAN, STRAIGHT.")
    blocks = blocks or Blocks(1)
    builder = StencilBuilder(surface.n_vertices, 7)
    has_face = ~connectivity.is_loose
    rim = connectivity.boundary_neighbors[:, 0] >= 0
    is_regular = connectivity.all_triangles & (connectivity.valence == 6)
    is_regular &= ~connectivity.is_boundary & ~connectivity.is_non_manifold
    regular = np.flatnonzero(is_regular)
    builder.slots[:, regular] = connectivity.ring_rows(regular, 6)
    builder.is_irregular[:] = has_face & ~is_regular
    is_along = rim if boundary != "FREE" else np.zeros_like(rim)
    fill_along_boundary(builder, connectivity, np.flatnonzero(is_along), is_mean=rule == "MEAN")
    irregular = np.flatnonzero(has_face & ~is_regular & ~is_along)
    if rule == "STRAIGHT":
        irregular = fill_straight(builder, surface.vertices, connectivity, irregular, blocks)
    fill_mean(builder, connectivity, irregular)
    return builder.finish()
