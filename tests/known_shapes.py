# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Shapes that are worth cleaning, some thousand faces each, and noise of all kinds, made in code."""

from functools import cache

import numpy as np
from checks import lengths, read_only
from framelet.core.mesh.geometry import vertex_normals
from framelet.core.mesh.surface_mesh import SurfaceMesh
from meshes import faces_of, quad_torus, triangle_torus


@cache
def cube(size=16):
    """Return a closed cube of triangles whose edges are one long."""
    number, faces = {}, []
    for axis in range(3):
        for side in (0, size):
            for u, w in np.ndindex(size, size):
                square = [(side, u + a, w + b) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
                square = [number.setdefault(tuple(np.roll(place, axis)), len(number)) for place in square]
                a, b, c, d = square if side else square[::-1]
                # Diagonals in turn, so that corners are alike.
                faces += [(a, b, c), (a, c, d)] if (u + w) % 2 else [(a, b, d), (b, c, d)]
    return read_only(SurfaceMesh.from_faces(np.array(list(number), float), faces))


@cache
def sphere(size=16):
    """Return a cube with its sides rounded to a sphere: triangles of several shapes, edges about one long."""
    points = np.tan((cube(size).vertices / size - 0.5) * np.pi / 2)
    return read_only(cube(size).with_vertices(0.65 * size * points / lengths(points)[:, None]))


@cache
def stairs(n_steps=3, size=6):
    """Return a closed machine part of quads with convex and concave edges: voxels in steps."""
    inside = np.zeros((n_steps * size, 2 * size, n_steps * size), bool)
    for step in range(n_steps):
        inside[step * size :, :, step * size : (step + 1) * size] = True
    inside[-size:, : size // 2, -size:] = False
    return read_only(voxel_surface(inside))


@cache
def part(n_steps=3, size=6):
    """Return the same machine part of triangles."""
    quads = stairs(n_steps, size)
    a, b, c, d = np.array(faces_of(quads)).T
    faces = np.concatenate((np.stack((a, b, c), 1), np.stack((a, c, d), 1)))
    return read_only(SurfaceMesh.from_faces(quads.vertices, faces))


def voxel_surface(inside):
    """Return the quads between the voxels inside and those outside, an array of bool."""
    inside = np.pad(inside, 1)
    quads = []
    for axis in range(3):
        change = np.diff(inside.astype(int), axis=axis)
        places = np.argwhere(change)
        corner = places + np.eye(3, dtype=int)[axis]
        u, v = np.eye(3, dtype=int)[(axis + 1) % 3], np.eye(3, dtype=int)[(axis + 2) % 3]
        faces = np.stack([corner, corner + u, corner + u + v, corner + v], axis=1)
        enters = change[tuple(places.T)] > 0
        faces[enters] = faces[enters][:, ::-1]
        quads.append(faces)
    grid, numbers = np.unique(np.concatenate(quads).reshape(-1, 3), axis=0, return_inverse=True)
    return SurfaceMesh.from_faces(grid.astype(float), numbers.reshape(-1, 4))


def hexagons(mesh):
    """Return the dual of a closed triangle mesh: a polygon around each vertex, mostly hexagons."""
    around = [[] for _ in range(mesh.n_vertices)]
    faces = faces_of(mesh)
    for f, face in enumerate(faces):
        for place, v in enumerate(face):
            around[v].append((face[(place + 1) % 3], face[(place + 2) % 3], f))
    polygons = []
    for own in around:
        following = {start: (end, f) for start, end, f in own}
        start, polygon = own[0][0], []
        for _ in own:
            start, f = following[start]
            polygon.append(f)
        polygons.append(polygon)
    return SurfaceMesh.from_faces(np.array([mesh.vertices[face].mean(axis=0) for face in faces]), polygons)


SHAPES = {
    "sphere": sphere,
    "cube": cube,
    "part": part,
    "quad part": stairs,
    "torus": lambda: triangle_torus(40, 80),
    "quad torus": lambda: quad_torus(40, 80),
    "hexagon torus": lambda: hexagons(triangle_torus(30, 60)),
}


def edge_of(mesh):
    """Return the mean edge length."""
    return lengths(mesh.vertices[mesh.edges[:, 0]] - mesh.vertices[mesh.edges[:, 1]]).mean()


def lifted(mesh, heights):
    """Return the mesh with its vertices moved along their normals by heights in mean edges."""
    return mesh.with_vertices(
        mesh.vertices + edge_of(mesh) * vertex_normals(mesh) * np.asarray(heights)[:, None]
    )


def white(mesh, rng):
    """Return a random number for each vertex."""
    return rng.normal(size=mesh.n_vertices)


def wide(mesh, rng, n_averages):
    """Return random numbers averaged with their rings, with mean square 1."""
    heights = white(mesh, rng)
    one, other = mesh.edges.T
    valence = np.bincount(mesh.edges.ravel(), minlength=mesh.n_vertices)
    for _ in range(n_averages):
        around = np.bincount(one, heights[other], mesh.n_vertices)
        around += np.bincount(other, heights[one], mesh.n_vertices)
        heights = 0.5 * (heights + around / np.maximum(valence, 1))
    return heights / np.sqrt((heights**2).mean())
