# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""PLY files: ascii and both binary orders, with any elements and properties, and faces of any size."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .convert import triangles_of
from .mesh_file import ROUNDED, FileError, MeshFile, check_indices, doubles
from .normals import renewed_normals
from .places import merge_equal
from .ply_binary import BinaryLayout
from .ply_header import TYPES, Element, Table, read_header
from .ply_text import TextLayout

INDEX_NAMES = ("vertex_indices", "vertex_index")


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
        self._order, elements, self._begin = read_header(data)
        self._check_counts(elements)
        self._layout = BinaryLayout(data, self._order) if self._order else TextLayout(data, self._begin)
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
                    f"The header speaks of {element.count:,} elements ‘{element.name}’, but only {room:,} "
                    "bytes follow; the file was cut off or is damaged."
                )

    def _read_vertices(self, table: Table) -> None:
        element = table.element
        numbers = [element.index(axis) for axis in "xyz"]
        if min(numbers) < 0:
            raise FileError("The vertices have no coordinates x, y and z.")
        kinds = [TYPES[element.properties[number].kind] for number in numbers]
        self._are_whole = all(kind[0] != "f" for kind in kinds)
        if self._are_whole:
            self.warnings.append(ROUNDED)
        elif any(kind[0] != "f" for kind in kinds):
            raise FileError(
                "Some coordinates of the vertices are whole numbers and some are not; they need one type."
            )
        self.precision = np.dtype(np.float64 if "f8" in kinds or self._are_whole else np.float32)
        self._kinds, self._places = kinds, [table.columns[number] for number in numbers]
        columns = [self._layout.values(at, kind) for at, kind in zip(self._places, kinds, strict=True)]
        self.positions = doubles(np.stack(columns, axis=1))
        numbers = [element.index(name) for name in ("nx", "ny", "nz")]
        self.has_normals = max(numbers) >= 0
        self._normals: tuple[list[NDArray[np.int64]], list[str]] | None = None
        if min(numbers) >= 0:
            kinds = [TYPES[element.properties[number].kind] for number in numbers]
            if all(
                kind[0] == "f" and table.lengths[n] is None for kind, n in zip(kinds, numbers, strict=True)
            ):
                self._normals = [table.columns[number] for number in numbers], kinds
                self.has_normals = False

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

    def references(self) -> list[str]:
        """Return the textures that comments of the header name, as MeshLab writes them."""
        found = re.findall(rb"(?<=[\r\n])comment TextureFile ([^\r\n]+)", self._data[: self._begin])
        return [name.strip().decode("utf-8", "surrogateescape") for name in found]

    def patched(self, positions: NDArray[np.floating]) -> bytes:
        """See `MeshFile.patched`; the normals of vertices whose faces moved follow."""
        moved = self.moved(positions)
        if not moved.any():
            return self._data
        after = np.asarray(positions)
        if self._are_whole:
            limits = [np.iinfo(kind) for kind in self._kinds]
            low, high = [each.min for each in limits], [min(each.max, 2**53) for each in limits]
            after = np.clip(np.rint(after), np.array(low, float), np.array(high, float)) + 0.0  # none is -0.0
        data = self._layout.replaced(self._places, self._kinds, moved, after, self.positions)
        if self._normals is None or not self.n_faces:
            return data
        places, kinds = self._normals
        before = np.stack(
            [self._layout.values(at, kind) for at, kind in zip(places, kinds, strict=True)], axis=1
        )
        normals, is_new = self._renewed(doubles(before), doubles(after), moved)
        if not is_new.any():
            return data
        layout = BinaryLayout(data, self._order) if self._order else TextLayout(data, self._begin)
        return layout.replaced(places, kinds, is_new, normals, before)

    def _renewed(
        self, before: NDArray[np.float64], after: NDArray[np.float64], moved: NDArray[np.bool_]
    ) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        """Return the normals of a surface that moved, as long as they were, and which of them are new."""
        with np.errstate(over="ignore", invalid="ignore"):  # of what is no number
            length = np.linalg.norm(before, axis=1)
            triangles = triangles_of(self.face_offset, self.corner_vertex)
            place = merge_equal(self.positions)[0]
            normals, is_new = renewed_normals(before, place, triangles, triangles, after, moved)
            # Faces may be wound so that the normals of the file look against them.
            sample = triangles[:: len(triangles) // 10_000 + 1]
            corners = self.positions[sample]
            areas = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
            if np.nansum(areas * before[sample[:, 0]]) < 0.0:
                normals = -normals
            is_new &= np.isfinite(length) & (length > 0.0)  # zeros say that there is none
            is_unit = np.abs(length - 1.0) < 1e-3  # as far as few digits tell
            return normals * np.where(is_unit, 1.0, length)[:, None], is_new


def new_file(
    positions: NDArray[np.floating], face_offset: NDArray[Any], corner_vertex: NDArray[Any]
) -> bytes:
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
