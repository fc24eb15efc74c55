# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""glTF and GLB files: positions behind accessors change, with their bounds, normals and tangents.

Skins, morph targets, materials, textures and animations are not looked at. A vertex is a place in a buffer,
so that primitives that share an accessor share vertices; those that were split are at the same position and
are welded for the work.
"""

from __future__ import annotations

import base64
import json
from functools import cached_property
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import numpy as np
from numpy.typing import NDArray

from . import json_spans
from .convert import triangles_of
from .gltf_buffers import Buffers, Stored, as_count, as_stored, is_file
from .gltf_container import Container, as_binary, refuse_compression
from .gltf_primitives import FAN, STRIP, TRIANGLES, Primitive, check_overlaps, check_room, shading, triangles
from .gltf_scene import placed_meshes
from .mesh_file import ROUNDED, FileError, MeshFile, Part, check_range, members
from .normals import renewed_normals, renewed_tangents
from .places import merge_equal


class GltfFile(MeshFile):
    """A glTF or GLB file in memory.

    Parameters
    ----------
    data : bytes
        The file.
    name : str
        The stem of its name.
    folder : Path
        Where its buffers are.

    Examples
    --------
    >>> import numpy as np
    >>> data = new_file(np.float32([[0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([0, 3]), np.array([0, 1, 2]))
    >>> GltfFile(data, "triangle", Path(".")).positions.shape
    (3, 3)
    """

    always_welded = True

    def __init__(self, data: bytes, name: str, folder: Path) -> None:
        super().__init__(name)
        self._container = Container(data)
        self._text, self._json = self._container.text, self._container.content
        refuse_compression(self._json)
        self._buffers = Buffers(self._json, self._container.chunk, folder)
        self._bytes, self._buffer_begin = self._buffers.bytes, self._buffers.begin
        self._uris = self._buffers.uris
        self._read_primitives()
        self._find_extras()
        self._references = self._find_references()
        self.renames: dict[str, str] = {}
        """New names of files that the file refers to, for the next `patched`."""

    def _read_primitives(self) -> None:
        found, n_corners = [], 0  # mesh, accessors, indices, triangles
        self._accessors: dict[int, Stored] = {}
        for number, mesh in enumerate(self._json.get("meshes", [])):
            for primitive in mesh["primitives"]:
                mode, attributes = primitive.get("mode", TRIANGLES), primitive["attributes"]
                if mode not in (TRIANGLES, STRIP, FAN) or "POSITION" not in attributes:
                    continue
                at = as_count(attributes["POSITION"])
                if at not in self._accessors:
                    self._accessors[at] = self._buffers.stored(at)
                    if self._accessors[at].width != 3:
                        raise FileError("Positions have not three coordinates; the file is damaged.")
                count = len(self._accessors[at].at)
                indices = self._buffers.stored(primitive["indices"]) if "indices" in primitive else None
                corners = triangles(self._buffers, indices, mode, count)
                found.append((number, attributes, indices, corners))
                n_corners += corners.size
                self._buffers.check_size(n_corners, "corners")
        places = [stored.at for stored in self._accessors.values()]
        sizes = np.cumsum([0, *map(len, places)])
        if len(places) == 1 and (np.diff(places[0]) > 0).all():
            vertex = first = np.arange(len(places[0]))
        else:
            joined = np.concatenate(places) if places else np.zeros(0, np.int64)
            _, first, vertex = np.unique(joined, return_index=True, return_inverse=True)
            order = np.argsort(first)  # in the order of the file
            rank = np.empty(len(first), np.int64)
            rank[order] = np.arange(len(first))
            first, vertex = first[order], rank[vertex.reshape(-1)]
        values = [self._buffers.values(stored) for stored in self._accessors.values()]
        self.positions = (np.concatenate(values) if values else np.zeros((0, 3)))[first]
        self._fixed = (np.concatenate(places) if places else np.zeros(0, np.int64))[first] < 0
        self._vertex = {
            at: vertex[begin:end]
            for at, begin, end in zip(self._accessors, sizes[:-1], sizes[1:], strict=True)
        }
        self._primitives = [
            Primitive(
                number,
                self._vertex[attributes["POSITION"]],
                corners,
                shading(self._buffers, attributes, "NORMAL", 3, len(self._vertex[attributes["POSITION"]])),
                shading(self._buffers, attributes, "TANGENT", 4, len(self._vertex[attributes["POSITION"]])),
                indices,
            )
            for number, attributes, indices, corners in found
        ]
        check_overlaps(self._buffers, list(self._accessors.values()), self._primitives)
        self._names = {name for _number, attributes, _indices, _corners in found for name in attributes}
        all_corners = [each.vertex[each.triangles].reshape(-1) for each in self._primitives]
        self.corner_vertex = np.concatenate(all_corners) if all_corners else np.zeros(0, np.int64)
        self.face_offset = np.arange(0, len(self.corner_vertex) + 1, 3)
        if any(stored.dtype.kind != "f" for stored in self._accessors.values()):
            self.warnings.append(ROUNDED)

    def _find_extras(self) -> None:
        names = self._names - {"POSITION"}
        words = {"NORMAL": "normals", "TANGENT": "tangents", "TEXCOORD": "UVs", "COLOR": "vertex colors"}
        self.extras += sorted({words.get(name.split("_")[0], name) for name in names})
        for key in ("materials", "images", "skins", "animations", "cameras"):
            if self._json.get(key):
                self.extras.append(key)
        if any("targets" in each for mesh in self._json.get("meshes", []) for each in mesh["primitives"]):
            self.extras.append("morph targets")

    @cached_property
    def _place(self) -> NDArray[np.int64]:
        """The same number for vertices at the same place, shape (N,)."""
        return merge_equal(self.positions)[0]

    def parts(self) -> list[Part]:
        """Return the meshes of the file; meshes that share vertices are one surface."""
        n_meshes = len(self._json.get("meshes", []))
        face_mesh = np.repeat(
            [each.mesh for each in self._primitives], [len(each.triangles) for each in self._primitives]
        ).astype(np.int64)
        group = np.arange(n_meshes)
        owner = np.full(len(self.positions), -1)
        for each in self._primitives:
            for other in np.unique(owner[each.vertex]).tolist():
                if other >= 0 and group[other] != group[each.mesh]:
                    group[group == group[other]] = group[each.mesh]
            owner[each.vertex] = each.mesh
        parts = []
        of_vertex = np.where(owner >= 0, group[owner], -1) if n_meshes else owner
        faces, vertices = members(group[face_mesh], n_meshes), members(of_vertex, n_meshes)
        first = {number: mesh for mesh, number in reversed(list(enumerate(group.tolist())))}
        for number in dict.fromkeys(group[[each.mesh for each in self._primitives]].tolist()):
            name = str(self._json["meshes"][first[number]].get("name") or self.name)
            parts.append(Part(name, faces[number], vertices[number]))
        return parts or super().parts()

    def movable(self) -> NDArray[np.bool_] | None:
        """Return False for vertices that are stored nowhere; see `MeshFile.movable`."""
        return ~self._fixed if self._fixed.any() else None

    def buffer_files(self) -> list[str]:
        """See `MeshFile.buffer_files`."""
        uris = [self._uris[number] for number in self._changing_buffers()]
        return [unquote(uri) for uri in uris if uri and is_file(uri)]

    def references(self) -> list[str]:
        """Return the files of images, and the buffers that hold no coordinates."""
        return self._references

    def _find_references(self) -> list[str]:
        uris = [image.get("uri") for image in self._json.get("images", [])]
        changing = {self._uris[buffer] for buffer in self._changing_buffers()}
        uris += [uri for uri in self._uris if uri not in changing]
        return [unquote(uri) for uri in uris if isinstance(uri, str) and is_file(uri)]

    def _changing_buffers(self) -> list[int]:
        """Return the buffers that positions, normals or tangents are stored in."""
        written = dict.fromkeys(self._accessors.values())
        for each in self._primitives:
            written |= dict.fromkeys(stored for stored in (each.normal, each.tangent) if stored is not None)
        joined = np.concatenate([stored.at for stored in written]) if written else np.zeros(0, np.int64)
        number = np.searchsorted(self._buffer_begin, joined[joined >= 0], side="right") - 1
        return np.unique(number).tolist()

    def side_files(self, positions: NDArray[np.floating]) -> dict[str, bytes]:
        """Return the buffers that are files of their own and hold coordinates; see `MeshFile.side_files`."""
        names = {number: self._uris[number] or "" for number in self._changing_buffers()}
        names = {number: uri for number, uri in names.items() if uri and is_file(uri)}
        if not names:
            return {}
        content, _bounds = self._changed(positions)
        begin = self._buffer_begin
        return {uri: content[begin[number] : begin[number + 1]].tobytes() for number, uri in names.items()}

    def patched(self, positions: NDArray[np.floating]) -> bytes:
        """See `MeshFile.patched`; bounds, normals and tangents follow."""
        content, bounds = self._changed(positions)
        changes = {}
        for (number, key), values in bounds.items():
            span = json_spans.span_of(self._text, ["accessors", number, key])
            changes[span] = json.dumps(values, separators=(",", ":"))
        for number, uri in enumerate(self._uris):
            if uri is None:
                continue
            begin, end = self._buffer_begin[number], self._buffer_begin[number + 1]
            new: str | None = self.renames.get(uri)
            if not is_file(uri) and (content[begin:end] != self._bytes[begin:end]).any():
                head = uri.partition(",")[0]
                new = f"{head},{base64.b64encode(content[begin:end].tobytes()).decode()}"
            if new is not None and new != uri:
                changes[json_spans.span_of(self._text, ["buffers", number, "uri"])] = json.dumps(new)
        text = json_spans.replaced(self._text, changes).encode("utf-8")
        return self._container.assembled(text, content[: self._buffer_begin[min(1, len(self._uris))]])

    def _changed(
        self, positions: NDArray[np.floating]
    ) -> tuple[NDArray[np.uint8], dict[tuple[int, str], list[float]]]:
        """Return all buffers with other coordinates, and the bounds that accessors have then."""
        content = self._bytes.copy()
        bounds: dict[tuple[int, str], list[float]] = {}
        moved = self.moved(positions)
        if not moved.any():
            return content, bounds
        after = np.asarray(positions, np.float64)
        for number, stored in self._accessors.items():
            vertex = self._vertex[number]
            chosen = moved[vertex] & (stored.at >= 0)
            if not chosen.any():
                continue
            self._buffers.store(content, stored, chosen, after[vertex[chosen]])
            numbers = self._buffers.numbers(stored.at, stored.dtype, 3)
            numbers[chosen] = as_stored(after[vertex[chosen]], stored)
            accessor = self._json["accessors"][number]
            for key, reduced in (("min", numbers.min(axis=0)), ("max", numbers.max(axis=0))):
                if key in accessor and accessor[key] != reduced.tolist():
                    bounds[number, key] = reduced.tolist()
        self._renew_normals(content, after, moved)
        return content, bounds

    def _renew_normals(
        self, content: NDArray[np.uint8], after: NDArray[np.float64], moved: NDArray[np.bool_]
    ) -> None:
        """Compute the normals and tangents of what moved."""
        primitives = [each for each in self._primitives if each.normal is not None]
        if not primitives:
            return
        # Many primitives may use the same vertices and normals: these are worked on once.
        shared: dict[tuple[int, int], list[Primitive]] = {}
        for each in primitives:
            shared.setdefault((id(each.vertex), id(each.normal)), []).append(each)
        first = [some[0] for some in shared.values()]
        stored = [each.normal for each in first if each.normal is not None]
        begin = np.cumsum([0, *(len(each.at) for each in stored)])
        normals, chosen = renewed_normals(
            np.concatenate([self._buffers.values(each) for each in stored]),
            np.concatenate([self._place[each.vertex] for each in first]),
            np.concatenate([each.vertex[each.triangles] for some in shared.values() for each in some]),
            np.concatenate(
                [
                    each.triangles + at
                    for some, at in zip(shared.values(), begin[:-1], strict=True)
                    for each in some
                ]
            ),
            after,
            moved,
        )
        for some, where, start, stop in zip(shared.values(), stored, begin[:-1], begin[1:], strict=True):
            own, is_new = normals[start:stop], chosen[start:stop] & (where.at >= 0)
            self._buffers.store(content, where, is_new, own[is_new])
            for at in dict.fromkeys(each.tangent for each in some if each.tangent is not None):
                tangents, is_turned = renewed_tangents(self._buffers.values(at), own)
                is_turned &= is_new & (at.at >= 0)
                self._buffers.store(content, at, is_turned, tangents[is_turned])

    def scene(
        self, positions: NDArray[np.floating]
    ) -> tuple[NDArray[np.floating], NDArray[np.int64], NDArray[np.int64]]:
        """Return the meshes as the nodes of the scene place them; see `MeshFile.scene`."""
        meshes = placed_meshes(self._json)
        if len(self._primitives) and all(np.array_equal(matrix, np.eye(4)) for _mesh, matrix in meshes):
            used = [mesh for mesh, _matrix in meshes]
            if len(set(used)) == len(used) == len({each.mesh for each in self._primitives}):
                return positions, self.face_offset, self.corner_vertex
        of_mesh: dict[int, list[Primitive]] = {}
        for each in self._primitives:
            of_mesh.setdefault(each.mesh, []).append(each)
        check_room([each for mesh, _matrix in meshes for each in of_mesh.get(mesh, ())])
        points, corners, n = [], [], 0
        for mesh, matrix in meshes:
            for each in of_mesh.get(mesh, ()):
                rows = np.asarray(positions, np.float64)[each.vertex]
                points.append(rows @ matrix[:3, :3].T + matrix[:3, 3])
                turned = each.triangles[:, ::-1] if np.linalg.det(matrix[:3, :3]) < 0 else each.triangles
                corners.append(turned.reshape(-1) + n)
                n += len(rows)
        if not points:
            raise FileError("The scene of the file shows none of its meshes.")
        corner = np.concatenate(corners)
        placed = np.concatenate(points)
        check_range(placed, positions.dtype)
        return placed.astype(positions.dtype), np.arange(0, len(corner) + 1, 3), corner


def new_file(
    positions: NDArray[np.floating], face_offset: NDArray[Any], corner_vertex: NDArray[Any]
) -> bytes:
    """Return a GLB file of a surface, in single precision; see `ply.new_file` for the parameters."""
    points = np.ascontiguousarray(positions, "<f4")
    corners = np.ascontiguousarray(triangles_of(face_offset, corner_vertex).reshape(-1), "<u4")
    chunk = points.tobytes() + corners.tobytes()
    bounds = {"min": points.min(axis=0).tolist(), "max": points.max(axis=0).tolist()} if len(points) else {}
    views = [
        {"buffer": 0, "byteOffset": 0, "byteLength": points.nbytes, "target": 34962},
        {"buffer": 0, "byteOffset": points.nbytes, "byteLength": corners.nbytes, "target": 34963},
    ]
    accessors = [
        {"bufferView": 0, "componentType": 5126, "count": len(points), "type": "VEC3", **bounds},
        {"bufferView": 1, "componentType": 5125, "count": len(corners), "type": "SCALAR"},
    ]
    content = {
        "asset": {"version": "2.0", "generator": "Framelet"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "buffers": [{"byteLength": len(chunk)}],
        "bufferViews": views,
        "accessors": accessors,
    }
    return as_binary(json.dumps(content, separators=(",", ":")).encode(), chunk)
