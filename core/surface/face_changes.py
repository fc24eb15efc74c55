# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What becomes of the faces of a mesh when its vertices move: turned faces and volume, in one pass."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from .geometry import area_rows, coordinate_rows
from .surface_mesh import SurfaceMesh


class FaceChanges(NamedTuple):
    """Faces whose normal turned by more than a right angle, and the signed volumes in cubed scene units."""

    n_flipped: int
    volume_before: float
    volume_after: float


def compare_faces(before: SurfaceMesh, after: SurfaceMesh, blocks: Blocks | None = None) -> FaceChanges:
    """Compare the faces of two meshes of the same topology.

    Parameters
    ----------
    before, after : SurfaceMesh
        Meshes with the same faces; not modified.
    blocks : Blocks, optional
        Threads to work on.

    Returns
    -------
    FaceChanges
        The volumes, as from `signed_volume`, mean something for closed and consistently oriented meshes.
    """
    # Near the origin, so that the volume of a mesh far away loses no digits.
    origin = int(before.corner_vertex[0]) if before.n_corners else None
    rows = coordinate_rows(before, blocks, origin), coordinate_rows(after, blocks, origin)

    def kernel(start: int, stop: int) -> tuple[int, float, float]:
        areas = [area_rows(points, before, start, stop) for points in rows]
        volumes = [
            float((face_tips(points, before, start, stop) * area).sum()) / 3.0
            for points, area in zip(rows, areas, strict=True)
        ]
        np.multiply(areas[0], areas[1], out=areas[0])
        n_flipped = int(np.count_nonzero(areas[0][0] + areas[0][1] + areas[0][2] < 0.0))
        return n_flipped, volumes[0], volumes[1]

    found = (blocks or Blocks(1)).run(kernel, before.n_faces)
    return FaceChanges(
        sum(part[0] for part in found), sum(part[1] for part in found), sum(part[2] for part in found)
    )


def face_tips(
    points: NDArray[np.float64], surface: SurfaceMesh, start: int, stop: int
) -> NDArray[np.float64]:
    """Return a point of each of the faces start to stop, shape (3, n).

    For a triangle every point of its plane gives the same volume, and the first corner costs least; larger
    faces count as fans around the mean of their corners.
    """
    first = surface.face_offset[start:stop]
    counts = surface.face_offset[start + 1 : stop + 1] - first
    tips = points.take(
        surface.corner_vertex[np.minimum(first, max(surface.n_corners - 1, 0))], axis=1, mode="clip"
    )
    tips[:, counts == 0] = 0.0
    large = np.flatnonzero(counts > 3)
    if len(large):
        sizes = counts[large]
        begin = np.cumsum(sizes) - sizes
        corner = np.arange(sizes.sum()) + np.repeat(first[large] - begin, sizes)
        corners = points.take(surface.corner_vertex[corner], axis=1, mode="clip")
        tips[:, large] = np.add.reduceat(corners, begin, axis=1) / sizes
    return tips
