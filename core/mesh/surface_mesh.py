# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The arrays of a polygon mesh, laid out as Blender stores them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray


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
    """

    vertices: NDArray[np.floating]
    corner_vertex: NDArray[np.int32]
    corner_edge: NDArray[np.int32]
    face_offset: NDArray[np.int32]
    edges: NDArray[np.int32]

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
        size = self.common_face_size()
        if size:
            following = np.arange(1, self.n_corners + 1, dtype=np.int32)
            following[size - 1 :: size] -= np.int32(size)
            return following
        following = np.arange(1, self.n_corners + 1, dtype=np.int32)
        filled = np.diff(self.face_offset) > 0
        following[self.face_offset[1:][filled] - 1] = self.face_offset[:-1][filled]
        return following

    def previous_corner(self) -> NDArray[np.int32]:
        """Return, for each corner, the previous corner of its face, shape (C,), int32."""
        size = self.common_face_size()
        if size:
            preceding = np.arange(-1, self.n_corners - 1, dtype=np.int32)
            preceding[::size] += np.int32(size)
            return preceding
        preceding = np.arange(-1, self.n_corners - 1, dtype=np.int32)
        filled = np.diff(self.face_offset) > 0
        preceding[self.face_offset[:-1][filled]] = self.face_offset[1:][filled] - 1
        return preceding

    def with_vertices(self, vertices: NDArray[np.floating]) -> SurfaceMesh:
        """Return a mesh with the same faces and other positions, shape (N, 3)."""
        if np.shape(vertices) != self.vertices.shape:
            raise ValueError(
                f"The positions have shape {np.shape(vertices)}; expected {self.vertices.shape}."
            )
        return replace(self, vertices=vertices)

    @classmethod
    def from_faces(
        cls,
        vertices: ArrayLike,
        faces: Sequence[Sequence[int]] | NDArray[np.integer],
        loose_edges: ArrayLike = (),
    ) -> SurfaceMesh:
        """Make a mesh from lists of vertex numbers.

        Parameters
        ----------
        vertices : array_like, shape (N, 3)
            Positions; float32 stays float32, everything else becomes float64.
        faces : sequence of sequences of int, or ndarray of shape (F, k)
            The vertices of each face, in its orientation.
        loose_edges : array_like, shape (L, 2), optional
            Edges that belong to no face.

        Raises
        ------
        ValueError
            If the shapes are wrong or a face names a vertex that does not exist.
        """
        positions = np.asarray(vertices)
        if positions.dtype != np.float32:
            positions = positions.astype(np.float64)
        if positions.ndim != 2 or positions.shape[1] != 3:
            raise ValueError(f"The positions have shape {positions.shape}; expected (N, 3).")
        sizes = np.fromiter((len(face) for face in faces), np.int64, len(faces))
        flat = (
            np.concatenate([np.asarray(face, np.int64) for face in faces])
            if len(faces)
            else np.zeros(0, np.int64)
        )
        loose = np.asarray(loose_edges, np.int64).reshape(-1, 2)
        for what, numbers in (("face", flat), ("loose edge", loose)):
            if numbers.size and not (numbers.min() >= 0 and numbers.max() < len(positions)):
                wrong = numbers[(numbers < 0) | (numbers >= len(positions))].flat[0]
                raise ValueError(f"A {what} names vertex {wrong}, but there are {len(positions)} vertices.")
        offset = np.concatenate(([0], np.cumsum(sizes))).astype(np.int32)
        bare = cls(
            positions, flat.astype(np.int32), flat.astype(np.int32), offset, np.zeros((0, 2), np.int32)
        )
        pairs = np.stack((flat, flat[bare.next_corner()]), axis=1)
        keys = np.sort(np.concatenate((pairs, loose)), axis=1)
        keys = keys[:, 0] * max(len(positions), 1) + keys[:, 1]
        unique, edge = np.unique(keys, return_inverse=True)
        edges = np.stack(np.divmod(unique, max(len(positions), 1)), axis=1).astype(np.int32)
        return replace(bare, corner_edge=edge.reshape(-1)[: len(flat)].astype(np.int32), edges=edges)
