# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts of a large mesh, spread over it, on which recipes are tried."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..normals.centroids import face_centroids
from ..surface.connectivity import connect
from ..surface.surface_mesh import SurfaceMesh

WHOLE = 11000
"""Faces up to which the whole mesh is used."""

N_PATCHES = 10
FACES_IN_PATCH = 1100
INNER = 0.6
"""Share of a patch's radius within which vertices count: farther out the cut is too near."""

TRIMMINGS = 8
"""How often, at most, faces are dropped at the rims where these touch themselves: at vertices that are not
manifold low-passes take several times as long."""

_SEED_CANDIDATES = 20000

_SPARSE = 64
"""Of so many faces one is looked at to see how far a patch may reach."""


class Part(NamedTuple):
    """A part of a mesh: its vertices' numbers (n,), the part as a mesh, and which vertices count."""

    vertices: NDArray[np.integer]
    surface: SurfaceMesh
    counts: NDArray[np.bool_]


def trial_part(points: NDArray[np.floating], surface: SurfaceMesh) -> Part:
    """Return the part of a mesh on which recipes are tried; small meshes whole.

    Parameters
    ----------
    points : ndarray, shape (3, N)
        Positions; patches are balls around points far from each other.
    surface : SurfaceMesh
        The mesh, for its faces.

    Returns
    -------
    Part
    """
    if surface.n_faces <= WHOLE:
        everything = np.arange(surface.n_vertices)
        return Part(everything, surface, np.ones(surface.n_vertices, bool))
    centroids = face_centroids(points, surface)
    is_chosen = np.zeros(surface.n_faces, bool)
    is_inner = np.zeros(surface.n_vertices, bool)
    for seed in _far_apart(centroids):
        near, distance = _nearest(centroids, seed, FACES_IN_PATCH + 1)
        radius = distance.max()
        is_chosen[near] = True
        inner = near[distance <= INNER**2 * radius]
        is_inner[_corners_of(surface, inner)] = True
    faces = np.flatnonzero(is_chosen)
    vertices, part = _part_of(surface, faces)
    for _ in range(TRIMMINGS):
        is_bad = connect(part).is_non_manifold & ~is_inner[vertices]
        if not is_bad.any():
            break
        face_of_corner = np.repeat(np.arange(part.n_faces), part.face_sizes())
        touched = np.unique(face_of_corner[is_bad[part.corner_vertex]])
        is_inner[_corners_of(surface, faces[touched])] = False
        faces = np.delete(faces, touched)
        vertices, part = _part_of(surface, faces)
    return Part(vertices, part, is_inner[vertices])


def _part_of(surface: SurfaceMesh, faces: NDArray[np.intp]) -> tuple[NDArray[np.int32], SurfaceMesh]:
    """Return the vertices of some faces, and a mesh of these."""
    vertices, local = np.unique(_corners_of(surface, faces), return_inverse=True)
    ends = np.cumsum(surface.face_sizes()[faces])[:-1]
    polygons = [polygon.tolist() for polygon in np.split(local.reshape(-1), ends)]
    return vertices, SurfaceMesh.from_faces(surface.vertices[vertices], polygons)


def _nearest(
    centroids: NDArray[np.floating], seed: int, n_faces: int
) -> tuple[NDArray[np.intp], NDArray[np.floating]]:
    """Return the faces nearest to a face by their centroids, equals included, and their squared distances."""
    distance = _squared_distances(centroids, seed)
    # Where every so manieth face is within twice as many, the others need not be sorted.
    some = distance[::_SPARSE]
    n_some = min(2 * n_faces // _SPARSE + 2, len(some))
    near = np.flatnonzero(distance <= np.partition(some, n_some - 1)[n_some - 1])
    if len(near) < n_faces:
        near = np.arange(len(distance))
    found = distance[near]
    is_near = found <= np.partition(found, n_faces - 1)[n_faces - 1]
    return near[is_near], found[is_near]


def _squared_distances(points: NDArray[np.floating], center: int) -> NDArray[np.floating]:
    """Return the squared distances of points, shape (3, n), from one of them."""
    total = np.zeros(points.shape[1], points.dtype)
    for row in points:
        apart = row - row[center]
        apart *= apart
        total += apart
    return total


def _corners_of(surface: SurfaceMesh, faces: NDArray[np.intp]) -> NDArray[np.int32]:
    """Return the vertices of some faces, face by face."""
    sizes = surface.face_sizes()[faces]
    begin = np.repeat(surface.face_offset[faces] - (np.cumsum(sizes) - sizes), sizes)
    return surface.corner_vertex[begin + np.arange(len(begin))]


def _far_apart(centroids: NDArray[np.floating]) -> list[int]:
    """Return faces that are far from each other, by farthest-point sampling from the middle.

    Of huge meshes every so manieth face is looked at.
    """
    tried = np.arange(0, centroids.shape[1], max(1, centroids.shape[1] // _SEED_CANDIDATES))
    places = centroids[:, tried]
    nearest = ((places - places.mean(axis=1, keepdims=True)) ** 2).sum(axis=0)
    found: list[int] = []
    for _ in range(N_PATCHES):
        seed = int(nearest.argmax())
        found.append(int(tried[seed]))
        distance = _squared_distances(places, seed)
        nearest = distance if len(found) == 1 else np.minimum(nearest, distance)
    return found
