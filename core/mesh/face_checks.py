# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a `SurfaceMesh` is made of, from lists or arrays, and the sentences for what is no mesh."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import chain
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import MeshError
from ..precision import as_array
from ..value_checks import shown

if TYPE_CHECKING:
    from .surface_mesh import SurfaceMesh


def positions_of(vertices: ArrayLike) -> NDArray[np.floating]:
    """Return positions as an array of float32 or float64, shape (N, 3)."""
    check_known(vertices, "positions")
    try:
        positions = np.asarray(vertices)
    except ValueError as error:  # of rows that differ in length
        raise MeshError("The positions are no array; expected shape (N, 3).") from error
    if positions.dtype.kind not in "iuf":
        raise MeshError(f"The positions are {positions.dtype}; expected real numbers.")
    if positions.dtype not in (np.float32, np.float64):
        positions = positions.astype(np.float64)
    check_shape(positions)
    return positions


def check_known(values: Any, name: str) -> None:
    """Raise MeshError if these are a masked array with masked values, which nobody knows."""
    if np.ma.is_masked(values):
        n_masked = np.count_nonzero(np.ma.getmaskarray(values))
        raise MeshError(f"The {name} have {n_masked} masked values; fill them first.")


def check_shape(positions: NDArray[np.floating]) -> None:
    """Raise MeshError unless these are positions, shape (N, 3), float32 or float64."""
    if positions.ndim != 2 or positions.shape[1] != 3:
        raise MeshError(f"The positions have shape {positions.shape}; expected (N, 3).")
    if positions.dtype not in (np.float32, np.float64):
        raise MeshError(f"The positions are {positions.dtype}; expected float32 or float64.")
    if len(positions) >= 2**31:
        raise MeshError(f"There are {len(positions):,} vertices; at most {2**31 - 1:,} can be numbered.")


def corner_list(
    faces: ArrayLike | Sequence[Sequence[int]],
) -> tuple[NDArray[np.integer], NDArray[np.int32]]:
    """Return the vertices of all corners, shape (C,), and the first corner of each face, shape (F + 1,)."""
    check_known(faces, "faces")
    if isinstance(faces, np.ndarray) and faces.ndim == 2:
        flat = whole_numbers(faces, "faces").reshape(-1)
        return flat, np.arange(len(faces) + 1, dtype=np.int32) * np.int32(faces.shape[1])
    if not isinstance(faces, Iterable):
        raise MeshError(
            f"The faces are {shown(faces)}; expected an array of shape (F, k) or a list of lists."
        )
    rows: list[Any] = list(faces)
    is_listed = all(hasattr(row, "__len__") for row in rows)
    if not is_listed or any(as_array("The faces", row, MeshError).ndim != 1 for row in rows[:1]):
        raise MeshError("The faces are no lists of vertices; expected shape (F, k) or a list of lists.")
    sizes = np.fromiter(map(len, rows), np.int64, len(rows))
    offset = np.concatenate(([0], np.cumsum(sizes)))
    items = list(chain.from_iterable(rows))
    if not items:
        return np.zeros(0, np.int32), offset.astype(np.int32)
    if not {bool, np.bool_}.isdisjoint(map(type, items)):
        raise MeshError("The faces contain True or False; vertices are given by whole numbers.")
    return whole_numbers(items, "faces"), offset.astype(np.int32)


def flat_corners(corners: ArrayLike, offsets: ArrayLike) -> tuple[NDArray[np.integer], NDArray[np.int32]]:
    """Return the vertices of all corners, shape (C,), and the checked first corner of each face (F + 1,)."""
    flat = whole_numbers(corners, "corners")
    offset = whole_numbers(offsets, "offsets")
    if flat.ndim != 1:
        raise MeshError(f"The corners have shape {flat.shape}; beside offsets they must be a flat list.")
    if offset.ndim != 1 or not len(offset) or offset[0] != 0 or offset[-1] != len(flat):
        raise MeshError(f"The offsets must begin with 0 and end with the number of corners, {len(flat)}.")
    if (np.diff(offset) < 0).any():
        raise MeshError("The offsets must ascend; each is the first corner of a face.")
    return flat, offset.astype(np.int32)


def whole_numbers(values: ArrayLike, name: str) -> NDArray[np.integer]:
    """Return an array of whole numbers, or raise MeshError if it holds anything else."""
    numbers = as_array(f"The {name}", values, MeshError)
    if numbers.size and numbers.dtype.kind not in "iu":
        raise MeshError(f"The {name} are {numbers.dtype}; vertices are given by whole numbers.")
    return numbers if numbers.size else numbers.astype(np.int64)


def check_range(
    numbers: NDArray[np.integer], n_vertices: int, what: str, offset: NDArray[np.int32] | None = None
) -> None:
    """Raise MeshError if a number, shape (n,), is not that of a vertex."""
    if not numbers.size or (numbers.min() >= 0 and numbers.max() < n_vertices):
        return
    place = int(np.flatnonzero((numbers < 0) | (numbers >= n_vertices))[0])
    if offset is not None:
        what = f"Face {int(np.searchsorted(offset, place, side='right')) - 1}"
    raise MeshError(f"{what} names vertex {numbers[place]}, but there are {n_vertices} vertices.")


def check_corners(mesh: SurfaceMesh) -> None:
    """Raise MeshError unless the arrays of a mesh have the right types, shapes and ranges."""
    for name, dimensions in (("corner_vertex", 1), ("corner_edge", 1), ("face_offset", 1), ("edges", 2)):
        array = getattr(mesh, name)
        if not isinstance(array, np.ndarray) or array.dtype != np.int32 or array.ndim != dimensions:
            kind = f"{array.dtype} of shape {array.shape}" if isinstance(array, np.ndarray) else type(array)
            raise MeshError(
                f"{name} is {kind}; expected int32 with {dimensions} dimension{'s' * (dimensions > 1)}."
            )
    offset, n_corners = mesh.face_offset, mesh.n_corners
    if mesh.edges.shape[1] != 2:
        raise MeshError(f"edges has shape {mesh.edges.shape}; expected (E, 2).")
    if len(mesh.corner_edge) != n_corners:
        raise MeshError(f"There are {n_corners} corner vertices, but {len(mesh.corner_edge)} corner edges.")
    if not len(offset) or offset[0] != 0 or offset[-1] != n_corners or (np.diff(offset) < 0).any():
        raise MeshError(f"face_offset must ascend from 0 to the number of corners, {n_corners}.")
    check_range(mesh.corner_vertex, mesh.n_vertices, "A face", offset)
    check_range(mesh.edges.reshape(-1), mesh.n_vertices, "An edge")
    if n_corners and not (mesh.corner_edge.min() >= 0 and mesh.corner_edge.max() < mesh.n_edges):
        wrong = mesh.corner_edge[(mesh.corner_edge < 0) | (mesh.corner_edge >= mesh.n_edges)][0]
        raise MeshError(f"A corner names edge {wrong}, but there are {mesh.n_edges} edges.")


def check_faces(mesh: SurfaceMesh) -> None:
    """Raise MeshError unless each face has three or more different vertices, and its own edges."""
    check_sizes(mesh)
    following = mesh.corner_vertex[mesh.next_corner()]
    check_repeats(mesh, following)
    ends = mesh.edges[mesh.corner_edge]
    is_own = (ends[:, 0] == mesh.corner_vertex) & (ends[:, 1] == following)
    is_own |= (ends[:, 1] == mesh.corner_vertex) & (ends[:, 0] == following)
    if not is_own.all():
        corner = int(np.flatnonzero(~is_own)[0])
        raise MeshError(
            f"Corner {corner} runs from vertex {mesh.corner_vertex[corner]} to {following[corner]}, but its "
            f"edge {mesh.corner_edge[corner]} joins {ends[corner, 0]} and {ends[corner, 1]}."
        )


def check_sizes(mesh: SurfaceMesh) -> None:
    """Raise MeshError unless each face has three or more corners."""
    if mesh.common_face_size() >= 3 or not mesh.n_faces:
        return
    sizes = mesh.face_sizes()
    if sizes.min() < 3:
        face = int(np.flatnonzero(sizes < 3)[0])
        raise MeshError(f"Face {face} has {sizes[face]} corners; a face needs three or more.")


def check_repeats(mesh: SurfaceMesh, following: NDArray[np.int32]) -> None:
    """Raise MeshError if a face has a vertex twice; `following`, shape (C,), are the next vertices."""
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
        raise MeshError(
            f"Face {faces[0]} names vertex {values[counts > 1][0]} twice; a face needs three or more "
            "different vertices."
        )
