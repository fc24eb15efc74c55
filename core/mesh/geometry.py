# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Lengths, normals, areas and volume of a polygon mesh."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

from ..blocks import Blocks
from .ragged import starts, stretches
from .surface_mesh import SurfaceMesh

CANCELED = 1e-12
"""What is left of a sum, as a share of the lengths of its vectors, where only rounding kept it from zero."""


def coordinate_rows(
    vertices: NDArray[np.floating], blocks: Blocks | None = None, dtype: DTypeLike = np.float64
) -> NDArray[Any]:
    """Return a copy of positions, shape (N, 3), with coordinates in rows, shape (3, N), of a dtype.

    `blocks` are threads to work on.
    """
    rows = np.empty((3, len(vertices)), dtype)

    def kernel(start: int, stop: int) -> None:
        rows[:, start:stop] = vertices[start:stop].T

    (blocks or Blocks(1)).run(kernel, len(vertices))
    return rows


def mean_edge_length(
    surface: SurfaceMesh, blocks: Blocks | None = None, edge_face_count: NDArray[np.integer] | None = None
) -> float:
    """Return the mean edge length over all face-edge incidences, in scene units; 0.0 without faces.

    An edge between two faces counts twice, so that on a closed mesh this is the mean over its edges.
    It is infinite or NaN, without a warning, where positions are not finite or too large to be squared.
    `blocks` are threads to work on; `edge_face_count` (E,) are the faces at each edge, if they are known.
    """
    if not surface.n_corners:
        return 0.0
    points = coordinate_rows(surface.vertices, blocks)
    n_faces = edge_face_count
    if n_faces is None:
        n_faces = np.bincount(surface.corner_edge, minlength=surface.n_edges)

    def kernel(start: int, stop: int) -> float:
        ends = np.ascontiguousarray(surface.edges[start:stop].T, np.intp)
        step = points.take(ends[0], axis=1, mode="clip")
        # Here, as threads do not take the states of others.
        with np.errstate(over="ignore", invalid="ignore"):
            step -= points.take(ends[1], axis=1, mode="clip")
            # Not a dot product, which a matrix library would spread over threads of its own.
            return float((row_lengths(step) * n_faces[start:stop]).sum())

    return sum((blocks or Blocks(1)).run(kernel, surface.n_edges)) / surface.n_corners


def row_lengths(rows: Sequence[NDArray[np.floating]] | NDArray[np.floating]) -> NDArray[np.floating]:
    """Return the lengths of vectors with coordinates in rows, shape (3, n); changes the rows."""
    for row in rows:
        np.multiply(row, row, out=row)
    total = rows[0]
    total += rows[1]
    total += rows[2]
    return np.sqrt(total, out=total)


def face_area_vectors(surface: SurfaceMesh, blocks: Blocks | None = None) -> NDArray[np.float64]:
    """Return the vector area of each face, shape (F, 3), float64: its normal times its area.

    By Newell's formula, which serves planar and non-planar polygons alike: half the cross product of two
    edges for a triangle and half that of the diagonals for a quad. `blocks` are threads to work on.
    """
    points = coordinate_rows(surface.vertices, blocks)
    vectors = np.empty((surface.n_faces, 3))

    def kernel(start: int, stop: int) -> None:
        vectors[start:stop] = area_rows(points, surface, start, stop).T

    (blocks or Blocks(1)).run(kernel, surface.n_faces)
    return vectors


def area_rows(
    points: NDArray[np.float64], surface: SurfaceMesh, start: int, stop: int
) -> NDArray[np.float64]:
    """Return the vector areas of faces start to stop of a mesh, shape (3, stop - start).

    `points`, shape (3, N), are the positions; those of the mesh are not looked at.
    """
    sizes = np.diff(surface.face_offset[start : stop + 1])
    first = surface.face_offset[start:stop]
    areas = np.zeros((3, stop - start))
    for size in (3, 4):
        faces = np.flatnonzero(sizes == size)
        if not len(faces):
            continue
        vertices = surface.corner_vertex[first[faces] + np.arange(size)[:, None]]
        corners = points.take(vertices.astype(np.intp), axis=1, mode="clip")
        if size == 3:
            corners[:, 1:] -= corners[:, :1]
            found = _half_cross(corners[:, 1], corners[:, 2])
        else:
            found = _half_cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
        if len(faces) == stop - start:
            return found
        areas[:, faces] = found
    faces = np.flatnonzero(sizes > 4)
    if len(faces):
        areas[:, faces] = _newell_areas(points, surface, start + faces)
    return areas


def fan_areas(arms: Sequence[Sequence[NDArray[Any]]] | Sequence[NDArray[Any]]) -> list[NDArray[Any]]:
    """Return twice the vector areas of faces with as many corners, by axis.

    Parameters
    ----------
    arms : sequence of (x, y, z)
        From the first corner of each face to each of its other corners, in turn; at least two.

    Returns
    -------
    list of three ndarrays
        Coordinates of the sums over the triangles of each fan, in the shape of the arms' coordinates.
    """
    totals: list[NDArray[Any]] = []
    for (a, b, c), (x, y, z) in pairwise(arms):
        parts = (b * z - c * y, c * x - a * z, a * y - b * x)
        if totals:
            for total, part in zip(totals, parts, strict=True):
                total += part
        else:
            totals = list(parts)
    return totals


def _half_cross(first: NDArray[np.float64], second: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return half the cross products of vectors, coordinates in rows, shape (3, n)."""
    (a, b, c), (x, y, z) = first, second
    result = np.stack((b * z - c * y, c * x - a * z, a * y - b * x))
    result *= 0.5
    return result


def _newell_areas(
    points: NDArray[np.float64], surface: SurfaceMesh, faces: NDArray[np.intp]
) -> NDArray[np.float64]:
    """Return the vector areas of polygons of any size, shape (3, n); zero for what goes there and back."""
    first = surface.face_offset[:-1][faces]
    counts = surface.face_offset[1:][faces] - first
    begin = starts(counts)
    corner = stretches(first, counts)
    following = np.arange(1, len(corner) + 1)
    following[begin + counts - 1] = begin
    corners = points[:, surface.corner_vertex[corner]]
    # Relative to the face's first corner, so that a mesh far from the origin loses no digits.
    corners -= np.repeat(corners[:, begin], counts, axis=1)
    parts = _half_cross(corners, corners[:, following])
    areas = np.add.reduceat(parts, begin, axis=1)
    total = np.add.reduceat(row_lengths(parts), begin)
    areas[:, row_lengths(areas.copy()) <= CANCELED * total] = 0.0
    return areas


def unit_vectors(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return vectors scaled to length one along the last axis; zero vectors stay zero."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.divide(vectors, length, out=np.zeros_like(vectors), where=length > 0)


def face_normals(surface: SurfaceMesh) -> NDArray[np.float64]:
    """Return unit face normals, shape (F, 3), float64; zero for faces without area."""
    return unit_vectors(face_area_vectors(surface))


def vertex_normals(surface: SurfaceMesh) -> NDArray[np.float64]:
    """Return unit vertex normals, shape (N, 3), float64: area-weighted means of the faces around a vertex.

    Zero at loose vertices and where the faces cancel out, be it but for rounding.
    """
    areas = face_area_vectors(surface)
    areas = np.column_stack((areas, np.linalg.norm(areas, axis=1)))
    per_corner = np.repeat(areas, surface.face_sizes(), axis=0)
    sums = np.empty((surface.n_vertices, 4))
    for column in range(4):
        sums[:, column] = np.bincount(
            surface.corner_vertex, per_corner[:, column], minlength=surface.n_vertices
        )
    vectors, total = sums[:, :3], sums[:, 3]
    vectors[np.linalg.norm(vectors, axis=1) <= CANCELED * total] = 0.0
    return unit_vectors(vectors)


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
        begin = starts(sizes)
        corner = stretches(first[large], sizes)
        corners = points.take(surface.corner_vertex[corner], axis=1, mode="clip")
        tips[:, large] = np.add.reduceat(corners, begin, axis=1) / sizes
    return tips
