# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""STL files, binary and ascii: equal corners are one vertex, and facet normals follow the corners."""

from __future__ import annotations

import codecs
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.mesh.ragged import starts
from . import digits, text
from .mesh_file import FileError, MeshFile, doubles
from .places import merge_equal

TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
HEAD = 84  # bytes before the triangles of a binary file
_NAMES = (b"vertex", b"facet")
_BLOCK = 2**14  # triangles that are looked at together: the processor has room for them


class StlFile(MeshFile):
    """An STL file in memory.

    Examples
    --------
    >>> import numpy as np
    >>> data = new_file(np.float32([[0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([0, 3]), np.array([0, 1, 2]))
    >>> file = StlFile(data, "triangle")
    >>> file.positions.shape, len(data)
    ((3, 3), 134)
    """

    always_welded = True

    def __init__(self, data: bytes, name: str) -> None:
        super().__init__(name)
        self._data = data
        n = int(np.frombuffer(data, "<u4", 1, HEAD - 4)[0]) if len(data) >= HEAD else 0
        size, room = HEAD + TRIANGLE.itemsize * n, (len(data) - HEAD) // TRIANGLE.itemsize
        looks_like_text = data.removeprefix(codecs.BOM_UTF8).lstrip()[:5].lower() == b"solid"
        self._is_text = looks_like_text and len(data) != size and b"\0" not in data[: HEAD + 512]
        said = f"The header speaks of {n:,} triangles, but the file has room for {room:,}"
        if not self._is_text and (len(data) < HEAD or len(data) < size):
            if len(data) < HEAD or n == 0:
                raise FileError("The file is no STL file: it begins neither with ‘solid’ nor with a header.")
            raise FileError(f"{said}; it was cut off or is damaged.")
        if not self._is_text and room > n:
            if not n:  # as programs leave it that were stopped before they knew the number
                raise FileError(f"{said}; it was not written to its end or is damaged.")
            self.warnings.append(f"{said}; what lies behind them is left alone.")
        corners = self._read_text() if self._is_text else self._read_binary(n)
        self._vertex, first = merge_equal(corners)
        self.positions = doubles(corners[first])
        self.corner_vertex = self._vertex
        self.face_offset = np.arange(0, len(corners) + 1, 3)

    def _read_binary(self, n: int) -> NDArray[np.float32]:
        """Return the corners of all triangles, shape (3 n, 3)."""
        self._triangles = np.frombuffer(self._data, TRIANGLE, n, HEAD)
        if self._triangles["attribute"].any():
            self.extras.append("attributes of triangles")
        return np.ascontiguousarray(self._triangles["corners"].reshape(-1, 3), np.float32)

    def _read_text(self) -> NDArray[np.float64]:
        """Return the corners of all triangles, shape (3 n, 3)."""
        self.precision = np.dtype(np.float64)
        corners: list[NDArray[np.float64]] = []
        normals: list[NDArray[np.float64]] = []
        n_loops = 0
        for block in text.blocks(self._data):
            for keyword, rows in zip(_NAMES, (corners, normals), strict=True):
                rows.append(_rows(block, keyword))
            n_loops += int(block.with_keyword(b"outer", any_case=True).sum())
        found, self._normals = np.concatenate(corners), np.concatenate(normals)
        if len(found) % 3 or n_loops * 3 != len(found) or len(self._normals) * 3 != len(found):
            raise FileError(
                f"The text has {len(found)} vertices and {len(self._normals)} facets, which are no "
                "triangles; each facet needs three lines ‘vertex x y z’."
            )
        if not len(found):
            raise FileError("No triangle could be read from the text; each needs three lines ‘vertex x y z’.")
        return found

    def patched(self, positions: NDArray[np.floating]) -> bytes:
        """See `MeshFile.patched`; the normals of triangles that moved are computed anew."""
        moved = self.moved(positions)
        if not moved.any():
            return self._data
        if not self._is_text:
            return self._patched_binary(np.asarray(positions, np.float64), moved)
        after = np.asarray(positions, np.float64)[self._vertex]
        is_moved = moved[self._vertex]
        has_moved: NDArray[np.bool_] = np.asarray(is_moved.reshape(-1, 3).any(axis=1))
        of_normal = has_moved & self._has_normal(self._normals)
        new_normals = _normals(after.reshape(-1, 3, 3))
        return self._patched_text(after, is_moved, new_normals, of_normal)

    @staticmethod
    def _has_normal(normals: NDArray[np.floating]) -> NDArray[np.bool_]:
        """Return which triangles have a normal; zeros say that a reader is to compute it."""
        return np.asarray((normals != 0.0).any(axis=1))

    def _patched_binary(self, after: NDArray[np.float64], moved: NDArray[np.bool_]) -> bytes:
        data = bytearray(self._data)
        triangles = np.ndarray(self.n_faces, TRIANGLE, data, HEAD)
        vertex = self._vertex.reshape(-1, 3)
        for begin in range(0, len(triangles), _BLOCK):
            rows, corner = triangles[begin : begin + _BLOCK], vertex[begin : begin + _BLOCK]
            is_moved = moved[corner]
            has_moved = is_moved.any(axis=1)
            corners = after[corner]
            np.copyto(rows["corners"], corners, where=is_moved[:, :, None], casting="same_kind")
            has_moved &= self._has_normal(rows["normal"])
            np.copyto(rows["normal"], _normals(corners), where=has_moved[:, None], casting="same_kind")
        return bytes(data)

    def _patched_text(
        self,
        after: NDArray[np.float64],
        is_moved: NDArray[np.bool_],
        normals: NDArray[np.float64],
        of_normal: NDArray[np.bool_],
    ) -> bytes:
        size = digits.size_of(self.positions)
        pieces, counts = [], [0, 0]
        for block in text.blocks(self._data):
            starts = np.flatnonzero(text.word_starts(block.letters))
            stops = text.word_stops(block.letters)
            words, values = [], []
            for kind, (keyword, rows, chosen, skipped) in enumerate(
                ((_NAMES[0], after, is_moved, 1), (_NAMES[1], normals, of_normal, 2))
            ):
                lines = np.flatnonzero(block.with_keyword(keyword, any_case=True))
                numbers = np.arange(counts[kind], counts[kind] + len(lines))
                counts[kind] += len(lines)
                lines, numbers = lines[chosen[numbers]], numbers[chosen[numbers]]
                word = np.searchsorted(starts, block.first[lines])
                words.append(word[:, None] + np.arange(skipped, skipped + 3))
                values.append(rows[numbers])
            if not sum(map(len, words)):
                pieces.append(block.letters.tobytes())
                continue
            flat, rows = np.concatenate(words), np.concatenate(values)
            order = np.argsort(flat[:, 0])
            at = flat[order].reshape(-1)
            vertex_words = words[0].reshape(-1)
            style = digits.style_of_words(block.letters, starts[vertex_words], stops[vertex_words], size)
            new, lengths = digits.as_text(rows[order].reshape(-1), style)
            pieces.append(text.replaced(block.letters, starts[at], stops[at], new, lengths).tobytes())
        return b"".join(pieces)


def _rows(block: text.Block, keyword: bytes) -> NDArray[np.float64]:
    """Return the three numbers of each line with a keyword, shape (n, 3)."""
    lines = block.with_keyword(keyword, any_case=True)
    if not lines.any():
        return np.zeros((0, 3))
    letters, start, _length = block.of_lines(lines, len(keyword))
    counts = text.count_words(letters, start)
    if keyword == _NAMES[1]:
        # ‘normal’ stands before the numbers.
        at = np.flatnonzero(text.word_starts(letters))
        word = at[starts(counts)]
        for place in range(len(b"normal")):
            letters[np.minimum(word + place, len(letters) - 1)] = 32
        counts = counts - 1
    if (counts != 3).any():
        line = int(np.flatnonzero(counts != 3)[0])
        words = letters[start[line] :].tobytes().split(b"\n", 1)[0].strip()
        raise FileError(f"A line ‘{keyword.decode()}’ has not three numbers but {text.shown(words)}.")
    return text.numbers(letters, np.float64, 3 * len(counts)).reshape(-1, 3)


def _normals(triangles: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the unit normals of triangles, shape (n, 3); zeros where they have no area."""
    first = triangles[:, 1] - triangles[:, 0]
    normals = np.cross(first, triangles[:, 2] - triangles[:, 0])
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.divide(normals, length, out=np.zeros_like(normals), where=length > 0.0)


def new_file(
    positions: NDArray[np.floating], face_offset: NDArray[Any], corner_vertex: NDArray[Any]
) -> bytes:
    """Return a binary STL file of a surface, in single precision; see `ply.new_file` for the parameters.

    Faces with more than three corners become fans of triangles.
    """
    from .convert import triangles_of

    corners = np.asarray(positions, np.float64)[triangles_of(face_offset, corner_vertex)]
    rows = np.zeros(len(corners), TRIANGLE)
    rows["corners"] = corners
    rows["normal"] = _normals(corners)
    return b"Framelet".ljust(HEAD - 4) + np.array(len(rows), "<u4").tobytes() + rows.tobytes()
