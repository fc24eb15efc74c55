# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes made in code: closed, open, irregular, mixed, non-manifold, twisted and degenerate ones.

The costly ones are made once, and are read-only.
"""

from functools import cache
from itertools import pairwise

import numpy as np
from checks import read_only, wild_mesh
from framelet.core.mesh.surface_mesh import SurfaceMesh


@cache
def triangle_torus(rows=12, columns=16):
    """Return a closed torus whose vertices all have six triangles."""
    number = np.arange(rows * columns).reshape(rows, columns)
    down, right = np.roll(number, -1, axis=0), np.roll(number, -1, axis=1)
    both = np.roll(down, -1, axis=1)
    faces = np.concatenate(
        (
            np.stack((number, down, both), -1).reshape(-1, 3),
            np.stack((number, both, right), -1).reshape(-1, 3),
        )
    )
    u = np.repeat(np.arange(rows), columns) * (2 * np.pi / rows)
    w = np.tile(np.arange(columns), rows) * (2 * np.pi / columns)
    radius = 3.0 + np.cos(u)
    return read_only(
        SurfaceMesh.from_faces(np.stack((radius * np.cos(w), radius * np.sin(w), np.sin(u)), 1), faces)
    )


def quad_torus(rows=7, columns=9):
    """Return a closed torus of quads."""
    number = np.arange(rows * columns).reshape(rows, columns)
    down, right = np.roll(number, -1, axis=0), np.roll(number, -1, axis=1)
    faces = np.stack((number, down, np.roll(down, -1, axis=1), right), -1).reshape(-1, 4)
    return SurfaceMesh.from_faces(triangle_torus(rows, columns).vertices, faces)


@cache
def triangle_grid(rows=8, columns=9):
    """Return an open flat sheet of triangles in the plane z = 0."""
    number = np.arange(rows * columns).reshape(rows, columns)
    a, b, c, d = number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]
    faces = np.concatenate((np.stack((a, b, c), -1).reshape(-1, 3), np.stack((a, c, d), -1).reshape(-1, 3)))
    y, x = np.divmod(np.arange(rows * columns), columns)
    return read_only(SurfaceMesh.from_faces(np.stack((x, -y, 0 * x), 1), faces))


def quad_grid(rows=6, columns=7):
    """Return an open flat sheet of quads in the plane z = 0."""
    number = np.arange(rows * columns).reshape(rows, columns)
    faces = np.stack((number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]), -1).reshape(-1, 4)
    return SurfaceMesh.from_faces(triangle_grid(rows, columns).vertices, faces)


def faces_of(mesh):
    """Return the faces as lists of vertex numbers."""
    return [mesh.corner_vertex[a:b].tolist() for a, b in pairwise(mesh.face_offset)]


def loose_edges_of(mesh):
    """Return the edges without a face, shape (L, 2)."""
    return mesh.edges[np.bincount(mesh.corner_edge, minlength=mesh.n_edges) == 0]


@cache
def flipped(mesh, seed=0, share=0.5):
    """Return a triangle mesh after random edge flips, so that valences are irregular, from 3 on."""
    rng = np.random.default_rng(seed)
    faces = faces_of(mesh)
    for _ in range(int(share * len(faces))):
        first = int(rng.integers(len(faces)))
        a, b, c = np.roll(faces[first], rng.integers(3)).tolist()
        across = [f for f, face in enumerate(faces) if f != first and a in face and b in face]
        if len(across) != 1:
            continue
        (d,) = set(faces[across[0]]) - {a, b}
        valence = [sum(v in face for face in faces) for v in (a, b)]
        if min(valence) <= 3 or any(c in face and d in face for face in faces):
            continue
        faces[first], faces[across[0]] = [c, a, d], [d, b, c]
    return read_only(SurfaceMesh.from_faces(mesh.vertices, faces))


def pyramid(sides=6, closed=False):
    """Return a fan around vertex 0, an open one or one closed to a cone without a base."""
    angle = np.arange(sides) * (2 * np.pi / sides if closed else 1.5 * np.pi / max(sides - 1, 1))
    rim = np.stack((np.cos(angle), np.sin(angle), 0.1 * np.cos(3 * angle)), 1)
    last = sides if closed else sides - 1
    faces = [(0, 1 + k, 1 + (k + 1) % sides) for k in range(last)]
    return SurfaceMesh.from_faces(np.concatenate(([[0, 0, 0.5]], rim)), faces)


def bow_tie(fans=2, size=3):
    """Return open fans that share vertex 0 alone."""
    parts = [pyramid(size + 1) for _ in range(fans)]
    points, faces = [parts[0].vertices[:1]], []
    for k, part in enumerate(parts):
        points.append(part.vertices[1:] + np.array([0.0, 0.0, 0.3 * k]))
        faces += [[0 if v == 0 else v + k * (size + 1) for v in face] for face in faces_of(part)]
    return SurfaceMesh.from_faces(np.concatenate(points), faces)


def tetrahedron():
    """Return a closed tetrahedron."""
    points = [(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)]
    return SurfaceMesh.from_faces(points, [(0, 1, 2), (0, 3, 1), (0, 2, 3), (1, 3, 2)])


def octahedron():
    """Return a closed octahedron: every vertex has valence four."""
    points = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
    faces = [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]
    return SurfaceMesh.from_faces(points, faces)


def prism(sides=8):
    """Return a closed prism: two n-gons and quads."""
    angle = np.arange(sides) * (2 * np.pi / sides)
    ring = np.stack((np.cos(angle), np.sin(angle)), 1)
    points = np.concatenate(
        (np.column_stack((ring, np.zeros(sides))), np.column_stack((ring, np.ones(sides))))
    )
    faces = [[k, (k + 1) % sides, sides + (k + 1) % sides, sides + k] for k in range(sides)]
    return SurfaceMesh.from_faces(points, [*faces, list(range(sides))[::-1], list(range(sides, 2 * sides))])


def mixed_sheet():
    """Return an open sheet of quads, triangles and a hexagon, with a loose edge and a loose vertex."""
    faces = faces_of(quad_grid(6, 7))
    faces = [f for k, f in enumerate(faces) if k not in (8, 9)]
    hexagon = [9, 16, 17, 18, 11, 10]
    triangles = [t for f in faces[:6] for t in (f[:3], [f[0], f[2], f[3]])]
    points = np.concatenate((quad_grid(6, 7).vertices, [[9.0, 9.0, 1.0], [9.0, 9.0, 2.0], [-5.0, 0.0, 1.0]]))
    return SurfaceMesh.from_faces(points, [*triangles, *faces[6:], hexagon], [(42, 43)])


def moebius_strip(length=11):
    """Return a Moebius strip of triangles, which cannot be oriented."""
    angle = np.arange(length) * (2 * np.pi / length)
    edges = np.array([-1.0, 0.0, 1.0])[:, None]
    radius = 4.0 + edges * np.cos(angle / 2)
    points = np.stack((radius * np.cos(angle), radius * np.sin(angle), edges * np.sin(angle / 2)), -1)
    faces = []
    for k in range(length):
        for row in range(2):
            here, there = [3 * k + row, 3 * k + row + 1], [3 * (k + 1) + row, 3 * (k + 1) + row + 1]
            if k == length - 1:  # the strip closes upside down
                there = [2 - row, 1 - row]
            faces += [[here[0], there[0], there[1]], [here[0], there[1], here[1]]]
    return SurfaceMesh.from_faces(points.transpose(1, 0, 2).reshape(-1, 3), faces)


def klein_bottle(rows=6, columns=8):
    """Return a closed surface of one side: quads, four at each vertex, at random places."""
    corner = np.arange(rows * columns).reshape(rows, columns)
    right = np.roll(corner, -1, axis=1)
    right[:, -1] = corner[-np.arange(rows) % rows, 0]  # the last column meets the first one upside down
    sides = (corner, right, np.roll(right, -1, axis=0), np.roll(corner, -1, axis=0))
    points = np.random.default_rng(0).normal(size=(rows * columns, 3))
    return SurfaceMesh.from_faces(points, np.stack(sides, axis=-1).reshape(-1, 4))


def turned_over(mesh, seed=0, share=0.5):
    """Return a mesh with a random share of its faces reversed."""
    rng = np.random.default_rng(seed)
    faces = [face[::-1] if rng.random() < share else face for face in faces_of(mesh)]
    return wild_mesh(mesh.vertices, faces, loose_edges_of(mesh))


def three_pages():
    """Return a regular sheet with a third page on one of its edges: a non-manifold edge."""
    sheet = triangle_grid(5, 5)
    points = np.concatenate((sheet.vertices, [[1.5, -2.0, 1.0]]))
    return SurfaceMesh.from_faces(points, [*faces_of(sheet), [11, 12, 25]])


def soup(seed, n_vertices=14, n_faces=12, shortest=3):
    """Return random polygons: repeated vertices, duplicate faces, and edges with any number of faces."""
    rng = np.random.default_rng(seed)
    faces = [rng.integers(n_vertices, size=rng.integers(shortest, 7)).tolist() for _ in range(n_faces)]
    faces += [faces[0], faces[-1][::-1]]
    return wild_mesh(rng.normal(size=(n_vertices, 3)), faces, rng.integers(n_vertices, size=(2, 2)))


def clean_soup(seed, n_vertices=9, n_faces=10):
    """Return random triangles of distinct vertices, few enough that many vertices stay manifold."""
    rng = np.random.default_rng(seed)
    faces = [rng.permutation(n_vertices)[:3].tolist() for _ in range(n_faces)]
    return wild_mesh(rng.normal(size=(n_vertices, 3)), faces)


def union(*meshes):
    """Return the meshes side by side as one mesh."""
    faces, points, loose, n = [], [], [], 0
    for k, mesh in enumerate(meshes):
        faces += [[v + n for v in face] for face in faces_of(mesh)]
        loose += (loose_edges_of(mesh) + n).tolist()
        points.append(mesh.vertices + np.array([20.0 * k, 0, 0], mesh.vertices.dtype))
        n += mesh.n_vertices
    return wild_mesh(np.concatenate(points), faces, loose)


def noisy(mesh, rng, sigma=0.15):
    """Return the mesh with noise in all directions, sigma times the mean edge length; 0 without edges."""
    if not mesh.n_edges:
        return mesh
    start = mesh.vertices[mesh.edges[:, 0]]
    edge = np.linalg.norm(mesh.vertices[mesh.edges[:, 1]] - start, axis=1).mean()
    return mesh.with_vertices(mesh.vertices + rng.normal(0, sigma * edge, mesh.vertices.shape))


MESHES = {
    "triangle torus": triangle_torus,
    "irregular torus": lambda: flipped(triangle_torus()),
    "quad torus": quad_torus,
    "triangle grid": triangle_grid,
    "irregular grid": lambda: flipped(triangle_grid(), seed=1),
    "quad grid": quad_grid,
    "single triangle": lambda: SurfaceMesh.from_faces(np.eye(3), [(0, 1, 2)]),
    "single quad": lambda: quad_grid(2, 2),
    "open fan": lambda: pyramid(9),
    "closed fan": lambda: pyramid(7, closed=True),
    "tetrahedron": tetrahedron,
    "octahedron": octahedron,
    "prism": prism,
    "mixed sheet": mixed_sheet,
    "moebius strip": moebius_strip,
    "turned-over torus": lambda: turned_over(flipped(triangle_torus(), seed=2)),
    "turned-over sheet": lambda: turned_over(mixed_sheet(), seed=3),
    "bow tie": lambda: bow_tie(3),
    "three pages": three_pages,
    "soup": lambda: soup(0),
}
"""Builders of small meshes by name; all are exact, and so need noise where noise matters."""
