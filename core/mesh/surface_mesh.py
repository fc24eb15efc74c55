# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The arrays of a polygon mesh, laid out as Blender stores them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import MeshError
from .edge_list import find_edges
from .face_checks import (
    check_corners,
    check_faces,
    check_range,
    check_repeats,
    check_shape,
    check_sizes,
    corner_list,
    flat_corners,
    positions_of,
    whole_numbers,
)


@dataclass(frozen=True, eq=False)
class SurfaceMesh:
    """A polygon mesh: any mixture of triangles, quads and n-gons, with or without loose parts.

    A *corner* is a vertex of a face; the corners of face f are `face_offset[f]` to `face_offset[f + 1]`, in
    the face's orientation. The edge of a corner runs from its vertex to the vertex of the face's next corner.

    Attributes
    ----------
    vertices : ndarray, shape (N, 3), float32 or float64
        Positions in object space, in scene units.
    corner_vertex : ndarray, shape (C,), int32
        Vertex of each corner.
    corner_edge : ndarray, shape (C,), int32
        Edge of each corner.
    face_offset : ndarray, shape (F + 1,), int32
        First corner of each face, and the number of corners at the end.
    edges : ndarray, shape (E, 2), int32
        The two vertices of each edge, edges without a face included.

    Raises
    ------
    MeshError
        On construction, in one sentence, if an array has another shape or type, a face has less than three
        corners or a vertex twice, or an edge is not that of its corner.

    Examples
    --------
    >>> mesh = SurfaceMesh.from_faces([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2, 3]])
    >>> mesh
    SurfaceMesh(4 vertices, 1 faces, float64)
    >>> SurfaceMesh.from_faces([[0, 0, 0], [1, 0, 0], [1, 1, 0]], [[0, 1, 3]])
    Traceback (most recent call last):
    ...
    framelet.core.errors.MeshError: Face 0 names vertex 3, but there are 3 vertices.
    """

    vertices: NDArray[np.floating]
    corner_vertex: NDArray[np.int32]
    corner_edge: NDArray[np.int32]
    face_offset: NDArray[np.int32]
    edges: NDArray[np.int32]

    def __post_init__(self) -> None:
        check_shape(self.vertices)
        check_corners(self)
        check_faces(self)

    def __repr__(self) -> str:
        return f"SurfaceMesh({self.n_vertices} vertices, {self.n_faces} faces, {self.vertices.dtype})"

    @classmethod
    def trusted(
        cls,
        vertices: NDArray[np.floating],
        corner_vertex: NDArray[np.int32],
        corner_edge: NDArray[np.int32],
        face_offset: NDArray[np.int32],
        edges: NDArray[np.int32],
    ) -> SurfaceMesh:
        """Return a mesh of arrays that are known to fit each other, without looking at them.

        Programs that keep meshes of their own, as Blender does, may have faces in them that the constructor
        refuses; all methods cope with these.
        """
        mesh = object.__new__(cls)
        names = ("vertices", "corner_vertex", "corner_edge", "face_offset", "edges")
        mesh.__dict__.update(
            zip(names, (vertices, corner_vertex, corner_edge, face_offset, edges), strict=True)
        )
        return mesh

    def frozen(self) -> SurfaceMesh:
        """Return this mesh with arrays that nobody can write to: its own where they are so, else copies."""
        arrays = [getattr(self, item.name) for item in fields(self)]
        if all(map(_is_frozen, arrays)):
            return self
        return SurfaceMesh.trusted(*map(_frozen, arrays))

    @property
    def n_vertices(self) -> int:
        """Number of vertices."""
        return len(self.vertices)

    @property
    def n_faces(self) -> int:
        """Number of faces."""
        return len(self.face_offset) - 1

    @property
    def n_corners(self) -> int:
        """Number of face corners."""
        return len(self.corner_vertex)

    @property
    def n_edges(self) -> int:
        """Number of edges, loose ones included."""
        return len(self.edges)

    def face_sizes(self) -> NDArray[np.int32]:
        """Return the number of corners of each face, shape (F,), int32."""
        return np.diff(self.face_offset)

    def face_of_corner(self) -> NDArray[np.int32]:
        """The face of each corner, shape (C,)."""
        return np.repeat(np.arange(self.n_faces, dtype=np.int32), self.face_sizes())

    def common_face_size(self) -> int:
        """Return the number of corners that all faces have; 0 if they differ or there is no face."""
        return self._common_face_size

    @cached_property
    def _common_face_size(self) -> int:
        if not self.n_faces or self.n_corners % self.n_faces:
            return 0
        size = self.n_corners // self.n_faces
        step = 2**16  # differences are compared in the cache
        is_common = all(
            (np.diff(self.face_offset[start : start + step + 1]) == size).all()
            for start in range(0, self.n_faces, step)
        )
        return size if size and is_common else 0

    def next_corner(self) -> NDArray[np.int32]:
        """Return, for each corner, the next corner of its face, shape (C,), int32."""
        following = np.arange(1, self.n_corners + 1, dtype=np.int32)
        filled = np.flatnonzero(np.diff(self.face_offset))
        following[self.face_offset[1:][filled] - 1] = self.face_offset[filled]
        return following

    def previous_corner(self) -> NDArray[np.int32]:
        """Return, for each corner, the previous corner of its face, shape (C,), int32."""
        preceding = np.arange(-1, self.n_corners - 1, dtype=np.int32)
        filled = np.flatnonzero(np.diff(self.face_offset))
        preceding[self.face_offset[filled]] = self.face_offset[1:][filled] - 1
        return preceding

    def with_vertices(self, vertices: ArrayLike) -> SurfaceMesh:
        """Return a mesh with the same faces and other positions, shape (N, 3).

        Raises
        ------
        MeshError
            If the shape is another one, or these are no real numbers.
        """
        positions = positions_of(vertices)
        if positions.shape != self.vertices.shape:
            raise MeshError(f"The positions have shape {positions.shape}; expected {self.vertices.shape}.")
        return SurfaceMesh.trusted(
            positions, self.corner_vertex, self.corner_edge, self.face_offset, self.edges
        )

    @classmethod
    def from_faces(
        cls,
        vertices: ArrayLike,
        faces: ArrayLike | Sequence[Sequence[int]],
        loose_edges: ArrayLike = (),
        *,
        offsets: ArrayLike | None = None,
    ) -> SurfaceMesh:
        """Make a mesh from lists of vertex numbers.

        Parameters
        ----------
        vertices : array_like, shape (N, 3)
            Positions; float32 stays float32, everything else becomes float64.
        faces : array_like of int, shape (F, k), or sequence of sequences of int
            The vertices of each face, in its orientation.
        loose_edges : array_like of int, shape (L, 2), optional
            Edges that belong to no face.
        offsets : array_like of int, shape (F + 1,), optional
            First corner of each face, and the number of corners at the end: `faces` is then the flat list of
            the vertices of all corners, shape (C,).

        Raises
        ------
        MeshError
            In one sentence, if the shapes are wrong, if a number is not whole, or if a face has less than
            three corners, names a vertex twice or one that does not exist.

        Examples
        --------
        >>> mesh = SurfaceMesh.from_faces(np.eye(3), [[0, 1, 2]])
        >>> mesh.edges.tolist()
        [[0, 1], [0, 2], [1, 2]]
        >>> SurfaceMesh.from_faces(np.zeros((5, 3)), [0, 1, 2, 0, 2, 3, 4], offsets=[0, 3, 7]).face_sizes()
        array([3, 4], dtype=int32)
        """
        positions = positions_of(vertices)
        flat, offset = corner_list(faces) if offsets is None else flat_corners(faces, offsets)
        loose = whole_numbers(loose_edges, "loose edges").reshape(-1, 2)
        check_range(flat, len(positions), "A face", offset)
        check_range(loose.reshape(-1), len(positions), "A loose edge")
        corner = flat.astype(np.int32)
        bare = cls.trusted(positions, corner, corner, offset, np.zeros((0, 2), np.int32))
        check_sizes(bare)
        following = corner[bare.next_corner()]
        check_repeats(bare, following)
        edges, edge = find_edges(corner, following, loose, len(positions))
        return cls.trusted(positions, corner, edge, offset, edges)


def _is_frozen(array: NDArray[Any]) -> bool:
    """Tell whether neither an array nor what it is a view of can be written to."""
    owner: Any = array
    while isinstance(owner, np.ndarray):
        if owner.flags.writeable:
            return False
        owner = owner.base
    return owner is None


def _frozen(array: NDArray[Any]) -> NDArray[Any]:
    """Return an array that cannot be written to: itself, or a copy."""
    if not _is_frozen(array):
        array = array.copy()
        array.flags.writeable = False
    return array
