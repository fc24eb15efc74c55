# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a mesh consists of exact steps, which are no noise: voxels and terraces."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..mesh.geometry import face_area_vectors
from ..mesh.surface_mesh import SurfaceMesh

VOXELS, TERRACES = "VOXELS", "TERRACES"

LEAST_FACES = 200
"""A mesh with fewer is a part with steps of its own."""

ALIGNED = 0.9999
"""Cosine of a normal and an axis from which a face is aligned with it."""

AT_STEPS = 0.3
"""Share of the vertices that lie where faces of different axes meet, from which a shape is made of voxels; on
a finely divided box it is less."""

FLAT = 0.1
"""Least share of the surface that is flat on terraces, at several heights."""


def find_steps(surface: SurfaceMesh) -> str:
    """Return VOXELS for a mesh of axis-aligned faces, TERRACES for heights in whole steps, else nothing.

    Examples
    --------
    >>> import numpy as np
    >>> from framelet.core import SurfaceMesh
    >>> from framelet.core.noise.steps import find_steps
    >>> rows, columns = np.mgrid[:20, :20]
    >>> heights = np.round(rows * 0.3 + np.sin(columns))
    >>> corner = np.arange(400).reshape(20, 20)[:-1, :-1].ravel()
    >>> quads = np.stack((corner, corner + 20, corner + 21, corner + 1), axis=1)
    >>> find_steps(SurfaceMesh.from_faces(np.stack((rows, columns, heights), axis=-1).reshape(-1, 3), quads))
    'TERRACES'
    """
    if surface.n_faces < LEAST_FACES:
        return ""
    vectors = np.abs(face_area_vectors(surface))
    area = np.sqrt((vectors * vectors).sum(axis=1))
    total = area.sum()
    if not total > 0.0:
        return ""
    axis = np.where(vectors.max(axis=1) > ALIGNED * area, vectors.argmax(axis=1), 3)
    shares = np.bincount(axis, area, 4) / total
    if shares[3] < 0.01:
        return VOXELS if _meets_often(surface, axis) else ""
    up = int(shares[:3].argmax())
    # Between terraces the ground slopes; walls are those of a part.
    is_wall = vectors[:, up] < 0.01 * area
    if shares[up] < FLAT or area[is_wall].sum() > 0.05 * total:
        return ""
    heights = surface.vertices[:, up]
    flat = surface.corner_vertex[(axis == up).repeat(surface.face_sizes())]
    return TERRACES if _in_steps(heights) and len(np.unique(heights[flat])) > 2 else ""


def _meets_often(surface: SurfaceMesh, axis: NDArray[np.integer]) -> bool:
    """Tell whether faces of different axes meet at many vertices."""
    of_corner = axis.repeat(surface.face_sizes())
    n_axes = np.zeros(surface.n_vertices, np.int8)
    for each in range(3):
        has = np.zeros(surface.n_vertices, bool)
        has[surface.corner_vertex[of_corner == each]] = True
        n_axes += has
    return bool((n_axes > 1).sum() > AT_STEPS * (n_axes > 0).sum())


def _in_steps(heights: NDArray[np.floating]) -> bool:
    """Tell whether heights are few and all multiples of one step apart."""
    heights = np.asarray(heights, np.float64)
    extent = np.ptp(heights)
    if not extent > 0.0:
        return False
    levels = np.unique(np.round((heights - heights.min()) / extent, 6))
    if not 3 <= len(levels) <= len(heights) / 20:
        return False
    steps = np.diff(levels)
    ratio = steps / steps.min()
    return bool(np.abs(ratio - np.round(ratio)).max() < 0.02)
