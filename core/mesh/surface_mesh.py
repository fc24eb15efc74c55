# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The arrays of a polygon mesh, laid out as Blender stores them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, fields
from functools import cached_property
from itertools import chain
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .edge_list import find_edges


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
    ValueError
        On construction, in one sentence, if an array has another shape or type, a face has less than three
        corners or a vertex twice, or an edge is not that of its corner.

    Examples
    --------
    >>> mesh = SurfaceMesh.from_faces([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2, 3]])
    >>> mesh
    SurfaceMesh(4 vertices, 1 faces, float64)
    >>> SurfaceMesh.from_faces([[0, 0, 0], [1, 0, 0], [1, 1, 0]], [[0, 1, 1]])
    Traceback (most recent call last):
    ...
    ValueError: Face 0 names vertex 1 twice; a face needs three or more different vertices.
    """

    vertices: NDArray[np.floating]
    corner_vertex: NDArray[np.int32]
    corner_edge: NDArray[np.int32]
    face_offset: NDArray[np.int32]
    edges: NDArray[np.int32]

    def __post_init__(self) -> None:
        _check_positions(self.vertices)
        _check_corners(self)
        _check_faces(self)

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
        for name, array in (
            ("vertices", vertices),
            ("corner_vertex", corner_vertex),
            ("corner_edge", corner_edge),
            ("face_offset", face_offset),
            ("edges", edges),
        ):
            object.__setattr__(mesh, name, array)
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

    def with_vertices(self, vertices: ArrayLike) -> SurfaceMesh:
        """Return a mesh with the same faces and other positions, shape (N, 3).

        Raises
        ------
        ValueError
            If the shape is another one.
        """
        positions = np.asarray(vertices)
        if positions.dtype not in (np.float32, np.float64):
            positions = positions.astype(np.float64)
        if positions.shape != self.vertices.shape:
            raise ValueError(f"The positions have shape {positions.shape}; expected {self.vertices.shape}.")
        return SurfaceMesh.trusted(
            positions, self.corner_vertex, self.corner_edge, self.face_offset, self.edges
        )

    @classmethod
    def from_faces(
        cls,
        vertices: ArrayLike,
        faces: ArrayLike | Sequence[Sequence[int]],
        loose_edges: ArrayLike = (),
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

        Raises
        ------
        ValueError
            In one sentence, if the shapes are wrong, if a number is not whole, or if a face has less than
            three corners, names a vertex twice or one that does not exist.

        Examples
        --------
        >>> mesh = SurfaceMesh.from_faces(np.eye(3), [[0, 1, 2]])
        >>> mesh.edges.tolist()
        [[0, 1], [0, 2], [1, 2]]
        """
        positions = _positions(vertices)
        flat, offset = _corner_list(faces)
        loose = _whole_numbers(np.asarray(loose_edges), "loose edges").reshape(-1, 2)
        _check_range(flat, len(positions), "A face", offset)
        _check_range(loose.reshape(-1), len(positions), "A loose edge")
        corner = flat.astype(np.int32)
        bare = cls.trusted(positions, corner, corner, offset, np.zeros((0, 2), np.int32))
        _check_sizes(bare)
        following = corner[bare.next_corner()]
        _check_repeats(bare, following)
        edges, edge = find_edges(corner, following, loose, len(positions))
        return cls.trusted(positions, corner, edge, offset, edges)


def _positions(vertices: ArrayLike) -> NDArray[np.floating]:
    """Return positions as an array of float32 or float64, shape (N, 3)."""
    positions = np.asarray(vertices)
    if positions.dtype.kind not in "iuf":
        raise ValueError(f"The positions are {positions.dtype}; expected real numbers.")
    if positions.dtype != np.float32:
        positions = positions.astype(np.float64)
    _check_positions(positions)
    return positions


def _check_positions(positions: NDArray[np.floating]) -> None:
    """Raise ValueError unless these are positions, shape (N, 3), float32 or float64."""
    if positions.ndim != 2 or positions.shape[1] != 3:
        raise ValueError(f"The positions have shape {positions.shape}; expected (N, 3).")
    if positions.dtype not in (np.float32, np.float64):
        raise ValueError(f"The positions are {positions.dtype}; expected float32 or float64.")
    if len(positions) >= 2**31:
        raise ValueError(f"There are {len(positions):,} vertices; at most {2**31 - 1:,} can be numbered.")


def _corner_list(
    faces: ArrayLike | Sequence[Sequence[int]],
) -> tuple[NDArray[np.integer], NDArray[np.int32]]:
    """Return the vertices of all corners, shape (C,), and the first corner of each face, shape (F + 1,)."""
    if isinstance(faces, np.ndarray) and faces.ndim == 2:
        flat = _whole_numbers(faces, "faces").reshape(-1)
        return flat, np.arange(len(faces) + 1, dtype=np.int32) * np.int32(faces.shape[1])
    if not isinstance(faces, Iterable):
        raise ValueError(f"The faces are {faces!r}; expected an array of shape (F, k) or a list of lists.")
    rows: list[Any] = list(faces)
    if any(np.ndim(row) != 1 for row in (rows[:1] if rows else ())) or not all(
        hasattr(row, "__len__") for row in rows
    ):
        raise ValueError("The faces are no lists of vertices; expected shape (F, k) or a list of lists.")
    sizes = np.fromiter(map(len, rows), np.int64, len(rows))
    offset = np.concatenate(([0], np.cumsum(sizes)))
    items = list(chain.from_iterable(rows))
    if not items:
        return np.zeros(0, np.int32), offset.astype(np.int32)
    if not {bool, np.bool_}.isdisjoint(map(type, items)):
        raise ValueError("The faces contain True or False; vertices are given by whole numbers.")
    return _whole_numbers(np.asarray(items), "faces"), offset.astype(np.int32)


def _whole_numbers(numbers: NDArray, name: str) -> NDArray[np.integer]:
    """Return an array of whole numbers, or raise ValueError if it holds anything else."""
    if numbers.size and numbers.dtype.kind not in "iu":
        raise ValueError(f"The {name} are {numbers.dtype}; vertices are given by whole numbers.")
    return numbers if numbers.size else numbers.astype(np.int64)


def _check_range(
    numbers: NDArray[np.integer], n_vertices: int, what: str, offset: NDArray[np.int32] | None = None
) -> None:
    """Raise ValueError if a number, shape (n,), is not that of a vertex."""
    if not numbers.size or (numbers.min() >= 0 and numbers.max() < n_vertices):
        return
    place = int(np.flatnonzero((numbers < 0) | (numbers >= n_vertices))[0])
    if offset is not None:
        what = f"Face {int(np.searchsorted(offset, place, side='right')) - 1}"
    raise ValueError(f"{what} names vertex {numbers[place]}, but there are {n_vertices} vertices.")


def _check_corners(mesh: SurfaceMesh) -> None:
    """Raise ValueError unless the arrays of a mesh have the right types, shapes and ranges."""
    for name, dimensions in (("corner_vertex", 1), ("corner_edge", 1), ("face_offset", 1), ("edges", 2)):
        array = getattr(mesh, name)
        if not isinstance(array, np.ndarray) or array.dtype != np.int32 or array.ndim != dimensions:
            kind = f"{array.dtype} of shape {array.shape}" if isinstance(array, np.ndarray) else type(array)
            raise ValueError(
                f"{name} is {kind}; expected int32 with {dimensions} dimension{'s' * (dimensions > 1)}."
            )
    offset, n_corners = mesh.face_offset, mesh.n_corners
    if mesh.edges.shape[1] != 2:
        raise ValueError(f"edges has shape {mesh.edges.shape}; expected (E, 2).")
    if len(mesh.corner_edge) != n_corners:
        raise ValueError(f"There are {n_corners} corner vertices, but {len(mesh.corner_edge)} corner edges.")
    if not len(offset) or offset[0] != 0 or offset[-1] != n_corners or (np.diff(offset) < 0).any():
        raise ValueError(f"face_offset must ascend from 0 to the number of corners, {n_corners}.")
    _check_range(mesh.corner_vertex, mesh.n_vertices, "A face", offset)
    _check_range(mesh.edges.reshape(-1), mesh.n_vertices, "An edge")
    if n_corners and not (mesh.corner_edge.min() >= 0 and mesh.corner_edge.max() < mesh.n_edges):
        wrong = mesh.corner_edge[(mesh.corner_edge < 0) | (mesh.corner_edge >= mesh.n_edges)][0]
        raise ValueError(f"A corner names edge {wrong}, but there are {mesh.n_edges} edges.")


def _check_faces(mesh: SurfaceMesh) -> None:
    """Raise ValueError unless each face has three or more different vertices, and its own edges."""
    _check_sizes(mesh)
    following = mesh.corner_vertex[mesh.next_corner()]
    _check_repeats(mesh, following)
    ends = mesh.edges[mesh.corner_edge]
    is_own = (ends[:, 0] == mesh.corner_vertex) & (ends[:, 1] == following)
    is_own |= (ends[:, 1] == mesh.corner_vertex) & (ends[:, 0] == following)
    if not is_own.all():
        corner = int(np.flatnonzero(~is_own)[0])
        raise ValueError(
            f"Corner {corner} runs from vertex {mesh.corner_vertex[corner]} to {following[corner]}, but its "
            f"edge {mesh.corner_edge[corner]} joins {ends[corner, 0]} and {ends[corner, 1]}."
        )


def _check_sizes(mesh: SurfaceMesh) -> None:
    """Raise ValueError unless each face has three or more corners."""
    if mesh.common_face_size() >= 3 or not mesh.n_faces:
        return
    sizes = mesh.face_sizes()
    if sizes.min() < 3:
        face = int(np.flatnonzero(sizes < 3)[0])
        raise ValueError(f"Face {face} has {sizes[face]} corners; a face needs three or more.")


def _check_repeats(mesh: SurfaceMesh, following: NDArray[np.int32]) -> None:
    """Raise ValueError if a face has a vertex twice; `following`, shape (C,), are the next vertices."""
    corner = mesh.corner_vertex
    twice = np.flatnonzero(corner == following) if mesh.n_corners else np.zeros(0, np.intp)
    common = mesh.common_face_size()
    faces = np.searchsorted(mesh.face_offset, twice, side="right") - 1
    if not len(twice) and common != 3:
        sizes = mesh.face_sizes()
        for size in [common] if common else np.unique(sizes).tolist():
            group = np.flatnonzero(sizes == size)
            rows = np.sort(corner[mesh.face_offset[group, None] + np.arange(size)], axis=1)
            has_twice = (rows[:, 1:] == rows[:, :-1]).any(axis=1)
            if has_twice.any():
                faces = group[has_twice]
                break
    if len(faces):
        own = corner[mesh.face_offset[faces[0]] : mesh.face_offset[faces[0] + 1]]
        values, counts = np.unique(own, return_counts=True)
        raise ValueError(
            f"Face {faces[0]} names vertex {values[counts > 1][0]} twice; a face needs three or more "
            "different vertices."
        )


def _is_frozen(array: NDArray) -> bool:
    """Tell whether neither an array nor what it is a view of can be written to."""
    owner: Any = array
    while isinstance(owner, np.ndarray):
        if owner.flags.writeable:
            return False
        owner = owner.base
    return owner is None


def _frozen(array: NDArray) -> NDArray:
    """Return an array that cannot be written to: itself, or a copy."""
    if not _is_frozen(array):
        array = array.copy()
        array.flags.writeable = False
    return array
