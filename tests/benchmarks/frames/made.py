# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Clean meshes made in code, for checkouts without the development meshes and for quick runs."""

import checkout  # noqa: F401
import numpy as np
from framelet.core import SurfaceMesh
from meshes import faces_of, flipped, quad_torus, triangle_torus


def box(n):
    """Return the surface of a cube as n x n quads a side: sharp edges, corners of valence three."""
    step = np.arange(n + 1)
    u, w = (grid.ravel() for grid in np.meshgrid(step, step, indexing="ij"))
    number = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
    sheet = np.stack((number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]), -1).reshape(-1, 4)
    points, faces = [], []
    for axis in range(3):
        for side in (0, n):
            place = np.empty((len(u), 3), int)
            place[:, axis], place[:, (axis + 1) % 3], place[:, (axis + 2) % 3] = side, u, w
            faces.append((sheet if side else sheet[:, ::-1]) + len(u) * len(points))
            points.append(place)
    unique, number_of = np.unique(np.concatenate(points), axis=0, return_inverse=True)
    faces = number_of.reshape(-1)[np.concatenate(faces)]
    return SurfaceMesh.from_faces(2.0 * unique / n - 1.0, faces)


def bumpy_sphere(n):
    """Return a sphere with smooth bumps, on the quads of a box."""
    cube = box(n)
    direction = np.tan(cube.vertices * (np.pi / 4))
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    bumps = np.prod(np.sin(4.0 * direction + np.array([0.3, 0.7, 1.1])), axis=1)
    return cube.with_vertices(direction * (1.0 + 0.2 * bumps)[:, None])


def triangulated(mesh):
    """Return a mesh of quads with each quad cut along its diagonal from its first corner."""
    faces = [part for a, b, c, d in faces_of(mesh) for part in ((a, b, c), (a, c, d))]
    return SurfaceMesh.from_faces(mesh.vertices, faces)


MADE = {
    "made/torus_tri": lambda: triangle_torus(30, 60),
    "made/torus_irregular": lambda: flipped(triangle_torus(20, 40)),
    "made/box_tri": lambda: triangulated(box(16)),
    "made/bumpy_sphere_tri": lambda: triangulated(bumpy_sphere(20)),
    "made/torus_quad": lambda: quad_torus(30, 60),
    "made/box_quad": lambda: box(16),
    "made/bumpy_sphere_quad": lambda: bumpy_sphere(20),
}
"""Builders of meshes by name."""
