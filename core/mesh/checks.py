# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The border at which a mesh is checked; behind it the arrays are trusted."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..errors import MeshError
from ..value_checks import shown
from .geometry import mean_edge_length
from .surface_mesh import SurfaceMesh

ROOM = 8.0
"""How far a coordinate must be from the largest number, as a factor: a result may lie farther out."""


def check_mesh(surface: SurfaceMesh) -> None:
    """Raise MeshError, in one sentence, unless this is a mesh."""
    if not isinstance(surface, SurfaceMesh):
        raise MeshError(f"The mesh is {shown(surface)}; give a SurfaceMesh.")


def check_positions(surface: SurfaceMesh) -> None:
    """Raise MeshError, in one sentence, if a mesh has no vertices or faces, or a position is not finite."""
    if not surface.n_vertices:
        raise MeshError("The mesh is empty; it needs vertices and faces.")
    if not surface.n_faces:
        raise MeshError(
            f"The mesh has {surface.n_vertices} vertices but no faces; only surfaces can be cleaned."
        )
    is_finite = np.isfinite(surface.vertices)
    if not is_finite.all():
        wrong = np.flatnonzero(~is_finite.all(axis=1))
        position = ", ".join(f"{value:g}" for value in surface.vertices[wrong[0]])
        count = (
            "is not a finite point" if len(wrong) == 1 else f"and {len(wrong) - 1} more are not finite points"
        )
        raise MeshError(f"Vertex {wrong[0]} at ({position}) {count}; delete or move it first.")
    farthest = float(max(surface.vertices.max(), -surface.vertices.min()))
    if farthest > float(np.finfo(surface.vertices.dtype).max) / ROOM:
        raise MeshError(
            f"The mesh reaches to a coordinate of {farthest:.3g}, where there are hardly larger numbers; "
            "scale it down first."
        )


def check_surface(
    surface: SurfaceMesh, blocks: Blocks | None = None, edge_face_count: NDArray[np.integer] | None = None
) -> float:
    """Check that a mesh can be worked on, and return its mean edge length in scene units.

    `blocks` are threads to work on; `edge_face_count` (E,) are the faces at each edge, if they are known.

    Raises
    ------
    MeshError
        In one sentence, if the mesh has no vertices or faces, a position that is not finite, or no size.
    """
    check_positions(surface)
    edge = mean_edge_length(surface, blocks, edge_face_count)
    if not edge > 0.0:
        raise MeshError("All faces have shrunk to points; the mesh has no size to measure noise by.")
    if not np.isfinite(edge):
        raise MeshError("The mesh is too large to measure its edges; scale it down first.")
    return edge
