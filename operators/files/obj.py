# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""OBJ files: all statements stay, and only the numbers of the lines `v` change."""

from __future__ import annotations

import codecs
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.mesh.ragged import starts
from . import digits, text
from .mesh_file import FileError, MeshFile, Part, members

_SLASH = ord("/")


class ObjFile(MeshFile):
    """An OBJ file in memory.

    Examples
    --------
    >>> file = ObjFile(b"v 0 0 0\\nv 1 0 0 # here\\nv 0 1 0\\nf -3 -2/4 -1\\n", "triangle")
    >>> file.corner_vertex.tolist()
    [0, 1, 2]
    >>> file.patched(file.positions + [[0, 0, 0], [0.25, 0, 0], [0, 0, 0]]).splitlines()[1]
    b'v 1.25000000 0.00000000 0.00000000 # here'
    """

    def __init__(self, data: bytes, name: str) -> None:
        super().__init__(name)
        self._data = data
        # A line may go on behind a backslash; spaces in its place keep all bytes where they are.
        self._text = data
        if b"\\" in data:
            self._text = data.replace(b"\\\r\n", b"   ").replace(b"\\\n", b"  ")
        if data.startswith(codecs.BOM_UTF8):
            self._text = b"   " + self._text[3:]
        self.precision = np.dtype(np.float64)
        self._objects: list[tuple[str, int, int]] = []  # name, first face, first line
        self._groups: list[tuple[frozenset[str], int]] = []  # names, first face
        self._read()
        self._find_extras()

    def _read(self) -> None:
        rows: list[NDArray[np.float64]] = []
        faces, lines = _Rows(), _Rows()
        n_vertices = 0
        for block in text.blocks(self._text):
            is_vertex = block.with_keyword(b"v")
            before: NDArray[np.int64] = np.asarray(np.cumsum(is_vertex) - is_vertex + n_vertices)
            rows.append(_coordinates(block, is_vertex))
            n_vertices += int(is_vertex.sum())
            is_face, is_line = block.with_keyword(b"f"), block.with_keyword(b"l")
            self._note_names(block, is_face, is_line, faces.n, lines.n)
            faces.read(block, is_face, before)
            lines.read(block, is_line, before)
        self.positions = np.concatenate(rows) if rows else np.zeros((0, 3))
        self.corner_vertex, self.face_offset, self._face_number = faces.within(n_vertices)
        n_wrong = faces.n - len(self._face_number)
        if n_wrong:
            self.warnings.append(
                "1 face names a vertex that does not exist; it stays in the file, unused."
                if n_wrong == 1
                else f"{n_wrong:,} faces name vertices that do not exist; they stay in the file, unused."
            )
        self._n_faces, self._n_lines = faces.n, lines.n
        corner, offset, self._line_number = lines.within(n_vertices)
        is_last = np.zeros(len(corner) + 1, bool)
        is_last[offset[1:] - 1] = True
        begin = np.flatnonzero(~is_last[:-1])
        self.loose_edges = np.stack((corner[begin], corner[begin + 1]), axis=1)
        row = np.repeat(np.arange(len(offset) - 1), np.diff(offset))
        self._edge_line = self._line_number[row[begin]]

    def _note_names(
        self,
        block: text.Block,
        is_face: NDArray[np.bool_],
        is_line: NDArray[np.bool_],
        n_faces: int,
        n_lines: int,
    ) -> None:
        """Note the names of objects and groups, and at which face they begin."""
        for keyword in (b"o", b"g"):
            named = np.flatnonzero(block.with_keyword(keyword))
            if not len(named):
                continue
            faces, lines, stop = np.cumsum(is_face) + n_faces, np.cumsum(is_line) + n_lines, block.stop
            for line in named.tolist():
                words = block.letters[block.first[line] + 1 : stop[line]].tobytes()
                words_text = words.decode("utf-8", "replace").strip()
                if keyword == b"o":
                    self._objects.append((words_text, int(faces[line]), int(lines[line])))
                else:
                    self._groups.append((frozenset(words_text.split()), int(faces[line])))

    def _find_extras(self) -> None:
        for keyword, words in _EXTRAS.items():
            if self._data.startswith(keyword + b" ") or b"\n" + keyword + b" " in self._data:
                self.extras.append(words)
        self.has_normals = "normals" in self.extras
        if self._groups:
            self.extras.append("groups")
        if self._objects:
            self.extras.append("objects")

    def parts(self) -> list[Part]:
        """Return the objects of the file, unless two of them share a vertex: then all is one surface."""
        whole = super().parts()
        if len(self._objects) < 2:
            name = self._objects[0][0] if self._objects else ""
            return [Part(name or self.name, whole[0].faces, whole[0].vertices)]
        first_face = np.array([face for _name, face, _line in self._objects])
        first_line = np.array([line for _name, _face, line in self._objects])
        of_face = np.searchsorted(first_face, self._face_number, side="right") - 1
        of_edge = np.searchsorted(first_line, self._edge_line, side="right") - 1
        vertex = np.concatenate((self.corner_vertex, self.loose_edges.reshape(-1)))
        owner = np.concatenate((np.repeat(of_face, np.diff(self.face_offset)), np.repeat(of_edge, 2)))
        least = np.full(len(self.positions), len(self._objects))
        most = np.full(len(self.positions), -2)
        np.minimum.at(least, vertex, owner)
        np.maximum.at(most, vertex, owner)
        if not len(vertex) or (least < most).any():
            return whole
        names = ["", *(name for name, _face, _line in self._objects)]  # the first faces may have no object
        faces, vertices = members(of_face + 1, len(names)), members(most + 1, len(names))
        return [
            Part(name or self.name, own_faces, own_vertices)
            for name, own_faces, own_vertices in zip(names, faces, vertices, strict=True)
            if len(own_vertices)
        ]

    def weights(self, group: str) -> NDArray[np.float64] | None:
        """Return 1 for the vertices of the faces of a group; see `MeshFile.weights`."""
        if not any(group in names for names, _face in self._groups):
            return None
        first = np.array([face for _names, face in self._groups])
        is_in = np.array([group in names for names, _face in self._groups])
        which = np.searchsorted(first, self._face_number, side="right") - 1
        faces = (which >= 0) & is_in[which]
        weights = np.zeros(len(self.positions))
        weights[self.corner_vertex[np.repeat(faces, np.diff(self.face_offset))]] = 1.0
        return weights

    def references(self) -> list[str]:
        """Return the material files that the file names."""
        found = []
        for line in self._data.splitlines() if b"mtllib" in self._data else []:
            words = line.strip()
            if words.startswith((b"mtllib ", b"mtllib\t")):
                found.append(words[7:].strip().decode("utf-8", "surrogateescape"))
        return found

    def patched(self, positions: NDArray[np.floating]) -> bytes:
        """See `MeshFile.patched`."""
        moved = self.moved(positions)
        if not moved.any():
            return self._data
        size = digits.size_of(self.positions)
        pieces, n_before = [], 0
        for block in text.blocks(self._text):
            end = block.begin + len(block.letters)
            lines = np.flatnonzero(block.with_keyword(b"v"))
            numbers = np.arange(n_before, n_before + len(lines))
            n_before += len(lines)
            is_moved = moved[numbers]
            if not is_moved.any():
                pieces.append(self._data[block.begin : end])
                continue
            starts = np.flatnonzero(text.word_starts(block.letters))
            word = np.searchsorted(starts, block.first[lines[is_moved]])
            words = (word[:, None] + np.arange(1, 4)).reshape(-1)
            start, stop = starts[words], text.word_stops(block.letters)[words]
            style = digits.style_of_words(block.letters, start, stop, size)
            rows = np.asarray(positions[numbers[is_moved]], np.float64)
            new, lengths = digits.as_text(rows.reshape(-1), style)
            letters = np.frombuffer(self._data, np.uint8, len(block.letters), block.begin)
            pieces.append(text.replaced(letters, start, stop, new, lengths).tobytes())
        return b"".join(pieces)


_EXTRAS = {b"vt": "UVs", b"vn": "normals", b"usemtl": "materials", b"s": "smoothing groups"}


class _Rows:
    """Lines of vertex numbers: faces, or lines of edges."""

    def __init__(self) -> None:
        self._vertices: list[NDArray[np.int64]] = []
        self._counts: list[NDArray[np.int64]] = []
        self.n = 0

    def read(self, block: text.Block, lines: NDArray[np.bool_], before: NDArray[np.int64]) -> None:
        """Read the lines of a block; `before` counts the vertices above each of its lines."""
        if not lines.any():
            return
        letters, start, _length = block.of_lines(lines, 1)
        counts = text.count_words(letters, start)
        is_slash = letters == _SLASH
        if is_slash.any():
            # Only what is before the first slash of a word is a vertex.
            marks = np.flatnonzero(is_slash | (letters <= 32))
            tail = np.repeat(is_slash[marks], np.diff(np.append(marks, len(letters))))
            letters[marks[0] :][tail] = 32
        if (letters == ord("#")).any():
            counts = _without_comments(letters, start)
        numbers = text.numbers(letters, np.int64, int(counts.sum()))
        if (numbers <= 0).any():
            above = np.repeat(before[lines], counts)
            if (numbers == 0).any():
                numbers = np.where(numbers == 0, -(2**40), numbers)  # there is no vertex 0
            numbers = np.where(numbers < 0, numbers + above + 1, numbers)
        self._vertices.append(numbers - 1)
        self._counts.append(counts)
        self.n += len(counts)

    def within(self, n_vertices: int) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
        """Return corners and offsets of the rows whose vertices all exist, and the numbers of these rows."""
        if not self._counts:
            return np.zeros(0, np.int64), np.zeros(1, np.int64), np.zeros(0, np.int64)
        vertices, counts = np.concatenate(self._vertices), np.concatenate(self._counts)
        is_wrong = (vertices < 0) | (vertices >= n_vertices)
        rows = np.arange(len(counts))
        if is_wrong.any():
            keeps = np.bincount(np.repeat(rows, counts)[is_wrong], minlength=len(counts)) == 0
            vertices = vertices[np.repeat(keeps, counts)]
            counts, rows = counts[keeps], rows[keeps]
        return vertices, np.concatenate(([0], np.cumsum(counts))), rows


def _coordinates(block: text.Block, lines: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Return the coordinates in the lines of vertices of a block, shape (n, 3)."""
    if not lines.any():
        return np.zeros((0, 3))
    letters, start, _length = block.of_lines(lines, 1)
    if (letters == ord("#")).any():
        counts = _without_comments(letters, start)
    else:
        counts = text.count_words(letters, start)
    if (counts < 3).any():
        line = int(np.flatnonzero(counts < 3)[0])
        words = letters[start[line] :].tobytes().split(b"\n", 1)[0].strip()
        raise FileError(f"A vertex has less than three coordinates: {text.shown(words)}.")
    numbers = text.numbers(letters, np.float64, int(counts.sum()))
    if (counts == counts[0]).all():
        return numbers.reshape(-1, counts[0])[:, :3]
    begin = starts(counts)
    return numbers[begin[:, None] + np.arange(3)]


def _without_comments(letters: NDArray[np.uint8], start: NDArray[np.int64]) -> NDArray[np.int64]:
    """Put spaces in place of what follows a # in its line, and return the number of words in each line."""
    hashes = np.flatnonzero(letters == ord("#"))
    line = np.searchsorted(start, hashes, side="right") - 1
    stop = np.append(start[1:], len(letters))[line]
    step = np.zeros(len(letters) + 1, np.int32)
    np.add.at(step, hashes, 1)
    np.add.at(step, stop, -1)
    is_comment = (np.cumsum(step[:-1]) > 0) & (letters != 10)
    letters[is_comment] = 32
    return text.count_words(letters, start)


def new_file(
    positions: NDArray[np.floating], face_offset: NDArray[Any], corner_vertex: NDArray[Any]
) -> bytes:
    """Return an OBJ file of a surface; see `ply.new_file` for the parameters."""
    form = b"v %.17g %.17g %.17g\n" if positions.dtype == np.float64 else b"v %.9g %.9g %.9g\n"
    pieces = [b"# Framelet\n", (form * len(positions)) % tuple(positions.reshape(-1).tolist())]
    sizes = np.diff(face_offset)
    numbers = (np.asarray(corner_vertex, np.int64) + 1).tolist()
    forms = {size: b"f" + b" %d" * size + b"\n" for size in np.unique(sizes).tolist()}
    pieces.append(b"".join([forms[size] for size in sizes.tolist()]) % tuple(numbers))
    return b"".join(pieces)
