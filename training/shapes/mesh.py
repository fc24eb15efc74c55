# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Polygon meshes as three arrays, and the few operations that every family of shapes needs."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray


class Mesh(NamedTuple):
    """A polygon mesh: positions (N, 3), where faces start (F + 1,), and their vertices (C,).

    `noisy`, shape (N, 3), are positions with the errors of what made the mesh, if it made any. `grid`, shape
    (3, 3), belongs to a range image: scalar products with the first two rows count columns and rows of the
    sensor, the third row is the line of sight.
    """

    vertices: NDArray[np.float64]
    face_offset: NDArray[np.int32]
    corner_vertex: NDArray[np.int32]
    noisy: NDArray[np.float64] | None = None
    grid: NDArray[np.float64] | None = None

    @property
    def n_faces(self) -> int:
        """Number of faces."""
        return len(self.face_offset) - 1

    def moved(self, vertices) -> Mesh:
        """Return the same faces with other positions."""
        return self._replace(vertices=np.asarray(vertices, float))


def from_faces(vertices, faces) -> Mesh:
    """Make a mesh of faces that all have the same number of corners (F, k)."""
    faces = np.asarray(faces, np.int32)
    offset = np.arange(len(faces) + 1, dtype=np.int32) * faces.shape[1]
    return Mesh(np.asarray(vertices, float), offset, faces.ravel())


def from_lists(vertices, faces) -> Mesh:
    """Make a mesh of faces of any sizes, a list of lists of vertices."""
    sizes = np.array([len(face) for face in faces])
    offset = np.concatenate([[0], np.cumsum(sizes)]).astype(np.int32)
    return Mesh(np.asarray(vertices, float), offset, np.concatenate(faces).astype(np.int32))


def triangulated(mesh: Mesh) -> NDArray[np.int32]:
    """Return triangles (T, 3): fans around the first corner of each face."""
    sizes = np.diff(mesh.face_offset)
    triangles = []
    for size in np.unique(sizes):
        first = mesh.face_offset[:-1][sizes == size]
        for k in range(1, size - 1):
            triangles.append(mesh.corner_vertex[first[:, None] + [0, k, k + 1]])
    return np.concatenate(triangles)


def half_edges(mesh: Mesh) -> tuple[NDArray, NDArray, NDArray]:
    """Return start, end and face of each corner's edge."""
    sizes = np.diff(mesh.face_offset)
    following = np.arange(len(mesh.corner_vertex)) + 1
    following[mesh.face_offset[1:] - 1] = mesh.face_offset[:-1]
    face = np.repeat(np.arange(len(sizes)), sizes)
    return mesh.corner_vertex, mesh.corner_vertex[following], face


def edge_lengths(mesh: Mesh) -> NDArray:
    """Length of each half edge."""
    start, end, _ = half_edges(mesh)
    return np.linalg.norm(mesh.vertices[start] - mesh.vertices[end], axis=1)


def mean_edge(mesh: Mesh) -> float:
    """Mean length of the edges."""
    return float(edge_lengths(mesh).mean())


def face_areas(vertices, triangles) -> NDArray:
    """Areas of triangles."""
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)


def area(mesh: Mesh) -> float:
    """Area of the surface."""
    return float(face_areas(mesh.vertices, triangulated(mesh)).sum())


def volume(mesh: Mesh) -> float:
    """Signed volume, positive when the faces of a closed mesh look outward."""
    a, b, c = (mesh.vertices[column] for column in triangulated(mesh).T)
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6)


def vertex_normals(mesh: Mesh) -> NDArray:
    """Normals of vertices, weighted with area."""
    triangles = triangulated(mesh)
    a, b, c = (mesh.vertices[column] for column in triangles.T)
    normal = np.cross(b - a, c - a)
    result = np.zeros_like(mesh.vertices)
    for k in range(3):
        for axis in range(3):
            result[:, axis] += np.bincount(triangles[:, k], normal[:, axis], len(result))
    return result / np.maximum(np.linalg.norm(result, axis=1), 1e-300)[:, None]


def flipped(mesh: Mesh) -> Mesh:
    """Return the mesh with all faces turned round."""
    start = np.repeat(mesh.face_offset[:-1], np.diff(mesh.face_offset))
    end = np.repeat(mesh.face_offset[1:], np.diff(mesh.face_offset))
    return mesh._replace(corner_vertex=mesh.corner_vertex[start + end - 1 - np.arange(len(start))])


def select_faces(mesh: Mesh, keep) -> Mesh:
    """Keep some faces, and only the vertices that they use."""
    sizes = np.diff(mesh.face_offset)
    corners = mesh.corner_vertex[np.repeat(keep, sizes)]
    offset = np.concatenate([[0], np.cumsum(sizes[keep])]).astype(np.int32)
    used, corner_vertex = np.unique(corners, return_inverse=True)
    noisy = None if mesh.noisy is None else mesh.noisy[used]
    return Mesh(mesh.vertices[used], offset, corner_vertex.ravel().astype(np.int32), noisy, mesh.grid)


def joined(meshes) -> Mesh:
    """Put meshes into one, without connecting them."""
    shift = np.cumsum([0] + [len(mesh.vertices) for mesh in meshes])
    corner = np.cumsum([0] + [len(mesh.corner_vertex) for mesh in meshes])
    return Mesh(
        np.concatenate([mesh.vertices for mesh in meshes]),
        np.concatenate(
            [[0]] + [mesh.face_offset[1:] + c for mesh, c in zip(meshes, corner, strict=False)]
        ).astype(np.int32),
        np.concatenate([mesh.corner_vertex + s for mesh, s in zip(meshes, shift, strict=False)]).astype(
            np.int32
        ),
    )


def face_islands(mesh: Mesh) -> NDArray:
    """Number the connected parts: for each face, that of its part."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    start, end, _ = half_edges(mesh)
    n = len(mesh.vertices)
    graph = coo_matrix((np.ones(len(start), bool), (start, end)), (n, n))
    _, label = connected_components(graph, directed=False)
    return label[mesh.corner_vertex[mesh.face_offset[:-1]]]


def largest_island(mesh: Mesh) -> Mesh:
    """Keep the connected part that has the most faces."""
    label = face_islands(mesh)
    return select_faces(mesh, label == np.bincount(label).argmax())


def bends(mesh: Mesh) -> NDArray:
    """Angles between the normals of neighboring triangles, in degrees, each edge twice."""
    triangles = triangulated(mesh)
    a, b, c = (mesh.vertices[column] for column in triangles.T)
    normal = np.cross(b - a, c - a)
    normal /= np.maximum(np.linalg.norm(normal, axis=1), 1e-300)[:, None]
    start, end, face = half_edges(from_faces(mesh.vertices, triangles))
    n = len(mesh.vertices)
    key = start.astype(np.int64) * n + end
    opposite = end.astype(np.int64) * n + start
    order = np.argsort(key)
    place = np.minimum(np.searchsorted(key[order], opposite), len(key) - 1)
    found = key[order][place] == opposite
    cosine = np.einsum("ij,ij->i", normal[face[found]], normal[face[order[place[found]]]])
    return np.degrees(np.arccos(np.clip(cosine, -1, 1)))


class Condition(NamedTuple):
    """What is wrong with a mesh, in counts."""

    degenerate: int
    """Triangles with an area below 1e-7 of a triangle of mean edges."""
    non_manifold: int
    """Half edges that more than one face has in this direction."""
    border: int
    """Half edges without an opposite one."""
    pinched: int
    """Vertices where more than one fan of faces meets."""


def condition(mesh: Mesh) -> Condition:
    """Count what is wrong with a mesh."""
    start, end, _ = half_edges(mesh)
    n = len(mesh.vertices)
    key = start.astype(np.int64) * n + end
    opposite = end.astype(np.int64) * n + start
    unique, counts = np.unique(key, return_counts=True)
    border = ~np.isin(opposite, unique)
    # Of a manifold vertex, corners and border half edges that start here say whether there is one fan.
    leaving = np.bincount(start[border], minlength=n)
    arriving = np.bincount(end[border], minlength=n)
    pinched = int(((leaving > 1) | (arriving > 1)).sum()) + _split_fans(mesh)
    areas = face_areas(mesh.vertices, triangulated(mesh))
    return Condition(
        int((areas < 1e-7 * mean_edge(mesh) ** 2).sum()), int((counts > 1).sum()), int(border.sum()), pinched
    )


def _split_fans(mesh: Mesh) -> int:
    """Count vertices without border whose faces form more than one closed fan."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    start, end, _ = half_edges(mesh)
    n, c = len(mesh.vertices), len(start)
    previous = np.empty(c, int)
    following = np.arange(c) + 1
    following[mesh.face_offset[1:] - 1] = mesh.face_offset[:-1]
    previous[following] = np.arange(c)
    key = start.astype(np.int64) * n + end
    order = np.argsort(key)
    opposite = end.astype(np.int64) * n + start
    place = np.minimum(np.searchsorted(key[order], opposite), c - 1)
    found = key[order][place] == opposite
    twin = order[place]
    # The corner at the start of this half edge joins the corner after its twin: both are at the same vertex.
    graph = coo_matrix((np.ones(found.sum(), bool), (np.arange(c)[found], following[twin[found]])), (c, c))
    n_fans, _ = connected_components(graph, directed=False)
    return int(n_fans - len(np.unique(start)))
