# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How far two surfaces of the same topology are apart."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .errors import MeshError
from .mesh.checks import check_positions
from .mesh.geometry import face_normals, mean_edge_length
from .mesh.surface_mesh import SurfaceMesh


@dataclass(frozen=True)
class Comparison:
    """Distances between two surfaces; lengths in the units of the meshes, angles in degrees."""

    mean_angle: float
    """Mean angle between corresponding face normals, all faces with an area alike."""
    max_angle: float
    rms_distance: float
    max_distance: float
    mean_edge_length: float
    """Of the reference."""
    flipped_faces: int
    """Faces whose normals differ by more than a right angle."""


def compare(surface: SurfaceMesh, reference: SurfaceMesh) -> Comparison:
    """Compare a surface with a reference of the same topology, vertex by vertex and face by face.

    Parameters
    ----------
    surface, reference : SurfaceMesh
        Two meshes with the same faces; not modified.

    Raises
    ------
    MeshError
        If the meshes have different numbers of vertices or different faces, or no faces, or no size.
    """
    if surface.n_vertices != reference.n_vertices:
        raise MeshError(
            f"The meshes have {surface.n_vertices} and {reference.n_vertices} vertices; "
            "only meshes with the same topology can be compared."
        )
    if not np.array_equal(surface.face_offset, reference.face_offset) or not np.array_equal(
        surface.corner_vertex, reference.corner_vertex
    ):
        raise MeshError(
            "The meshes have different faces; only meshes with the same topology can be compared."
        )
    if not surface.n_faces:
        raise MeshError("The meshes have no faces; there is nothing to compare.")
    for mesh in (surface, reference):
        check_positions(mesh)
        edge = mean_edge_length(mesh)
        if not np.isfinite(edge):
            raise MeshError("A mesh is too large to measure its edges; scale both down first.")
    if not edge > 0.0:
        raise MeshError("The reference has no size: all its faces have shrunk to points.")
    apart = surface.vertices.astype(np.float64) - reference.vertices
    unit = np.ldexp(1.0, np.frexp(np.abs(apart).max())[1])  # squares of large distances are no numbers
    distance = np.linalg.norm(apart / unit, axis=1)
    angle = normal_angles(face_normals(surface), face_normals(reference))
    angle = angle[np.isfinite(angle)]
    return Comparison(
        mean_angle=float(angle.mean()) if len(angle) else 0.0,
        max_angle=float(angle.max()) if len(angle) else 0.0,
        rms_distance=float(np.sqrt(np.mean(distance**2)) * unit),
        max_distance=float(distance.max() * unit),
        mean_edge_length=edge,
        flipped_faces=int((angle > 90.0).sum()),
    )


def normal_angles(first: NDArray[np.floating], second: NDArray[np.floating]) -> NDArray[np.floating]:
    """Return the angles between unit normals, shape (F,), in degrees; NaN where a normal is zero.

    By the lengths of sum and difference, which is exact for small angles, where the arc cosine is not.
    """
    apart = np.linalg.norm(first - second, axis=1)
    together = np.linalg.norm(first + second, axis=1)
    angle = np.degrees(2.0 * np.arctan2(apart, together))
    has_normals = first.any(axis=1) & second.any(axis=1)
    return np.where(has_normals, angle, np.nan)
