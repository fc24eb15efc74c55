# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a mesh is made of exact steps: voxels and terraces, which may be meant, and rounded coordinates."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..mesh.geometry import face_area_vectors, mean_edge_length
from ..mesh.surface_mesh import SurfaceMesh

VOXELS, TERRACES, ROUNDED = "VOXELS", "TERRACES", "ROUNDED"

LEAST_FACES = 200
"""A mesh with fewer is a part with steps of its own."""

ALIGNED = 0.9999
"""Cosine of a normal and an axis from which a face is aligned with it."""

AT_STEPS = 0.3
"""Share of the vertices that lie where faces of different axes meet, from which a shape is made of voxels; on
a finely divided box it is less."""

FLAT = 0.1
"""Least share of the surface that is flat on terraces, at several heights."""

LEAST_SLOPES = 0.01
"""Share of the surface that looks along no axis on all but boxes and voxels."""

ROUNDED_SLOPES = 0.2
"""The same on rounded shapes: where less slopes, planes are those of a part or are meant, as voxels are."""

WIDEST_STEP = 2.0
"""Steps of more mean edge lengths are those of a shape: there are slopes of several edges between them."""

N_SAMPLES = 4096
"""Vertices that are looked at first: if all of them stand at heights of their own there are no steps."""


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
    vectors, area, axis = _aligned(surface)
    total = area.sum()
    if not total > 0.0:
        return ""
    shares = np.bincount(axis, area, 4) / total
    if shares[3] < LEAST_SLOPES:
        return VOXELS if _meets_often(surface, axis) else ""
    up = int(shares[:3].argmax())
    # Between terraces the ground slopes; walls are those of a part.
    is_wall = vectors[:, up] < 0.01 * area
    if shares[up] < FLAT or area[is_wall].sum() > 0.05 * total:
        return ""
    heights = surface.vertices[:, up]
    flat = surface.corner_vertex[(axis == up).repeat(surface.face_sizes())]
    return TERRACES if _step_of(heights) and len(np.unique(heights[flat])) > 2 else ""


def rounding_noise(surface: SurfaceMesh) -> float:
    """Return the noise along the normals, rms in mean edge lengths, if coordinates in steps are rounded.

    Rounding to steps moves a surface by a twelfth of their square, on average, times the share of its normals
    along the axis. It is 0 where no coordinate is in steps, or just two, which are those of a grid. Whether
    one is rounded, or where it should be, is not seen here: rings of a lathe stand in steps, too.

    Examples
    --------
    >>> import numpy as np
    >>> from framelet.core import SurfaceMesh
    >>> from framelet.core.noise.steps import rounding_noise
    >>> rows, columns = np.mgrid[:30, :30]
    >>> corner = np.arange(900).reshape(30, 30)[:-1, :-1].ravel()
    >>> quads = np.stack((corner, corner + 30, corner + 31, corner + 1), axis=1)
    >>> def ground(heights):
    ...     return SurfaceMesh.from_faces(np.stack((rows, columns, heights), axis=-1).reshape(-1, 3), quads)
    >>> round(rounding_noise(ground(np.round(3 * np.sin(rows / 9)))), 2)
    0.28
    >>> rounding_noise(ground(3 * np.sin(rows / 9)))
    0.0
    """
    if surface.n_faces < LEAST_FACES:
        return 0.0
    steps = np.array([_step_of(column) for column in surface.vertices.T])
    if np.count_nonzero(steps) in (0, 2):
        return 0.0
    steps /= mean_edge_length(surface)
    vectors, area, axis = _aligned(surface)
    total = area.sum()
    if steps.max() > WIDEST_STEP or not area[axis == 3].sum() > ROUNDED_SLOPES * total:
        return 0.0
    along = (vectors * vectors / np.maximum(area, np.finfo(float).tiny)[:, None]).sum(axis=0) / total
    return float(np.sqrt((steps * steps * along).sum() / 12))


def _aligned(
    surface: SurfaceMesh,
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.intp]]:
    """Return vector areas without signs (F, 3), areas (F,), and the axis that each face looks along, or 3.

    The largest coordinate of an area is 1.
    """
    vectors = np.abs(face_area_vectors(surface))
    vectors /= max(vectors.max(initial=0.0), np.finfo(float).tiny)
    area = np.sqrt((vectors * vectors).sum(axis=1))
    return vectors, area, np.where(vectors.max(axis=1) > ALIGNED * area, vectors.argmax(axis=1), 3)


def _meets_often(surface: SurfaceMesh, axis: NDArray[np.integer]) -> bool:
    """Tell whether faces of different axes meet at many vertices."""
    of_corner = axis.repeat(surface.face_sizes())
    n_axes = np.zeros(surface.n_vertices, np.int8)
    for each in range(3):
        has = np.zeros(surface.n_vertices, bool)
        has[surface.corner_vertex[of_corner == each]] = True
        n_axes += has
    return bool((n_axes > 1).sum() > AT_STEPS * (n_axes > 0).sum())


def _step_of(heights: NDArray[np.floating]) -> float:
    """Return the step that heights are multiples of, if there are few of them, else 0."""
    heights = np.asarray(heights, np.float64)
    extent = np.ptp(heights)
    some = heights[np.linspace(0, len(heights) - 1, min(len(heights), N_SAMPLES)).astype(np.intp)]
    if not extent > 0.0 or len(np.unique(some)) == len(some):
        return 0.0
    levels = np.unique(np.round((heights - heights.min()) / extent, 6))
    if not 3 <= len(levels) <= len(heights) / 20:
        return 0.0
    steps = np.diff(levels)
    ratio = steps / steps.min()
    return float(steps.min() * extent) if np.abs(ratio - np.round(ratio)).max() < 0.02 else 0.0
