# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""PLY files: ascii and both binary orders, with any elements and properties, and faces of any size."""

from __future__ import annotations

import struct
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from . import text
from .mesh_file import FileError, MeshFile, check_indices

TYPES = {
    **{"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4"},
    **{"int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4"},
    **{"float": "f4", "double": "f8", "float32": "f4", "float64": "f8"},
    **{"int64": "i8", "uint64": "u8"},  # of no standard, but written
}
INDEX_NAMES = ("vertex_indices", "vertex_index")
LONGEST_HEADER = 2**20
_ORDERS = {"binary_little_endian": "<", "binary_big_endian": ">", "ascii": ""}


@dataclass(frozen=True)
class Property:
    """A property of an element: its name, its type, and the type of its count if it is a list."""

    name: str
    kind: str
    count_kind: str = ""


@dataclass
class Element:
    """An element of the header: its name, how many there are, and their properties."""

    name: str
    count: int
    properties: list[Property] = field(default_factory=list)

    def index(self, *names: str) -> int:
        """Return the number of the first property with one of some names; -1 if there is none."""
        return next((k for k, each in enumerate(self.properties) if each.name in names), -1)


@dataclass
class Table:
    """Where the values of an element are.

    Attributes
    ----------
    element : Element
        What the header says.
    columns : list of ndarray, shape (count,)
        For each property where its values are: bytes of a binary file, words of a text.
    lengths : list of ndarray, shape (count,), or None
        For each list the number of its values; None for other properties.
    end : int
        Where the element ends.
    """

    element: Element
    columns: list[NDArray[np.int64]]
    lengths: list[NDArray[np.int64] | None]
    end: int


class PlyFile(MeshFile):
    """A PLY file in memory.

    Examples
    --------
    >>> head = b"ply\\nformat ascii 1.0\\nelement vertex 3\\n"
    >>> head += b"property float x\\nproperty float y\\nproperty float z\\n"
    >>> head += b"element face 1\\nproperty list uchar int vertex_indices\\nend_header\\n"
    >>> file = PlyFile(head + b"0 0 0\\n1 0 0\\n0 1 0\\n3 0 1 2\\n", "triangle")
    >>> file.corner_vertex.tolist()
    [0, 1, 2]
    >>> file.patched(file.positions + [[0, 0, 0], [0, 0, 0], [0, 0, 0.5]]).splitlines()[-2]
    b'0 1 0.5'
    """

    def __init__(self, data: bytes, name: str) -> None:
        super().__init__(name)
        self._data = data
        self._order, elements, self._begin = _read_header(data)
        self._check_counts(elements)
        self._layout = _BinaryLayout(data, self._order) if self._order else _TextLayout(data, self._begin)
        tables: dict[str, Table] = {}
        at = self._begin if self._order else 0
        for element in elements:
            table = self._layout.table(element, at)
            tables.setdefault(element.name, table)
            at = table.end
        if "vertex" not in tables or tables["vertex"].element.index("x") < 0:
            raise FileError("The file has no vertices with the coordinates x, y and z.")
        self._read_vertices(tables["vertex"])
        self._read_faces(tables)
        self._read_edges(tables.get("edge"))
        self._find_extras(elements)

    def _check_counts(self, elements: list[Element]) -> None:
        """Raise FileError if the file is too short for what its header says."""
        room = len(self._data) - self._begin
        for element in elements:
            least = sum(np.dtype(TYPES[each.count_kind or each.kind]).itemsize for each in element.properties)
            if not self._order:
                least = 2 * len(element.properties) - 1
            if element.count * max(least, 1 if self._order else 0) > room + 1:
                raise FileError(
                    f"The header speaks of {element.count:,} elements ‘{element.name}’, but only {room:,} bytes "
                    "follow; the file was cut off or is damaged."
                )

    def _read_vertices(self, table: Table) -> None:
        element = table.element
        numbers = [element.index(axis) for axis in "xyz"]
        if min(numbers) < 0:
            raise FileError("The vertices have no coordinates x, y and z.")
        kinds = [TYPES[element.properties[number].kind] for number in numbers]
        if any(kind[0] != "f" for kind in kinds):
            raise FileError(
                "The coordinates of the vertices are whole numbers; they need to be float or double."
            )
        self.precision = np.dtype(np.float64 if "f8" in kinds else np.float32)
        self._kinds, self._places = kinds, [table.columns[number] for number in numbers]
        columns = [self._layout.values(at, kind) for at, kind in zip(self._places, kinds, strict=True)]
        self.positions = np.stack(columns, axis=1).astype(np.float64)

    def _read_faces(self, tables: dict[str, Table]) -> None:
        table = tables.get("face")
        at = -1 if table is None else table.element.index(*INDEX_NAMES)
        if table is None or at < 0 or table.lengths[at] is None:
            self._read_strips(tables.get("tristrips"))
        else:
            lengths = table.lengths[at]
            assert lengths is not None
            self.face_offset = np.concatenate(([0], np.cumsum(lengths)))
            kind = TYPES[table.element.properties[at].kind]
            self.corner_vertex = self._layout.lists(table.columns[at], lengths, kind)
        check_indices(self.corner_vertex, self.face_offset, len(self.positions))

    def _read_strips(self, table: Table | None) -> None:
        """Read strips of triangles, which end where a number is negative."""
        corners = np.zeros((0, 3), np.int64)
        at = -1 if table is None else table.element.index(*INDEX_NAMES)
        if table is not None and at >= 0 and table.lengths[at] is not None:
            lengths = table.lengths[at]
            assert lengths is not None
            kind = TYPES[table.element.properties[at].kind]
            strip = self._layout.lists(table.columns[at], lengths, kind)
            ends = np.cumsum(lengths)
            strip = np.insert(strip, ends, -1)
            if len(strip) > 3:
                rows = np.stack((strip[:-2], strip[1:-1], strip[2:]), axis=1)
                place = np.arange(len(strip))
                since = place - np.maximum.accumulate(np.where(strip < 0, place + 1, 0))
                odd = since[:-2] % 2 == 1
                rows[odd] = rows[odd][:, [1, 0, 2]]
                is_whole = (rows >= 0).all(axis=1)
                corners = rows[is_whole]
                different = (corners != np.roll(corners, 1, axis=1)).all(axis=1)
                corners = corners[different]
        self.corner_vertex = corners.reshape(-1)
        self.face_offset = np.arange(0, 3 * len(corners) + 1, 3)

    def _read_edges(self, table: Table | None) -> None:
        if table is None:
            return
        ends = [table.element.index(name) for name in ("vertex1", "vertex2")]
        if min(ends) < 0:
            return
        kinds = [TYPES[table.element.properties[end].kind] for end in ends]
        columns = [
            self._layout.values(table.columns[end], kind) for end, kind in zip(ends, kinds, strict=True)
        ]
        edges = np.stack(columns, axis=1).astype(np.int64)
        check_indices(edges.reshape(-1), np.arange(0, edges.size + 1, 2), len(self.positions))
        self.loose_edges = edges

    def _find_extras(self, elements: list[Element]) -> None:
        """Note what a conversion would drop."""
        known = {"vertex": ("x", "y", "z"), "face": INDEX_NAMES}
        for element in elements:
            if element.name in known or element.name == "tristrips":
                extra = [
                    p.name for p in element.properties if p.name not in known.get(element.name, INDEX_NAMES)
                ]
                self.extras += [f"property {name} of the {element.name} elements" for name in extra]
            elif element.count:
                self.extras.append(f"elements {element.name}")
        vertex = next(element for element in elements if element.name == "vertex")
        self.has_normals = vertex.index("nx") >= 0

    def patched(self, positions: NDArray[np.floating]) -> bytes:
        """See `MeshFile.patched`."""
        moved = self.moved(positions)
        if not moved.any():
            return self._data
        return self._layout.replaced(self._places, self._kinds, moved, np.asarray(positions), self.positions)


class _BinaryLayout:
    """Values at bytes."""

    def __init__(self, data: bytes, order: str) -> None:
        self._data, self._order = data, order
        self._bytes = np.frombuffer(data, np.uint8)

    def table(self, element: Element, begin: int) -> Table:
        """Find out where the values of an element are."""
        sizes = [np.dtype(TYPES[each.kind]).itemsize for each in element.properties]
        if not element.count or not element.properties:
            return Table(
                element, [np.zeros(0, np.int64)] * len(sizes), [np.zeros(0, np.int64)] * len(sizes), begin
            )
        uniform = self._uniform(element, sizes, begin)
        return uniform if uniform is not None else self._walked(element, sizes, begin)

    def _uniform(self, element: Element, sizes: list[int], begin: int) -> Table | None:
        """Find the values if all elements have lists as long as those of the first; else None."""
        starts, lengths, at = [], [], begin
        for each, size in zip(element.properties, sizes, strict=True):
            if each.count_kind:
                kind = np.dtype(self._order + TYPES[each.count_kind])
                length = int(self._one(at, kind))
                at += kind.itemsize
                starts.append(at)
                lengths.append(length)
                at += length * size
            else:
                starts.append(at)
                lengths.append(-1)
                at += size
        step = at - begin
        end = begin + step * element.count
        if end > len(self._data):
            if not any(each.count_kind for each in element.properties):
                raise FileError(f"The file ends within the elements ‘{element.name}’; it was cut off.")
            return None
        row = np.arange(element.count, dtype=np.int64) * step
        for each, start, length in zip(element.properties, starts, lengths, strict=True):
            if length >= 0:
                kind = np.dtype(self._order + TYPES[each.count_kind])
                found = np.ndarray((element.count,), kind, self._data, start - kind.itemsize, strides=(step,))
                if not (found == length).all():
                    return None
        counts = [None if length < 0 else np.full(element.count, length) for length in lengths]
        return Table(element, [start + row for start in starts], counts, end)

    def _one(self, at: int, kind: np.dtype) -> int:
        """Return one count."""
        if at + kind.itemsize > len(self._data):
            raise FileError("The file ends within a list; it was cut off.")
        count = int(np.frombuffer(self._data, kind, 1, at)[0])
        if kind.kind == "f" or count < 0:
            raise FileError(f"A list has {count} values; the file is damaged.")
        return count

    def _walked(self, element: Element, sizes: list[int], begin: int) -> Table:
        """Find the values of elements whose lists have different lengths, one element after the other."""
        fixed, steps = [], []
        before = 0
        for each, size in zip(element.properties, sizes, strict=True):
            if each.count_kind:
                steps.append(
                    (before, struct.Struct((self._order or "<") + _CODES[TYPES[each.count_kind]]), size)
                )
                before = 0
            else:
                before += size
        fixed = before
        data, at, n_lists = self._data, begin, len(steps)
        found = np.empty((element.count, 2 * n_lists), np.int64)
        limit = len(data)
        for row in range(element.count):
            marks = []
            for skipped, count_of, size in steps:
                at += skipped
                if at + count_of.size > limit:
                    raise FileError(f"The file ends within the elements ‘{element.name}’; it was cut off.")
                (count,) = count_of.unpack_from(data, at)
                if count < 0:
                    raise FileError(f"A list has {count} values; the file is damaged.")
                at += count_of.size
                marks += [at, count]
                at += count * size
            found[row] = marks
            at += fixed
            if at > limit:
                raise FileError(f"The file ends within the elements ‘{element.name}’; it was cut off.")
        columns: list[NDArray[np.int64]] = []
        lengths: list[NDArray[np.int64] | None] = []
        which, last = 0, np.concatenate(([begin], np.zeros(element.count - 1, np.int64)))
        if n_lists:
            ends = found[:, -2] + found[:, -1] * steps[-1][2] + fixed
            last[1:] = ends[:-1]
        for each, size in zip(element.properties, sizes, strict=True):
            if each.count_kind:
                columns.append(found[:, 2 * which])
                lengths.append(found[:, 2 * which + 1])
                last = found[:, 2 * which] + found[:, 2 * which + 1] * size
                which += 1
            else:
                columns.append(last)
                lengths.append(None)
                last = last + size
        return Table(element, columns, lengths, at)

    def values(self, at: NDArray[np.int64], kind: str) -> NDArray:
        """Return the values at some bytes, shape (n,)."""
        dtype = np.dtype(self._order + kind)
        if not len(at):
            return np.zeros(0, kind)
        step = _common_step(at)
        if step:
            return np.ndarray((len(at),), dtype, self._data, int(at[0]), strides=(step,)).astype(kind)
        return self._gathered(at, dtype).astype(kind)

    def lists(self, at: NDArray[np.int64], lengths: NDArray[np.int64], kind: str) -> NDArray[np.int64]:
        """Return the values of all lists, one after the other."""
        dtype = np.dtype(self._order + kind)
        step = _common_step(at)
        if step and lengths[0] > 0 and (lengths == lengths[0]).all():
            shape, strides = (len(at), int(lengths[0])), (step, dtype.itemsize)
            rows = np.ndarray(shape, dtype, self._data, int(at[0]), strides=strides)
            return rows.reshape(-1).astype(np.int64)
        begin = np.cumsum(lengths) - lengths
        within = np.arange(int(lengths.sum())) - np.repeat(begin, lengths)
        return self._gathered(np.repeat(at, lengths) + within * dtype.itemsize, dtype).astype(np.int64)

    def _gathered(self, at: NDArray[np.int64], dtype: np.dtype) -> NDArray:
        """Return values that begin at any bytes."""
        parts = self._bytes[at[:, None] + np.arange(dtype.itemsize)]
        return np.ascontiguousarray(parts).view(dtype).reshape(-1)

    def replaced(
        self,
        places: list[NDArray[np.int64]],
        kinds: list[str],
        moved: NDArray[np.bool_],
        after: NDArray[np.floating],
        _before: NDArray[np.float64],
    ) -> bytes:
        """Return the file with other values at some bytes."""
        result = bytearray(self._data)
        for axis, (at, kind) in enumerate(zip(places, kinds, strict=True)):
            dtype = np.dtype(self._order + kind)
            step = _common_step(at)
            if step:
                column = np.ndarray((len(at),), dtype, result, int(at[0]), strides=(step,))
                np.copyto(column, after[:, axis], where=moved, casting="same_kind")
                continue
            values = np.ascontiguousarray(after[moved, axis], dtype).view(np.uint8)
            letters = np.frombuffer(result, np.uint8)
            letters[at[moved, None] + np.arange(dtype.itemsize)] = values.reshape(-1, dtype.itemsize)
        return bytes(result)


def _common_step(at: NDArray[np.int64]) -> int:
    """Return the distance between places if it is the same everywhere; else 0."""
    if len(at) < 2:
        return len(at)
    step = int(at[1] - at[0])
    return step if (np.diff(at) == step).all() else 0


_CODES = {
    "i1": "b", "u1": "B", "i2": "h", "u2": "H", "i4": "i", "u4": "I", "i8": "q", "u8": "Q", "f4": "f", "f8": "d",
}  # fmt: skip


class _TextLayout:
    """Values at words, counted from the end of the header."""

    def __init__(self, data: bytes, begin: int) -> None:
        self._data, self._begin = data, begin
        self._letters = np.frombuffer(data, np.uint8, len(data) - begin, begin)
        self._start = np.flatnonzero(text.word_starts(self._letters))
        self._numbers: NDArray[np.float64] | None = None

    def table(self, element: Element, begin: int) -> Table:
        """Find out where the values of an element are."""
        is_list = [bool(each.count_kind) for each in element.properties]
        if not element.count or not element.properties:
            empty = np.zeros(0, np.int64)
            return Table(element, [empty] * len(is_list), [empty] * len(is_list), begin)
        if not any(is_list):
            row = np.arange(element.count, dtype=np.int64) * len(is_list) + begin
            end = begin + element.count * len(is_list)
            self._check_end(element, end)
            return Table(element, [row + k for k in range(len(is_list))], [None] * len(is_list), end)
        return (
            self._uniform(element, is_list, begin)
            or self._by_lines(element, is_list, begin)
            or self._walked(element, is_list, begin)
        )

    def _check_end(self, element: Element, end: int) -> None:
        if end > len(self._start):
            raise FileError(f"The file ends within the elements ‘{element.name}’; it was cut off.")

    def _uniform(self, element: Element, is_list: list[bool], begin: int) -> Table | None:
        """Find the values if all elements have lists as long as those of the first; else None."""
        starts, lengths, at = [], [], begin
        for each in is_list:
            if each:
                length = self._count(at)
                starts.append(at + 1)
                lengths.append(length)
                at += 1 + length
            else:
                starts.append(at)
                lengths.append(-1)
                at += 1
        step = at - begin
        if begin + step * element.count > len(self._start):
            return None
        row = np.arange(element.count, dtype=np.int64) * step
        for start, length in zip(starts, lengths, strict=True):
            if length >= 0 and not (self.values(start - 1 + row, "f8") == length).all():
                return None
        counts = [None if length < 0 else np.full(element.count, length) for length in lengths]
        return Table(element, [start + row for start in starts], counts, begin + step * element.count)

    def _by_lines(self, element: Element, is_list: list[bool], begin: int) -> Table | None:
        """Find the values if each element is a line that begins with its only list; else None."""
        if not is_list[0] or any(is_list[1:]) or begin >= len(self._start):
            return None
        origin = int(self._start[begin])
        breaks = np.flatnonzero(self._letters[origin:] == 10)[: element.count - 1] + origin
        row = np.concatenate(([begin], np.searchsorted(self._start, breaks)))
        if len(row) < element.count or row[-1] >= len(self._start):
            return None
        numbers = self._all()[row]
        if not ((numbers >= 0) & (numbers < 2**31)).all():
            return None
        length = numbers.astype(np.int64)
        end = row + length + len(is_list)
        if (end[:-1] != row[1:]).any() or end[-1] > len(self._start):
            return None
        columns = [row + 1, *(row + length + k for k in range(1, len(is_list)))]
        return Table(element, columns, [length, *[None] * (len(is_list) - 1)], int(end[-1]))

    def _count(self, at: int) -> int:
        if at >= len(self._start):
            raise FileError("The file ends within a list; it was cut off.")
        number = self._all()[at]
        if not (0 <= number < 2**31) or number != int(number):
            raise FileError(f"A list has {number:g} values; the file is damaged.")
        return int(number)

    def _walked(self, element: Element, is_list: list[bool], begin: int) -> Table:
        """Find the values of elements whose lists have different lengths, one element after the other."""
        at, n = begin, len(is_list)
        found = np.empty((element.count, 2 * n), np.int64)
        numbers = self._all()
        whole = (
            np.where(np.isfinite(numbers) & (np.abs(numbers) < 2**31), numbers, -1).astype(np.int64).tolist()
        )
        for row in range(element.count):
            marks = []
            for each in is_list:
                length = -1
                if each:
                    if at >= len(whole) or whole[at] < 0:
                        self._check_end(element, at + 1)
                        raise FileError("A list has a negative number of values; the file is damaged.")
                    length = whole[at]
                    at += 1
                marks += [at, length]
                at += 1 if length < 0 else length
            found[row] = marks
            self._check_end(element, at)
        lengths = [found[:, 2 * k + 1] if is_list[k] else None for k in range(n)]
        return Table(element, [found[:, 2 * k] for k in range(n)], lengths, at)

    def _all(self) -> NDArray[np.float64]:
        """Return all words as numbers."""
        if self._numbers is None:
            self._numbers = text.numbers(self._letters, np.float64, len(self._start))
        return self._numbers

    def values(self, at: NDArray[np.int64], kind: str) -> NDArray:
        """Return the values of some words, shape (n,)."""
        numbers = self._all()[at]
        with np.errstate(over="ignore", invalid="ignore"):
            return numbers.astype(kind)

    def lists(self, at: NDArray[np.int64], lengths: NDArray[np.int64], kind: str) -> NDArray[np.int64]:
        """Return the values of all lists, one after the other."""
        begin = np.cumsum(lengths) - lengths
        within = np.arange(int(lengths.sum())) - np.repeat(begin, lengths)
        numbers = self._all()[np.repeat(at, lengths) + within]
        if not (np.abs(numbers) < 2.0**53).all():
            raise FileError(
                "A face names a vertex by something that is no whole number; the file is damaged."
            )
        return numbers.astype(np.int64)

    def replaced(
        self,
        places: list[NDArray[np.int64]],
        kinds: list[str],
        moved: NDArray[np.bool_],
        after: NDArray[np.floating],
        before: NDArray[np.float64],
    ) -> bytes:
        """Return the file with other words."""
        words = np.stack(places, axis=1)[moved]
        order = np.argsort(words[0])
        words, rows = words[:, order].reshape(-1), np.asarray(after[moved], np.float64)[:, order]
        start = self._start[words]
        stop = text.word_stops(self._letters)[words]
        style = text.style_of_words(self._letters, start, stop, before, 0 if "f8" in kinds else 9)
        new, lengths = text.as_text(rows.reshape(-1), style)
        body = text.replaced(self._letters, start, stop, new, lengths)
        return self._data[: self._begin] + body.tobytes()


def _read_header(data: bytes) -> tuple[str, list[Element], int]:
    """Return the order of bytes, empty for a text, the elements, and where the header ends."""
    if not data.startswith(b"ply"):
        raise FileError("The file does not begin with ‘ply’; it is damaged or of another type.")
    end, newline = -1, b"\n"
    for candidate in (b"\r\n", b"\n", b"\r"):
        at = data.find(b"end_header" + candidate, 0, LONGEST_HEADER)
        if at >= 0:
            end, newline = at, candidate
            break
    if end < 0:
        raise FileError("The header of the PLY file has no end; the file is damaged or of another type.")
    order, elements = None, []
    for line in data[:end].decode("latin-1").replace("\r", "\n").split("\n"):
        words = line.split()
        if not words or words[0] in ("ply", "comment", "obj_info"):
            continue
        if words[0] == "format" and len(words) >= 2 and words[1] in _ORDERS:
            order = _ORDERS[words[1]]
        elif words[0] == "element" and len(words) == 3 and words[2].isdigit() and len(words[2]) < 16:
            elements.append(Element(words[1], int(words[2])))
        elif words[0] == "property" and elements and _property(words) is not None:
            elements[-1].properties.append(_property(words))
        else:
            raise FileError(f"The line {text.shown(line.encode())} of the PLY header cannot be understood.")
    if order is None:
        raise FileError("The PLY header does not say whether the file is ascii or binary.")
    return order, elements, end + len(b"end_header") + len(newline)


def _property(words: list[str]) -> Property | None:
    """Return the property of a line of the header; None if it is none."""
    if len(words) == 3 and words[1] in TYPES:
        return Property(words[2], words[1])
    if len(words) == 5 and words[1] == "list" and words[2] in TYPES and words[3] in TYPES:
        return None if TYPES[words[2]][0] == "f" else Property(words[4], words[3], words[2])
    return None


def new_file(positions: NDArray[np.floating], face_offset: NDArray, corner_vertex: NDArray) -> bytes:
    """Return a binary PLY file of a surface; coordinates are double if the positions are float64.

    Parameters
    ----------
    positions : ndarray, shape (N, 3), float32 or float64
        The vertices.
    face_offset : ndarray, shape (F + 1,), int
        First corner of each face, and the number of corners.
    corner_vertex : ndarray, shape (C,), int
        Vertex of each corner.
    """
    sizes = np.diff(face_offset)
    kind = "double" if positions.dtype == np.float64 else "float"
    count = "uchar" if not len(sizes) or sizes.max() < 256 else "int"
    head = ["ply", "format binary_little_endian 1.0", "comment Framelet", f"element vertex {len(positions)}"]
    head += [f"property {kind} {axis}" for axis in "xyz"]
    head += [f"element face {len(sizes)}", f"property list {count} int vertex_indices", "end_header\n"]
    width = 1 if count == "uchar" else 4
    begin = np.concatenate(([0], np.cumsum(width + 4 * sizes.astype(np.int64))))
    body = np.empty(int(begin[-1]), np.uint8)
    counts = np.ascontiguousarray(sizes, f"<u{width}").view(np.uint8).reshape(-1, width)
    body[begin[:-1, None] + np.arange(width)] = counts
    is_count = np.zeros(len(body), bool)
    is_count[begin[:-1, None] + np.arange(width)] = True
    body[~is_count] = np.ascontiguousarray(corner_vertex, "<i4").view(np.uint8)
    vertices = np.ascontiguousarray(positions, "<f8" if kind == "double" else "<f4")
    return "\n".join(head).encode() + vertices.tobytes() + body.tobytes()
