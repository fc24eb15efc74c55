# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What tests of regions share: presets of all methods, measures by rings and edges, meshes with creases."""

import numpy as np
from checks import wild_mesh
from framelet.core.mesh.geometry import face_normals
from framelet.core.mesh.surface_mesh import SurfaceMesh
from meshes import faces_of

METHODS = ("TRI_2", "BILATERAL", "AUTO")
"""A preset of each method."""


def rings_from(mesh, start):
    """Return how many edges each vertex is away from a set of vertices; 99 where none leads there."""
    ring = np.where(start, 0, 99)
    for step in range(1, 99):
        one, other = mesh.edges.T
        reached = np.concatenate((other[ring[one] == step - 1], one[ring[other] == step - 1]))
        reached = reached[ring[reached] == 99]
        if not len(reached):
            break
        ring[reached] = step
    return ring


def dihedral_angles(mesh):
    """Return the edges between two faces, shape (n, 2), and the angles of the normals there, in degrees."""
    faces = {}
    for face, corners in enumerate(faces_of(mesh)):
        for a, b in zip(corners, corners[1:] + corners[:1], strict=True):
            faces.setdefault((min(a, b), max(a, b)), []).append(face)
    edges = np.array([edge for edge, two in faces.items() if len(two) == 2])
    pairs = np.array([two for two in faces.values() if len(two) == 2])
    normals = face_normals(mesh)
    cosine = (normals[pairs[:, 0]] * normals[pairs[:, 1]]).sum(axis=1)
    return edges, np.degrees(np.arccos(np.clip(cosine, -1, 1)))


def roof(length=40, width=8):
    """Return an open roof of triangles with its ridge along x at z = 0, and the edges of the ridge."""
    x, y = np.meshgrid(np.arange(length, dtype=float), np.arange(-width, width + 1, dtype=float))
    points = np.stack((x, 0.7 * y, -0.7 * np.abs(y)), -1).reshape(-1, 3)
    number = np.arange(len(points)).reshape(2 * width + 1, length)
    a, b, c, d = number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]
    faces = np.concatenate((np.stack((a, b, c), -1).reshape(-1, 3), np.stack((a, c, d), -1).reshape(-1, 3)))
    ridge = number[width]
    return SurfaceMesh.from_faces(points, faces), np.stack((ridge[:-1], ridge[1:]), axis=1)


def box(size=8):
    """Return a closed cube of size^2 pairs of triangles a side, and the edges of its twelve edges."""
    points, faces = {}, []

    def number(*place):
        return points.setdefault(place, len(points))

    for axis in range(3):
        for side in (0, size):
            for u in range(size):
                for v in range(size):
                    square = []
                    for a, b in ((u, v), (u + 1, v), (u + 1, v + 1), (u, v + 1)):
                        place = [0, 0, 0]
                        place[axis], place[(axis + 1) % 3], place[(axis + 2) % 3] = side, a, b
                        square.append(number(*place))
                    square = square if side else square[::-1]
                    faces += [square[:3], [square[0], square[2], square[3]]]
    mesh = SurfaceMesh.from_faces(np.array(list(points), float), faces)
    edges, angle = dihedral_angles(mesh)
    return mesh, edges[angle > 45]


def exploded(mesh):
    """Return a mesh each of whose faces has vertices of its own, and the vertex that each of them was."""
    corners = mesh.corner_vertex
    sizes = mesh.face_sizes()
    faces = np.split(np.arange(len(corners)), np.cumsum(sizes)[:-1])
    return wild_mesh(mesh.vertices[corners], faces), corners


def renumbered(mesh, rng):
    """Return a mesh with its vertices and faces in another order, and the new number of each vertex."""
    new = rng.permutation(mesh.n_vertices)
    faces = [np.roll(new[face], rng.integers(5)) for face in faces_of(mesh)]
    vertices = np.empty_like(mesh.vertices)
    vertices[new] = mesh.vertices
    return wild_mesh(vertices, [faces[k] for k in rng.permutation(len(faces))]), new
