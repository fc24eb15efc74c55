# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""A noisy sheet, and files of it that hold everything that their formats allow."""

import base64
import json
import struct

import numpy as np

N = 12
"""Vertices on each side of the sheet."""


POSITIONS = ("--preset", "tri-2")
ORDERS = ("ascii", "binary_little_endian", "binary_big_endian")


def denoised(command, source, target, *options):
    """Denoise a file, and return both contents."""
    before = source.read_bytes()
    result = command("denoise", source, target, *POSITIONS, *options)
    assert result.code == 0, result.err
    assert source.read_bytes() == before
    return before, target.read_bytes()


def sheet(seed=1, n=N):
    """Return noisy positions, shape (n * n, 3), and triangles of a sheet."""
    x, y = np.meshgrid(np.arange(n), np.arange(n), indexing="ij")
    points = np.stack([x, y, np.zeros_like(x)], axis=-1).reshape(-1, 3)
    points = points + np.random.default_rng(seed).normal(0, 0.1, points.shape)
    number = np.arange(n * n).reshape(n, n)
    a, b, c, d = (
        part.ravel() for part in (number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:])
    )
    faces = np.concatenate((np.stack((a, b, c), 1), np.stack((a, c, d), 1)))
    return points, faces


def full_ply(order, coordinate="float", seed=1):
    """Return a PLY file with odd properties before, between and behind, lists, and extra elements.

    Parameters
    ----------
    order : {"ascii", "binary_little_endian", "binary_big_endian"}
        Format of the file.
    coordinate : {"float", "double"}
        Type of the coordinates.

    Returns
    -------
    data : bytes
    is_coordinate : ndarray of bool
        For each byte of the body, or each word of a text, whether it belongs to a coordinate.
    n_head : int
        Length of the header.
    """
    rng = np.random.default_rng(seed)
    points, triangles = sheet(seed)
    faces = [list(face) for face in triangles.tolist()]
    faces[3] += [int(faces[3][0]) + 2]  # a quad
    faces.insert(5, faces[5][:2])  # a line
    faces.insert(9, [faces[9][0]] * 3)  # a point
    faces.append(list(faces[0]))  # twice
    faces.append(list(range(N)))  # a polygon of its own
    head = f"""ply
format {order} 1.0
comment   spaces  and ümlauts
obj_info anything at all
comment TextureFile my texture.png
element camera 2
property double focal
property list uchar ushort pixels
element vertex {len(points)}
property int class_id
property {coordinate} x
property uchar red
property {coordinate} y
property double value
property {coordinate} z
property float confidence
property list int float history
element face {len(faces)}
property short label
property list int uint vertex_indices
property list uchar float texcoord
property uchar blue
element edge 2
property int vertex1
property int vertex2
property uchar crease
element nothing 0
property float zero
element tail 1
property uint64 stamp
end_header
"""
    rows = [[("f8", 35.5, 0), ("u1", 2, 0), ("u2", 7, 0), ("u2", 65535, 0)], [("f8", 0.1, 0), ("u1", 0, 0)]]
    kind = {"float": "f4", "double": "f8"}[coordinate]
    for k, point in enumerate(points):
        history = [("f4", float(v), 0) for v in rng.random(k % 3)]
        rows.append(
            [
                ("i4", int(rng.integers(-(2**31), 2**31)), 0),
                (kind, point[0], 1),
                ("u1", k % 256, 0),
                (kind, point[1], 1),
                ("f8", rng.normal(), 0),
                (kind, point[2], 1),
                ("f4", float(np.float32(rng.random())), 0),
                ("i4", len(history), 0),
                *history,
            ]
        )
    for k, face in enumerate(faces):
        uvs = [("f4", 0.25, 0)] * (2 * len(face) if k % 5 else 0)
        rows.append(
            [
                ("i2", k - 50, 0),
                ("i4", len(face), 0),
                *(("u4", v, 0) for v in face),
                ("u1", len(uvs), 0),
                *uvs,
                ("u1", 200, 0),
            ]
        )
    rows += [[("i4", 0, 0), ("i4", 5, 0), ("u1", 255, 0)], [("i4", 7, 0), ("i4", 9, 0), ("u1", 1, 0)]]
    rows.append([("u8", 2**63 + 1, 0)])
    if order == "ascii":
        lines = []
        for row in rows:
            words = [f"{value:.6f}" if flag else repr(value) for _kind, value, flag in row]
            lines.append(
                "  ".join(words[:2]) + (" " if len(words) > 2 else "") + " ".join(words[2:]) + " \r\n"
            )
        body = "".join(lines).encode()
        flags = np.array([flag for row in rows for _kind, _value, flag in row], bool)
        return head.replace("\n", "\r\n").encode() + body, flags, len(head.replace("\n", "\r\n").encode())
    sign = "<" if order == "binary_little_endian" else ">"
    parts = [(np.array(value, sign + kind).tobytes(), flag) for row in rows for kind, value, flag in row]
    flags = np.concatenate([np.full(len(part), bool(flag)) for part, flag in parts])
    return head.encode() + b"".join(part for part, _flag in parts), flags, len(head.encode())


def full_obj(newline="\n"):
    """Return an OBJ file with all kinds of statements, as text."""
    points, faces = sheet()
    lines = [
        "# a comment",
        "mtllib my materials.mtl",
        "vt 0.5 0.5",
        "vt 0.25 1e-3",
        "vn 0 0 1",
        "g first second",
    ]
    for k, (x, y, z) in enumerate(points):
        line = (
            f"v {x:.6f} {y:.6f} {z:.6f}",
            f"v  {x:.4f}\t{y:.7f} {z:.5f} 1.0",
            f"v {x:.6f} {y:.6f} {z:.6f} 0.5 0.25 1",
            f"\tv {x:.6f} {y:.6f} {z:.6f}   # behind",
        )[k % 4]
        lines.append(line)
        if k % 10 == 0:
            lines.append("vt 0 1")
    n = len(points)
    lines += ["s 1", "usemtl Low Vegetation", "o Sheet"]
    for k, (a, b, c) in enumerate(faces + 1):
        line = (
            f"f {a} {b} {c}",
            f"f {a}/1 {b}/2 {c}/1",
            f"f {a}//1 {b}//1 {c}//1",
            f"f {a - n - 1}/1/1 {b - n - 1}/2/1 {c - n - 1}/1/1",
            f"f {a} \\{newline}  {b} {c}",
        )[k % 5]
        lines.append(line)
        if k == 20:
            lines += ["g second", "usemtl Other", "s off", ""]
    lines += ["l 1 2 3", "p 4", "cstype bspline", "vp 0.5 0.5", f"f 1 2 {n + 50}", "end", "# no line end"]
    return newline.join(lines).encode()


def full_stl_text():
    """Return an ascii STL file with two solids, odd cases, and a facet without a normal."""
    points, faces = sheet()
    lines = []
    for number, part in enumerate((faces[:100], faces[100:])):
        lines.append(f"SOLID part {number} of two")
        for k, face in enumerate(part):
            normal = "0 0 0" if k == 3 else "0.0e+00 0.0 1.0"
            lines += [f"  Facet  Normal {normal}", "outer loop"]
            lines += ["\tVertex " + " ".join(f"{v:.6e}" for v in points[vertex]) for vertex in face]
            lines += ["endloop", "  endfacet"]
        lines.append("EndSolid")
    return "\r\n".join(lines).encode() + b"\r\n"


def full_stl_binary():
    """Return a binary STL file whose header says solid, with attributes and bytes behind the triangles."""
    from framelet.operators.files.stl import TRIANGLE

    points, faces = sheet()
    rows = np.zeros(len(faces), TRIANGLE)
    rows["corners"] = points[faces]
    rows["normal"] = (0, 0, 1)
    rows["normal"][4] = 0
    rows["attribute"] = np.arange(len(faces))
    return b"solid but binary \xff".ljust(80) + struct.pack("<I", len(faces)) + rows.tobytes()


def full_gltf(kind="glb", sparse=True):
    """Return a glTF file: two primitives with split vertices, sparse positions, a skin, morphs, and more.

    Parameters
    ----------
    kind : {"glb", "embedded", "separate"}
        A GLB file, a glTF file with its buffer inside, or one with the buffer in a file `sheet data.bin`.

    Returns
    -------
    data, buffer : bytes
    """
    points, faces = sheet()
    half = len(faces) // 2
    first, second = faces[:half], faces[half:]
    chunks, views, accessors = [], [], []

    def add(array, kind_code, type_name, stride=0, **extra):
        content = np.ascontiguousarray(array)
        begin = sum(map(len, chunks))
        data = content.tobytes()
        if stride:
            rows = content.reshape(len(content), -1)
            padded = np.full((len(rows), stride), 0xAA, np.uint8)
            padded[:, : rows.shape[1] * rows.itemsize] = rows.view(np.uint8).reshape(len(rows), -1)
            data = padded.tobytes()
        chunks.append(data + b"\xee" * (-len(data) % 4))
        views.append({"buffer": 0, "byteOffset": begin, "byteLength": len(data)})
        if stride:
            views[-1]["byteStride"] = stride
        accessors.append(
            {
                "bufferView": len(views) - 1,
                "componentType": kind_code,
                "count": len(content),
                "type": type_name,
            }
        )
        accessors[-1].update(extra)
        return len(accessors) - 1

    single = points.astype("<f4")
    used = np.unique(second)  # vertices of the second primitive, split from those of the first
    number = np.full(len(points), -1)
    number[used] = np.arange(len(used))
    normals = np.tile(np.float32([0, 0, 1]), (len(points), 1))
    tangents = np.tile(np.float32([1, 0, 0, -1]), (len(used), 1))
    bounds = {"min": single.min(0).tolist(), "max": single.max(0).tolist()}
    at_first = add(single, 5126, "VEC3", stride=20, **bounds)
    at_normal = add(normals, 5126, "VEC3")
    at_indices = add(first.astype("<u2").ravel(), 5123, "SCALAR")
    split = single[used].copy()
    moved = np.arange(0, len(used), 7)
    if sparse:
        split[moved] += 100  # what the sparse values put right
    at_second = add(split, 5126, "VEC3", min=single[used].min(0).tolist(), max=single[used].max(0).tolist())
    if sparse:
        at_numbers = add(moved.astype("u1"), 5121, "SCALAR")
        at_values = add(single[used][moved], 5126, "VEC3")
        accessors[at_second]["sparse"] = {
            "count": len(moved),
            "indices": {"bufferView": accessors[at_numbers]["bufferView"], "componentType": 5121},
            "values": {"bufferView": accessors[at_values]["bufferView"]},
        }
    at_normal_2 = add(normals[used], 5126, "VEC3")
    at_tangent = add(tangents, 5126, "VEC4")
    at_indices_2 = add(number[second].astype("<u4").ravel(), 5125, "SCALAR")
    at_uv = add(np.random.default_rng(2).random((len(points), 2)).astype("<f4"), 5126, "VEC2")
    at_morph = add(np.full((len(points), 3), 0.5, "<f4"), 5126, "VEC3", min=[0.5] * 3, max=[0.5] * 3)
    at_joints = add(np.zeros((len(points), 4), "u1"), 5121, "VEC4")
    at_weights = add(np.tile(np.float32([1, 0, 0, 0]), (len(points), 1)), 5126, "VEC4")
    at_line = add(np.arange(4, dtype="<u2"), 5123, "SCALAR")
    buffer = b"".join(chunks)
    one = {"POSITION": at_first, "NORMAL": at_normal, "TEXCOORD_0": at_uv}
    one |= {"JOINTS_0": at_joints, "WEIGHTS_0": at_weights}
    content = {
        "asset": {"version": "2.0", "copyright": "ümlaut"},
        "extensionsUsed": ["VENDOR_unknown"],
        "extensions": {"VENDOR_unknown": {"min": [1, 2, 3], "max": "accessors"}},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "translation": [1, 2, 3], "skin": 0}, {"name": "joint"}],
        "skins": [{"joints": [1]}],
        "animations": [],
        "meshes": [
            {
                "name": "Sheet",
                "weights": [0.5],
                "primitives": [
                    {
                        "attributes": one,
                        "indices": at_indices,
                        "material": 0,
                        "targets": [{"POSITION": at_morph}],
                    },
                    {
                        "attributes": {"POSITION": at_second, "NORMAL": at_normal_2, "TANGENT": at_tangent},
                        "indices": at_indices_2,
                    },
                    {"attributes": {"POSITION": at_first}, "indices": at_line, "mode": 1},
                ],
            }
        ],
        "materials": [{"name": "Paint", "extras": {"accessors": [{"min": 0}]}}],
        "images": [{"uri": "my%20texture.png"}],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": len(buffer), "extras": {"uri": "not this"}}],
    }
    if kind == "embedded":
        content["buffers"][0]["uri"] = (
            "data:application/octet-stream;base64," + base64.b64encode(buffer).decode()
        )
    if kind == "separate":
        content["buffers"][0]["uri"] = "sheet%20data.bin"
    text = json.dumps(content, indent=1, ensure_ascii=False).encode()
    if kind != "glb":
        return text, buffer
    text += b" " * (-len(text) % 4)
    other = struct.pack("<II", 8, 0x12345678) + b"whatever"
    body = struct.pack("<II", len(text), 0x4E4F534A) + text
    body += struct.pack("<II", len(buffer), 0x004E4942) + buffer + other
    return b"glTF" + struct.pack("<II", 2, 12 + len(body)) + body, buffer


def with_normals(points, faces, normals, order, kind="float"):
    """Return a PLY file with normals."""
    head = f"ply\nformat {order} 1.0\nelement vertex {len(points)}\n"
    head += "".join(f"property {kind} {name}\n" for name in ("x", "nx", "y", "ny", "z", "nz"))
    head += f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    rows = np.stack((points, normals), axis=2).reshape(-1, 6)
    if order == "ascii":
        body = "".join(" ".join(f"{number:.6f}" for number in row) + "\n" for row in rows)
        body += "".join(f"3 {a} {b} {c}\n" for a, b, c in faces)
        return (head + body).encode()
    sign = "<" if "little" in order else ">"
    corners = np.zeros(len(faces), [("n", "u1"), ("v", sign + "i4", 3)])
    corners["n"], corners["v"] = 3, faces
    return (
        head.encode() + rows.astype(sign + ("f4" if kind == "float" else "f8")).tobytes() + corners.tobytes()
    )


def normals_of(points, faces):
    """Return the mean normal of the triangles at each vertex, by area."""
    total = np.zeros(points.shape)
    areas = np.cross(points[faces[:, 1]] - points[faces[:, 0]], points[faces[:, 2]] - points[faces[:, 0]])
    for column in faces.T:
        np.add.at(total, column, areas)
    return total / np.linalg.norm(total, axis=1, keepdims=True)
