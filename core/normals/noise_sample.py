# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A sample of the noise that vertices of a given noise make in the normals of the faces."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..surface.surface_mesh import SurfaceMesh
from .centroids import face_centroids
from .neighbors import Ragged
from .pilot import unit_columns

PERIODS = 64.0
"""Periods of the scrambled roughness in one standard deviation of the noise: many, so that the values within
a period are spread evenly, and few enough for the digits of single precision."""


def area_vectors(
    points: NDArray[np.floating], surface: SurfaceMesh, blocks: Blocks | None = None
) -> NDArray[np.floating]:
    """Return vector areas, shape (3, F), of the faces at positions (3, N): Newell's formula."""
    size = surface.common_face_size()
    if size == 3 or size == 4:
        vectors = np.empty((3, surface.n_faces), points.dtype)

        def kernel(start: int, stop: int) -> None:
            corner = points.take(surface.corner_vertex[size * start : size * stop], axis=1)
            a, b, c, d = (corner[:, k % size :: size] for k in range(4))
            first, second = (c - a, d - b) if size == 4 else (b - a, c - a)
            part = _cross(first, second)
            part *= points.dtype.type(0.5)
            vectors[:, start:stop] = part

        (blocks or Blocks(1)).run(kernel, surface.n_faces)
        return vectors
    sizes = surface.face_sizes()
    filled = sizes > 0
    begin = np.repeat(surface.face_offset[:-1], sizes)
    # Relative to the first corner of the face, so that large coordinates cost no digits.
    origin = points.take(surface.corner_vertex[begin], axis=1)
    here = points.take(surface.corner_vertex, axis=1) - origin
    there = points.take(surface.corner_vertex[surface.next_corner()], axis=1) - origin
    vectors = np.zeros((3, surface.n_faces), points.dtype)
    vectors[:, filled] = np.add.reduceat(_cross(here, there), surface.face_offset[:-1][filled], axis=1)
    return 0.5 * vectors


def _cross(first: NDArray[np.floating], second: NDArray[np.floating]) -> NDArray[np.floating]:
    """Return cross products of vectors, shape (3, n)."""
    (a, b, c), (x, y, z) = first, second
    return np.stack((b * z - c * y, c * x - a * z, a * y - b * x))


def normals_of(
    points: NDArray[np.floating], surface: SurfaceMesh, blocks: Blocks | None = None
) -> NDArray[np.floating]:
    """Return unit normals, shape (3, F); zero for faces without area."""
    vectors = area_vectors(points, surface, blocks)

    def kernel(start: int, stop: int) -> None:
        part = vectors[:, start:stop]
        part[...] = unit_columns(part, np.zeros_like(part))

    (blocks or Blocks(1)).run(kernel, surface.n_faces)
    return vectors


def vertex_means(
    values: NDArray[np.floating], at_vertex: Ragged, blocks: Blocks | None = None
) -> NDArray[np.floating]:
    """Return the means, shape (3, N), of values (3, F) over the faces at each vertex; zero without faces."""
    offset = at_vertex.offset
    means = np.zeros((3, len(offset) - 1), values.dtype)

    def kernel(start: int, stop: int) -> None:
        counts = np.diff(offset[start : stop + 1])
        filled = np.flatnonzero(counts)
        if len(filled):
            begin = offset[start]
            items = values.take(at_vertex.items[begin : offset[stop]], axis=1)
            sums = np.add.reduceat(items, offset[start + filled] - begin, axis=1)
            sums /= counts[filled].astype(values.dtype)
            means[:, start + filled] = sums

    (blocks or Blocks(1)).run(kernel, means.shape[1])
    return means


def scrambled(
    points: NDArray[np.floating],
    surface: SurfaceMesh,
    at_vertex: Ragged,
    sigma: float,
    periods: float,
    blocks: Blocks | None = None,
) -> NDArray[np.floating]:
    """Return a number between 0 and 1 for each vertex, shape (N,), which looks random.

    It is made from the height of the vertex over the faces around it, in units of sigma, by a triangle wave
    with so many periods. So it does not depend on how vertices are numbered or how the mesh is turned. The
    wave has no jumps, as rounding would decide there, and is 1/2 where the height is 0, as at the corner of a
    border: turning all faces over turns number into 1 - number.
    """
    normals = vertex_means(area_vectors(points, surface, blocks), at_vertex, blocks)
    normals = unit_columns(normals, np.zeros_like(normals))
    arm = points - vertex_means(face_centroids(points, surface, blocks), at_vertex, blocks)
    height = np.einsum("cn,cn->n", arm, normals)
    wave = height * points.dtype.type(periods / sigma) + points.dtype.type(0.25)
    return points.dtype.type(2) * np.abs(wave - np.rint(wave))


def noise_in_normals(
    points: NDArray[np.floating],
    amount: NDArray[np.floating],
    surface: SurfaceMesh,
    at_vertex: Ragged,
    blocks: Blocks,
) -> NDArray[np.floating]:
    """Return how normals change when vertices move along their normals.

    Parameters
    ----------
    points : ndarray, shape (3, N)
        A surface without much noise; not modified.
    amount : ndarray, shape (N,)
        How far each vertex moves.
    surface : SurfaceMesh
        The mesh, for its faces.
    at_vertex : Ragged
        Faces at each vertex.
    blocks : Blocks
        Threads to work on.

    Returns
    -------
    ndarray, shape (3, F)
    """
    vectors = area_vectors(points, surface, blocks)
    directions = vertex_means(vectors, at_vertex, blocks)
    moved = np.empty_like(points)

    def move(start: int, stop: int) -> None:
        part = directions[:, start:stop]
        step = unit_columns(part, np.zeros_like(part))
        step *= amount[start:stop]
        np.add(points[:, start:stop], step, out=moved[:, start:stop])

    blocks.run(move, points.shape[1])
    change = normals_of(moved, surface, blocks)

    def compare(start: int, stop: int) -> None:
        part = vectors[:, start:stop]
        change[:, start:stop] -= unit_columns(part, np.zeros_like(part))

    blocks.run(compare, surface.n_faces)
    return change
