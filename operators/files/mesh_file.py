# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What all mesh files are to the rest of the program: positions, faces, and a copy with other positions."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...core.errors import FrameletError

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray


ROUNDED = "Positions are stored as whole numbers, so that the result is rounded to them."


class FileError(FrameletError):
    """Why a file cannot be read or written, in one sentence for people.

    Examples
    --------
    >>> from framelet.operators.files.ply import PlyFile
    >>> try:
    ...     PlyFile(b"ply\\n", "scan")
    ... except FileError as error:
    ...     print(error)
    The header of the PLY file has no end; the file is damaged or of another type.
    """


@dataclass(frozen=True, eq=False)
class Part:
    """A surface of a file that is denoised by itself.

    Attributes
    ----------
    name : str
        Its name in the file, or the name of the file.
    faces : ndarray, shape (f,), int64
        Its faces, as numbers of faces of the file.
    vertices : ndarray, shape (n,), int64
        Its vertices, as numbers of vertices of the file, ascending.
    """

    name: str
    faces: NDArray[np.int64]
    vertices: NDArray[np.int64]


class MeshFile(ABC):
    """A mesh file that was read, whatever its format.

    Attributes
    ----------
    name : str
        What the surface is called where the file does not say: the stem of the file's name.
    positions : ndarray, shape (N, 3), float64
        Where the vertices are.
    face_offset : ndarray, shape (F + 1,), int64
        First corner of each face, and the number of corners at the end.
    corner_vertex : ndarray, shape (C,), int64
        Vertex of each corner. Faces are those of the file, degenerate and double ones included.
    loose_edges : ndarray, shape (L, 2), int64
        Edges that the file names by themselves.
    precision : dtype
        Precision in which the file holds coordinates, float32 or float64.
    always_welded : bool
        Whether vertices at the same place are one by the nature of the format.
    warnings : list of str
        Sentences about what was found on reading.
    extras : list of str
        What the file holds besides positions and faces, by the words of the format.

    Notes
    -----
    How many places of the file hold one vertex is the format's own affair: `patched` writes to all of them.
    """

    name: str
    positions: NDArray[np.float64]
    face_offset: NDArray[np.int64]
    corner_vertex: NDArray[np.int64]
    loose_edges: NDArray[np.int64]
    precision: np.dtype
    always_welded: bool = False
    has_normals: bool = False
    """Whether the file holds normals that `patched` leaves alone."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.loose_edges = np.zeros((0, 2), np.int64)
        self.precision = np.dtype(np.float32)
        self.warnings: list[str] = []
        self.extras: list[str] = []

    @property
    def n_faces(self) -> int:
        """Number of faces."""
        return len(self.face_offset) - 1

    def parts(self) -> list[Part]:
        """Return the surfaces that are denoised by themselves; by default all is one."""
        return [Part(self.name, np.arange(self.n_faces), np.arange(len(self.positions)))]

    def weights(self, group: str) -> NDArray[np.float64] | None:
        """Return the weight of each vertex in a group, shape (N,); None if the file has no such group."""
        return None

    def movable(self) -> NDArray[np.bool_] | None:
        """Return which vertices the file can hold elsewhere, shape (N,); None for all."""
        return None

    def scene(
        self, positions: NDArray[np.floating]
    ) -> tuple[NDArray[np.floating], NDArray[np.int64], NDArray[np.int64]]:
        """Return positions, face offsets and corners of all that the file shows, for other formats.

        Parameters
        ----------
        positions : ndarray, shape (N, 3)
            Where the vertices are.
        """
        return positions, self.face_offset, self.corner_vertex

    @abstractmethod
    def patched(self, positions: NDArray[np.floating]) -> bytes:
        """Return the bytes of the file with other coordinates.

        Parameters
        ----------
        positions : ndarray, shape (N, 3)
            New positions. Those of vertices that did not move have the same bits as before, and the bytes
            of these vertices stay.

        Returns
        -------
        bytes
        """

    def side_files(self, positions: NDArray[np.floating]) -> dict[str, bytes]:
        """Return other files that hold coordinates, by the names by which this file refers to them."""
        return {}

    def buffer_files(self) -> list[str]:
        """Return the relative paths of other files that hold coordinates."""
        return []

    def references(self) -> list[str]:
        """Return the relative paths of the files that this file refers to and that stay as they are."""
        return []

    def has_stale_normals(self, positions: NDArray[np.floating]) -> bool:
        """Return whether the file keeps normals of a surface that is elsewhere now."""
        return self.has_normals and bool(self.moved(positions).any())

    def moved(self, positions: NDArray[np.floating]) -> NDArray[np.bool_]:
        """Return which vertices are elsewhere than before, shape (N,), as far as the file can tell."""
        with np.errstate(invalid="ignore", over="ignore"):  # of what is no number
            after, before = (
                np.asarray(positions).astype(self.precision),
                self.positions.astype(self.precision),
            )
        is_number = (after == after) | (before == before)
        return ((after != before) & is_number).any(axis=1)


def check_indices(
    corner_vertex: NDArray[np.integer], face_offset: NDArray[np.integer], n_vertices: int
) -> None:
    """Raise FileError, in one sentence, if a face names a vertex that does not exist."""
    if not len(corner_vertex) or (corner_vertex.min() >= 0 and corner_vertex.max() < n_vertices):
        return
    corner = int(np.flatnonzero((corner_vertex < 0) | (corner_vertex >= n_vertices))[0])
    face = int(np.searchsorted(face_offset, corner, side="right")) - 1
    raise FileError(
        f"Face {face} names vertex {corner_vertex[corner]}, but there are {n_vertices} vertices; the file is "
        "damaged."
    )


def check_range(positions: NDArray[np.floating], precision: np.dtype) -> None:
    """Raise FileError, in one sentence, if numbers of a precision cannot hold positions.

    Examples
    --------
    >>> try:
    ...     check_range(np.array([[0.0, 0.0, 1e60]]), np.dtype(np.float32))
    ... except FileError as error:
    ...     print(str(error).partition(", ")[0])
    The coordinates go to 1e+60
    """
    size, limits = float(np.abs(positions).max(initial=0.0)), np.finfo(precision)
    if size <= float(limits.max) and not 0.0 < size < float(limits.tiny):
        return
    raise FileError(
        f"The coordinates go to {size:.3g}, which the {limits.dtype} numbers of the new file cannot hold; "
        f"scale the surface {'up' if size < 1.0 else 'down'} first."
    )


def members(owner: NDArray[np.integer], n_owners: int) -> list[NDArray[np.int64]]:
    """Return the elements of each owner, ascending, whatever their number; negative owners own nothing.

    Examples
    --------
    >>> [each.tolist() for each in members(np.array([1, 0, -1, 1]), 3)]
    [[1], [0, 3], []]
    """
    order = np.argsort(owner, kind="stable")
    return np.split(order, np.searchsorted(owner[order], np.arange(n_owners + 1)))[1:-1]


def doubles(numbers: NDArray[np.number]) -> NDArray[np.float64]:
    """Return stored numbers in double precision; NaN of any bits stays NaN, without a warning.

    Examples
    --------
    >>> doubles(np.array([0x3F800000, 0x7FA00000], "<u4").view("<f4")).tolist()
    [1.0, nan]
    """
    with np.errstate(invalid="ignore"):  # a signaling NaN, which damaged bytes may be
        return numbers.astype(np.float64)


def stem_of(path: Path) -> str:
    """Return what a surface is called that has no name in its file."""
    return path.stem or path.name
