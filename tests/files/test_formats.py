# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Each format with everything that it allows: denoised, and all that is no coordinate is as it was."""

import json
import re
import struct

import numpy as np
import pytest
from framelet.core import PRESETS, Region, SurfaceMesh, denoise
from framelet.operators.files import FileError, open_file

from .made import (
    full_gltf,
    full_obj,
    full_ply,
    full_stl_binary,
    full_stl_text,
    normals_of,
    sheet,
    with_normals,
)

POSITIONS = ("--preset", "tri-2")
ORDERS = ("ascii", "binary_little_endian", "binary_big_endian")


def run(command, source, target, *options):
    """Denoise a file, and return both contents."""
    before = source.read_bytes()
    result = command("denoise", source, target, *POSITIONS, *options)
    assert result.code == 0, result.err
    assert source.read_bytes() == before
    return before, target.read_bytes()


@pytest.mark.parametrize("coordinate", ["float", "double"])
@pytest.mark.parametrize("order", ORDERS)
def test_ply(command, tmp_path, order, coordinate):
    data, is_coordinate, n_head = full_ply(order, coordinate)
    source = tmp_path / "in.ply"
    source.write_bytes(data)
    before, after = run(command, source, tmp_path / "out.ply")
    assert after[:n_head] == before[:n_head]
    if order == "ascii":
        words = [re.split(rb"(\s+)", each[n_head:]) for each in (before, after)]
        assert len(words[0]) == len(words[1]) and words[0][1::2] == words[1][1::2]
        (old, new), n = (np.array(each[0::2][:-1], object) for each in words), len(is_coordinate)
        assert len(old) == n and (old == new)[~is_coordinate].all()
        changed = old != new
        decimals = [len(word.partition(b".")[2]) for word in new[is_coordinate & changed]]
        assert min(decimals) >= 6 or coordinate == "float"
    else:
        old, new = (np.frombuffer(each, np.uint8)[n_head:] for each in (before, after))
        assert len(old) == len(new) == len(is_coordinate)
        changed = old != new
        assert not changed[~is_coordinate].any()
    assert changed[is_coordinate].mean() > 0.2
    moved = open_file(tmp_path / "out.ply")
    assert moved.precision == (np.float64 if coordinate == "double" else np.float32)
    assert np.abs(moved.positions - sheet()[0]).max() < 1.0
    # The same as the mesh itself, without its faces that are none.
    corners = np.split(moved.corner_vertex, moved.face_offset[1:-1])
    seen, faces = set(), []
    for face in corners:
        if len(set(face.tolist())) == len(face) > 2 and frozenset(face.tolist()) not in seen:
            seen.add(frozenset(face.tolist()))
            faces.append(face)
    noisy = open_file(source).positions.astype(moved.precision)
    expected = denoise(SurfaceMesh.from_faces(noisy, faces), PRESETS["TRI_2"].settings).vertices
    np.testing.assert_allclose(moved.positions, expected, atol=2e-5)


@pytest.mark.parametrize("kind", ["float", "double"])
@pytest.mark.parametrize("order", ORDERS)
def test_normals_of_a_ply_follow(command, tmp_path, order, kind):
    points, faces = sheet()
    normals = normals_of(points, faces)
    normals[7] *= 2.5  # as long as it was
    normals[9] = 0.0  # has none
    source, target = tmp_path / "in.ply", tmp_path / "out.ply"
    source.write_bytes(with_normals(points, faces, normals, order, kind))
    result = command("denoise", source, target, *POSITIONS)
    assert result.code == 0 and "normals" not in result.err
    after = open_file(target)
    places, kinds = after._normals
    found = np.stack([after._layout.values(at, each) for at, each in zip(places, kinds, strict=True)], axis=1)
    expected = normals_of(after.positions, faces)
    expected[7] *= 2.5
    expected[9] = 0.0
    np.testing.assert_allclose(found, expected, atol=2e-5)
    assert np.abs(found - normals).max() > 0.1


def test_normals_of_a_ply_keep_their_side_and_their_edges(tmp_path):
    points, faces = sheet()
    single = points.astype(np.float32).astype(float)
    moved = single + [0.0, 0.0, 0.25] * (single[:, :1] > 5.5)

    def renewed(normals, points, faces, moved):
        (tmp_path / "in.ply").write_bytes(with_normals(points, faces, normals, "binary_little_endian"))
        (tmp_path / "out.ply").write_bytes(open_file(tmp_path / "in.ply").patched(moved))
        rows = np.frombuffer(
            (tmp_path / "out.ply").read_bytes().split(b"end_header\n", 1)[1], "<f4", 6 * len(points)
        )
        return rows.reshape(-1, 6)[:, 1::2]

    inward = -normals_of(single, faces)
    after = renewed(inward, single, faces, moved)
    np.testing.assert_allclose(after, -normals_of(moved, faces), atol=1e-6)
    # Far from what moved the bytes stay; vertices that were split share a normal where they shared it.
    still = (single[:, 0] < 3.5).nonzero()[0]
    assert np.array_equal(after[still], inward[still].astype(np.float32))
    corners = faces.ravel()
    soup = np.arange(len(corners)).reshape(-1, 3)
    after = renewed(inward[corners], single[corners], soup, moved[corners])
    np.testing.assert_allclose(after, -normals_of(moved, faces)[corners], atol=1e-6)
    flat = np.repeat(normals_of(single[corners], soup)[::3], 3, axis=0)
    after = renewed(flat, single[corners], soup, moved[corners])
    np.testing.assert_allclose(after, normals_of(moved[corners], soup), atol=1e-6)


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("kind", ["short", "int", "uint64"])
def test_whole_coordinates_are_rounded_and_say_so(command, tmp_path, order, kind):
    points, faces = sheet()
    whole = np.rint((points + 1.0) * 1000.0)
    if kind == "short":
        whole[:, 0] -= 4000.0
    head = f"ply\nformat {order} 1.0\nelement vertex {len(points)}\n"
    head += "".join(f"property {kind} {axis}\n" for axis in "xyz")
    head += f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    if order == "ascii":
        body = "".join("{:.0f} {:.0f} {:.0f}\n".format(*row) for row in whole)
        body = (body + "".join("3 {} {} {}\n".format(*face) for face in faces)).encode()
    else:
        sign = "<" if "little" in order else ">"
        corners = np.zeros(len(faces), [("n", "u1"), ("v", sign + "i4", 3)])
        corners["n"], corners["v"] = 3, faces
        body = whole.astype(sign + {"short": "i2", "int": "i4", "uint64": "u8"}[kind]).tobytes()
        body += corners.tobytes()
    (tmp_path / "in.ply").write_bytes(head.encode() + body)
    result = command("denoise", tmp_path / "in.ply", tmp_path / "out.ply", *POSITIONS)
    assert result.code == 0 and "rounded" in result.err
    expected = denoise(SurfaceMesh.from_faces(whole, faces), PRESETS["TRI_2"].settings).vertices
    after = open_file(tmp_path / "out.ply")
    assert np.array_equal(after.positions, np.rint(expected))
    if order == "ascii":
        assert b"." not in (tmp_path / "out.ply").read_bytes()[len(head) :]
    assert np.array_equal(after.corner_vertex, faces.ravel())


def test_header_with_spaces_behind_its_words(tmp_path):
    data = full_ply("binary_little_endian")[0]
    head, body = data.split(b"end_header\n", 1)
    (tmp_path / "in.ply").write_bytes(head.replace(b"\n", b" \n") + b"end_header \n" + body)
    (tmp_path / "as.ply").write_bytes(data)
    assert np.array_equal(open_file(tmp_path / "in.ply").positions, open_file(tmp_path / "as.ply").positions)


@pytest.mark.parametrize("order", ORDERS)
def test_ply_strips(tmp_path, order):
    strip = [0, 1, 2, 3, -1, 4, 5, 6]
    head = (
        f"ply\nformat {order} 1.0\nelement vertex 7\nproperty float x\nproperty float y\nproperty float z\n"
        "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
    ).encode()
    points = np.arange(21.0).reshape(7, 3)
    if order == "ascii":
        body = "\n".join(" ".join(map(str, row)) for row in [*points.tolist(), [len(strip), *strip]]).encode()
    else:
        sign = "<" if "little" in order else ">"
        body = points.astype(sign + "f4").tobytes() + np.array([len(strip), *strip], sign + "i4").tobytes()
    (tmp_path / "in.ply").write_bytes(head + body)
    file = open_file(tmp_path / "in.ply")
    assert file.corner_vertex.reshape(-1, 3).tolist() == [[0, 1, 2], [2, 1, 3], [4, 5, 6]]


@pytest.mark.parametrize("newline", ["\n", "\r\n"])
def test_obj(command, tmp_path, newline):
    source = tmp_path / "in.obj"
    source.write_bytes(full_obj(newline))
    before, after = run(command, source, tmp_path / "out.obj")
    pattern = re.compile(rb"^(\s*v\s+)(\S+)(\s+)(\S+)(\s+)(\S+)(.*)$", re.DOTALL)
    old, new = (each.split(b"\n") for each in (before, after))
    assert len(old) == len(new)
    n_changed = 0
    for first, second in zip(old, new, strict=True):
        found = [pattern.match(line) for line in (first, second)]
        if found[0] is None:
            assert first == second
            continue
        for group in (1, 3, 5, 7):
            assert found[0][group] == found[1][group]
        n_changed += first != second
        for group in (2, 4, 6):
            decimals = [len(each[group].partition(b".")[2]) for each in found]
            assert decimals[1] >= decimals[0]
    assert n_changed > 100
    file = open_file(source)
    np.testing.assert_allclose(file.positions, sheet()[0], atol=6e-5)
    assert np.array_equal(file.corner_vertex.reshape(-1, 3), sheet()[1])
    assert "1 face names a vertex" in file.warnings[0]
    assert file.loose_edges.tolist() == [[0, 1], [1, 2]]
    assert file.weights("second").sum() > file.weights("first").sum() > 0 and file.weights("third") is None


@pytest.mark.parametrize("begin", [b"", b"\xef\xbb\xbf", b"  "])
@pytest.mark.parametrize("newline", [b"\n", b"\r\n", b"\r"])
def test_obj_line_ends_and_beginnings(tmp_path, begin, newline):
    content = begin + newline.join([b"v 0 0 0", b"v 1 0 0", b"v 0 1 0", b"f 1 2 3"])
    (tmp_path / "in.obj").write_bytes(content)
    file = open_file(tmp_path / "in.obj")
    assert file.positions.tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0]] and file.n_faces == 1
    moved = file.positions.copy()
    moved[1, 0] += 0.5
    after = file.patched(moved)
    assert after == content.replace(b"v 1 0 0", b"v 1.50000000 0.00000000 0.00000000")


@pytest.mark.parametrize("make", [full_stl_text, full_stl_binary])
def test_stl(command, tmp_path, make):
    source = tmp_path / "in.stl"
    source.write_bytes(make())
    before, after = run(command, source, tmp_path / "out.stl")
    file, moved = open_file(source), open_file(tmp_path / "out.stl")
    assert len(file.positions) == len(sheet()[0]) == len(moved.positions)
    assert np.array_equal(file.corner_vertex, moved.corner_vertex)
    if make is full_stl_binary:
        from framelet.operators.files.stl import TRIANGLE

        old, new = (np.frombuffer(each, TRIANGLE, offset=84) for each in (before, after))
        assert before[:84] == after[:84] and np.array_equal(old["attribute"], new["attribute"])
        normals, corners = new["normal"], new["corners"].astype(float)
    else:
        keep = re.compile(rb"^(\s*(?:vertex|facet\s+normal))\s.*$", re.IGNORECASE | re.MULTILINE)
        assert keep.sub(rb"\1", before) == keep.sub(rb"\1", after)
        numbers = re.findall(rb"(?i)normal +(\S+) (\S+) (\S+)\s+outer", after)
        normals = np.array(numbers, float)
        rows = re.findall(rb"(?i)vertex +(\S+) (\S+) (\S+)\s", after)
        corners = np.array(rows, float).reshape(-1, 3, 3)
    expected = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    expected /= np.linalg.norm(expected, axis=1, keepdims=True)
    without = np.flatnonzero((normals == 0).all(axis=1))
    assert without.tolist() == [4] if make is full_stl_binary else len(without) == 2
    given = np.delete(np.arange(len(normals)), without)
    np.testing.assert_allclose(normals[given], expected[given], atol=1e-4)


def gltf_values(data, folder):
    """Return the JSON content, and the values of all accessors as float arrays, by plain means."""
    if data[:4] == b"glTF":
        size = struct.unpack_from("<I", data, 12)[0]
        content = json.loads(data[20 : 20 + size])
        buffer = data[28 + size :]
    else:
        content = json.loads(data)
        uri = content["buffers"][0]["uri"]
        if uri.startswith("data:"):
            import base64

            buffer = base64.b64decode(uri.split(",")[1])
        else:
            buffer = (folder / uri.replace("%20", " ")).read_bytes()
    kinds = {5121: "u1", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
    widths = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}

    def read(view, kind, count, width):
        view = content["bufferViews"][view]
        step = view.get("byteStride", np.dtype(kind).itemsize * width)
        rows = [np.frombuffer(buffer, kind, width, view["byteOffset"] + k * step) for k in range(count)]
        return np.array(rows)

    values = []
    for accessor in content["accessors"]:
        kind, width = kinds[accessor["componentType"]], widths[accessor["type"]]
        found = read(accessor["bufferView"], kind, accessor["count"], width)
        if "sparse" in accessor:
            sparse = accessor["sparse"]
            numbers = read(sparse["indices"]["bufferView"], "u1", sparse["count"], 1).ravel()
            found[numbers] = read(sparse["values"]["bufferView"], kind, sparse["count"], width)
        values.append(found)
    return content, values


@pytest.mark.parametrize("kind", ["glb", "embedded", "separate"])
def test_gltf(command, tmp_path, kind):
    data, buffer = full_gltf(kind)
    source = tmp_path / f"in.{'glb' if kind == 'glb' else 'gltf'}"
    source.write_bytes(data)
    (tmp_path / "sheet data.bin").write_bytes(buffer)
    target = tmp_path / f"out{source.suffix}"
    before, after = run(command, source, target)
    (old, old_values), (new, new_values) = (gltf_values(each, tmp_path) for each in (before, after))
    if kind == "separate":
        assert new["buffers"][0]["uri"] == "out.bin"
        assert (tmp_path / "sheet data.bin").read_bytes() == buffer
        new["buffers"][0]["uri"] = old["buffers"][0]["uri"]
    primitives = new["meshes"][0]["primitives"]
    positions = [each["attributes"]["POSITION"] for each in primitives[:2]]
    shading = [each["attributes"][name] for each in primitives[:2] for name in ("NORMAL", "TANGENT")
               if name in each["attributes"]]  # fmt: skip
    for number in range(len(old_values)):
        if number in positions:
            low, high = new_values[number].min(axis=0), new_values[number].max(axis=0)
            assert new["accessors"][number]["min"] == low.tolist()
            assert new["accessors"][number]["max"] == high.tolist()
            assert np.abs(new_values[number] - old_values[number]).max() < 1
            old["accessors"][number] |= {"min": low.tolist(), "max": high.tolist()}
        elif number not in shading:
            assert number in (4, 5) or np.array_equal(old_values[number], new_values[number]), number
    if kind == "embedded":
        new["buffers"][0]["uri"] = old["buffers"][0]["uri"]
    assert old == new
    # The seam between the primitives is closed, and one with the mesh that was not split.
    points, faces = sheet()
    single = points.astype(np.float32)
    expected = denoise(SurfaceMesh.from_faces(single, faces), PRESETS["TRI_2"].settings).vertices
    used = np.unique(faces[len(faces) // 2 :])
    in_first = np.unique(faces[: len(faces) // 2])
    np.testing.assert_allclose(new_values[positions[0]][in_first], expected[in_first], atol=1e-5)
    np.testing.assert_allclose(new_values[positions[1]], expected[used], atol=1e-5)
    both = np.intersect1d(used, in_first)
    number = np.searchsorted(used, both)
    assert np.array_equal(new_values[positions[0]][both], new_values[positions[1]][number])
    # Normals are those of the new surface, also across the seam; tangents lie in its planes.
    areas = np.cross(
        expected[faces[:, 1]] - expected[faces[:, 0]], expected[faces[:, 2]] - expected[faces[:, 0]]
    )
    normals = np.zeros_like(expected)
    for column in faces.T:
        np.add.at(normals, column, areas)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    np.testing.assert_allclose(new_values[shading[0]][in_first], normals[in_first], atol=1e-3)
    np.testing.assert_allclose(new_values[shading[1]], normals[used], atol=1e-3)
    tangents = new_values[shading[2]]
    assert np.abs(np.einsum("ni,ni->n", tangents[:, :3], normals[used])).max() < 1e-3
    assert (tangents[:, 3] == -1).all()


def test_glb_bytes_outside(command, tmp_path):
    """Not only values: padding between vertices, unknown chunks and the JSON text are the same bytes."""
    data, _buffer = full_gltf("glb", sparse=False)
    (tmp_path / "in.glb").write_bytes(data)
    before, after = run(command, tmp_path / "in.glb", tmp_path / "out.glb")
    sizes = [struct.unpack_from("<I", each, 12)[0] for each in (before, after)]
    bounds = re.compile(r'"(min|max)": ?\[[^]]*\]')
    texts = [each[20 : 20 + size].decode() for each, size in zip((before, after), sizes, strict=True)]
    assert bounds.sub("", texts[0]).rstrip() == bounds.sub("", texts[1]).rstrip()
    rest = [
        np.frombuffer(each[20 + size :], np.uint8) for each, size in zip((before, after), sizes, strict=True)
    ]
    assert len(rest[0]) == len(rest[1])
    changed = np.flatnonzero(rest[0] != rest[1]) - 8
    content, _values = gltf_values(before, tmp_path)
    allowed = np.zeros(len(rest[0]), bool)
    for number in (0, 1, 3, 4, 5):  # positions, normals and tangents
        view = content["bufferViews"][content["accessors"][number]["bufferView"]]
        step = view.get("byteStride", 12 if number < 5 else 16)
        begin = view["byteOffset"] + np.arange(content["accessors"][number]["count"])[:, None] * step
        allowed[begin + np.arange(12)] = True
    assert allowed[changed].all() and len(changed) > 1000


def test_compressed_gltf_is_refused_with_a_way_out(fails, tmp_path):
    for name in ("KHR_draco_mesh_compression", "EXT_meshopt_compression"):
        data, _buffer = full_gltf("embedded")
        content = json.loads(data)
        if "draco" in name:
            content["meshes"][0]["primitives"][0]["extensions"] = {name: {}}
        else:
            content["bufferViews"][0]["extensions"] = {name: {}}
        (tmp_path / "in.gltf").write_text(json.dumps(content))
        sentence = fails("denoise", tmp_path / "in.gltf", tmp_path / "out.gltf")
        assert "compressed with" in sentence and "without compression" in sentence
        assert not (tmp_path / "out.gltf").exists()


def test_quantized_gltf_is_rounded_and_says_so(command, tmp_path):
    points, faces = sheet()
    low, size = points.min(), np.ptp(points)
    whole = np.rint((points - low) / size * 65535).astype("<u2")
    padded = np.zeros((len(points), 4), "<u2")
    padded[:, :3] = whole
    corners = faces.astype("<u2").ravel()
    buffer = padded.tobytes() + corners.tobytes()
    content = {
        "asset": {"version": "2.0"},
        "extensionsRequired": ["KHR_mesh_quantization"],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5123, "normalized": True, "count": len(points), "type": "VEC3",
             "min": whole.min(0).tolist(), "max": whole.max(0).tolist()},
            {"bufferView": 1, "componentType": 5123, "count": len(corners), "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": padded.nbytes, "byteStride": 8},
            {"buffer": 0, "byteOffset": padded.nbytes, "byteLength": corners.nbytes},
        ],
        "buffers": [{"byteLength": len(buffer), "uri": "in.bin"}],
    }  # fmt: skip
    (tmp_path / "in.bin").write_bytes(buffer)
    (tmp_path / "in.gltf").write_text(json.dumps(content))
    result = command("denoise", tmp_path / "in.gltf", tmp_path / "out.gltf", *POSITIONS)
    assert result.code == 0 and "rounded" in result.err
    new = json.loads((tmp_path / "out.gltf").read_text())
    found = np.frombuffer((tmp_path / "out.bin").read_bytes(), "<u2", padded.size).reshape(-1, 4)
    assert new["accessors"][0]["max"] == found[:, :3].max(0).tolist()
    noisy = (whole / 65535).astype(np.float32)
    expected = denoise(SurfaceMesh.from_faces(noisy, faces), PRESETS["TRI_2"].settings).vertices
    np.testing.assert_allclose(found[:, :3] / 65535, expected, atol=1.01 / 65535)


def test_all_at_one_place(fails, tmp_path):
    (tmp_path / "in.obj").write_bytes(b"v 1 1 1\n" * 3 + b"f 1 2 3\n")
    sentence = fails("denoise", tmp_path / "in.obj", tmp_path / "out.obj", *POSITIONS)
    assert "at the same place" in sentence and "distance" not in sentence


def test_strength_zero_changes_no_byte(command, tmp_path):
    contents = {
        "a.ply": full_ply("ascii")[0],
        "b.ply": full_ply("binary_big_endian", "double")[0],
        "c.obj": full_obj(),
        "d.stl": full_stl_text(),
        "e.stl": full_stl_binary(),
        "f.glb": full_gltf("glb")[0],
    }
    for name, content in contents.items():
        (tmp_path / name).write_bytes(content)
        result = command("denoise", tmp_path / name, tmp_path / f"out-{name}", "--strength", "0")
        assert result.code == 0, result.err
        assert (tmp_path / f"out-{name}").read_bytes() == content, name


def test_split_seams_move_together_in_all_formats(command, tmp_path):
    points, faces = sheet()
    corners = points[faces].reshape(-1, 3)
    lines = ["v " + " ".join(map(str, corner)) for corner in corners]
    lines += [f"f {3 * k + 1} {3 * k + 2} {3 * k + 3}" for k in range(len(faces))]
    (tmp_path / "soup.obj").write_text("\n".join(lines))
    result = command("denoise", tmp_path / "soup.obj", tmp_path / "out.obj", *POSITIONS)
    assert "vertices welded" in result.out
    after = open_file(tmp_path / "out.obj").positions
    expected = denoise(
        SurfaceMesh.from_faces(corners, np.arange(len(corners)).reshape(-1, 3)),
        PRESETS["TRI_2"].settings,
        region=Region(weld_distance=0.0),
    ).vertices
    np.testing.assert_allclose(after, expected, atol=1e-6)
    assert len(np.unique(after, axis=0)) == len(points)


@pytest.mark.parametrize("kind", ["ply", "obj", "stl", "glb"])
@pytest.mark.parametrize("source", ["in.ply", "in.obj", "in.stl", "in.glb"])
def test_conversions(command, tmp_path, source, kind):
    content = {
        "in.ply": full_ply("binary_little_endian", "double")[0],
        "in.obj": full_obj(),
        "in.stl": full_stl_binary(),
        "in.glb": full_gltf("glb")[0],
    }[source]
    (tmp_path / source).write_bytes(content)
    if source.endswith(kind):
        return
    target = tmp_path / f"out.{kind}"
    result = command("denoise", tmp_path / source, target, "--strength", "0")
    assert result.code == 0, result.err
    assert f"made of a .{source[3:]} file holds positions and faces only; left out: " in result.err
    lost = {"in.ply": "class_id", "in.obj": "materials", "in.stl": "attributes", "in.glb": "skins"}[source]
    assert lost in result.err
    before, after = open_file(tmp_path / source), open_file(target)
    offset = [1, 2, 3] if source == "in.glb" else [0, 0, 0]  # where its node is
    low, high = before.positions.min(axis=0) + offset, before.positions.max(axis=0) + offset
    np.testing.assert_allclose(after.positions.min(axis=0), low, rtol=1e-6, atol=1e-6)
    np.testing.assert_allclose(after.positions.max(axis=0), high, rtol=1e-6, atol=1e-6)
    if kind in ("ply", "obj"):
        assert after.n_faces == before.n_faces
        assert np.array_equal(np.diff(after.face_offset), np.diff(before.face_offset))


def test_gltf_cannot_be_made_of_others(fails, tmp_path):
    (tmp_path / "in.obj").write_bytes(full_obj())
    sentence = fails("denoise", tmp_path / "in.obj", tmp_path / "out.gltf", code=2)
    assert "write .glb" in sentence


CUT_TEXT = (
    b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    b"element face 2\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n"
)
CUT_BINARY = CUT_TEXT.partition(b"0 0 0")[0].replace(b"ascii", b"binary_little_endian") + struct.pack(
    "<9fB3iB3i", *[0, 0, 0, 1, 0, 0, 0, 1, 0], 3, 0, 1, 2, 3, 0, 2, 1
)
MIXED_TYPES = CUT_TEXT.replace(b"float z", b"int z") + b"3 0 1 2\n3 0 2 1\n"


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("a.ply", b"plx\n", "does not begin with"),
        ("a.ply", b"ply\nformat ascii 1.0\n", "has no end"),
        ("a.ply", b"ply\nformat ascii 1.0\nelement vertex \nend_header\n", "cannot be understood"),
        (
            "a.ply",
            b"ply\nformat ascii 1.0\nelement vertex 9999999999\nproperty float x\nend_header\n0\n",
            "but only",
        ),
        ("a.ply", full_ply("binary_little_endian")[0][:-2000], "cut off"),
        ("a.ply", full_ply("ascii")[0][:-200], "cut off"),
        ("a.ply", CUT_TEXT + b"3 0 1 2\n", "The file ends within"),
        ("a.ply", CUT_TEXT + b"3 0 1 2\n3 0 1", "The file ends within"),
        ("a.ply", CUT_TEXT + b"3 0 1 2\n-3 0 1 2\n", "A list has a negative number of values"),
        ("a.ply", CUT_TEXT + b"3 0 1 2\n3 0 1 1e300\n", "no whole number"),
        ("a.ply", b"ply\nformat ascii 1.0\nelement face 0\nend_header\n", "no vertices with the coordinates"),
        (
            "a.ply",
            CUT_TEXT.replace(b"float y", b"float why") + b"3 0 1 2\n3 0 2 1\n",
            "The vertices have no coordinates x, y and z",
        ),
        ("a.ply", MIXED_TYPES, "some are not; they need one type"),
        ("a.ply", CUT_BINARY[:-2], "cut off"),
        ("a.ply", CUT_BINARY[:-13], "cut off"),
        (
            "a.ply",
            CUT_BINARY.replace(b"uchar int", b"char int").replace(b"\x03\0", b"\xfd\0", 1),
            "A list has -3 values",
        ),
        ("a.obj", b"v 0 0 zero\n", "stands where a number should be"),
        ("a.obj", b"v 0 0\n", "less than three coordinates"),
        ("a.stl", full_stl_binary()[:-1], "has room for"),
        ("a.stl", b"solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n", "which are no triangles"),
        ("a.stl", b"solid\nendsolid\n".ljust(200), "No triangle could be read"),
        ("a.glb", full_gltf("glb")[0][:-1], "cut off"),
        ("a.gltf", full_gltf("separate")[0], "does not exist"),
        ("a.gltf", b"{}", "no ‘asset’"),
        ("a.gltf", b'{"asset": {"version": "1.0"}}', "only version 2"),
    ],
)
def test_damaged_files(tmp_path, name, content, message):
    (tmp_path / name).write_bytes(content)
    with pytest.raises(FileError, match=re.escape(message)) as caught:
        open_file(tmp_path / name)
    assert str(caught.value).count("\n") == 0 and str(tmp_path / name) in str(caught.value)


BITS = {
    "a signaling NaN": (0x7FA00000, 0x7FF4000000000000),
    "infinity": (0x7F800000, 0x7FF0000000000000),
    "the largest number": (0x7F7FFFFF, 0x7FEFFFFFFFFFFFFF),
}
BINARY = {
    "a.ply": ("<f4", lambda: full_ply("binary_little_endian")[0]),
    "b.ply": (">f4", lambda: full_ply("binary_big_endian")[0]),
    "c.ply": (">f8", lambda: full_ply("binary_big_endian", "double")[0]),
    "a.stl": ("<f4", full_stl_binary),
    "a.glb": ("<f4", lambda: full_gltf("glb", sparse=False)[0]),
}


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("bits", BITS)
@pytest.mark.parametrize("name", BINARY)
def test_coordinates_that_are_no_lengths_are_refused_without_a_warning(fails, tmp_path, name, bits):
    kind, make = BINARY[name]
    content, number = make(), np.array(BITS[bits][kind == ">f8"], kind.replace("f", "u"))
    before = np.array(sheet()[0][7, 1], kind).tobytes()
    assert before in content
    (tmp_path / name).write_bytes(content.replace(before, number.tobytes()))
    said = fails("denoise", tmp_path / name, tmp_path / f"out-{name}")
    assert re.search("not a finite|not finite|scale it down", said), said


@pytest.mark.filterwarnings("error")
def test_normals_of_no_direction_are_renewed_without_a_warning(command, tmp_path):
    points, faces = sheet()
    normals = normals_of(points, faces)
    normals[7, 1] = 0.3125
    content = with_normals(points, faces, normals, "binary_little_endian")
    before = np.float32(0.3125).tobytes()
    assert content.count(before) == 1
    (tmp_path / "a.ply").write_bytes(content.replace(before, np.uint32(0x7FA00000).tobytes()))
    assert command("denoise", tmp_path / "a.ply", tmp_path / "b.ply", "--preset", "tri-2").code == 0


def test_numbers_with_exponents_keep_their_digits(command, tmp_path):
    """No more are written than make a difference, and none are lost."""
    points, faces = sheet()
    for form, decimals, least, most in (("%.3e", 9, 8, 12), ("%.11e", 9, 12, 16), ("%.11e", 1, 12, 16)):
        scaled = np.char.mod(form, points.round(decimals) * 1e9)
        lines = ["v " + " ".join(row) for row in scaled] + [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in faces]
        (tmp_path / "in.obj").write_text("\n".join(lines))
        assert command("denoise", tmp_path / "in.obj", tmp_path / "out.obj", *POSITIONS).code == 0
        new = [
            line.split()[1:] for line in (tmp_path / "out.obj").read_text().splitlines() if line[:2] == "v "
        ]
        words = [
            word for row, old in zip(new, scaled.tolist(), strict=True) for word in row if word not in old
        ]
        mantissas = [re.sub(r"\D", "", word.partition("e")[0]).strip("0") for word in words]
        assert least <= max(map(len, mantissas)) <= most, (form, max(map(len, mantissas)))
        assert any("e+" in word for word in words) == (form == "%.3e")
        (tmp_path / "out.obj").unlink()


@pytest.mark.parametrize("order", ORDERS)
def test_coordinates_behind_lists_of_different_lengths(tmp_path, order):
    """Where such elements begin is known only from the one before."""
    points, faces = sheet()
    head = f"ply\nformat {order} 1.0\nelement vertex {len(points)}\nproperty list uchar short tags\n"
    head += "property float x\nproperty float y\nproperty float z\nproperty uchar flag\n"
    head += f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    sign, body = ("<" if "little" in order else ">"), b""
    for number, point in enumerate(points.astype(np.float32)):
        tags = list(range(number % 4))
        if order == "ascii":
            body += (" ".join(map(repr, [len(tags), *tags, *point.tolist(), 7])) + "\n").encode()
        else:
            body += struct.pack(f"{sign}B{len(tags)}h3fB", len(tags), *tags, *point, 7)
    for face in faces.tolist():
        body += (
            f"3 {face[0]} {face[1]} {face[2]}\n".encode()
            if order == "ascii"
            else struct.pack(f"{sign}B3i", 3, *face)
        )
    (tmp_path / "a.ply").write_bytes(head.encode() + body)
    file = open_file(tmp_path / "a.ply")
    np.testing.assert_array_equal(file.positions, points.astype(np.float32))
    moved = (points + 0.25).astype(np.float32)
    (tmp_path / "b.ply").write_bytes(file.patched(moved))
    after = open_file(tmp_path / "b.ply")
    np.testing.assert_allclose(after.positions, moved, atol=1e-6)
    np.testing.assert_array_equal(after.corner_vertex, faces.ravel())


@pytest.mark.filterwarnings("error")
def test_normals_between_faces_that_look_against_each_other_stay(tmp_path):
    """Their mean has no direction."""
    points, faces = sheet()
    apart = np.array([[50.0, 0, 0], [51, 0, 0], [50, 1, 0]])
    n = len(points)
    all_points = np.concatenate((points, apart))
    all_faces = np.concatenate((faces, [[n, n + 1, n + 2], [n, n + 2, n + 1]]))
    normals = np.concatenate((normals_of(points, faces), [[0.6, 0, 0.8]] * 3))
    (tmp_path / "a.ply").write_bytes(with_normals(all_points, all_faces, normals, "binary_little_endian"))
    file = open_file(tmp_path / "a.ply")
    (tmp_path / "b.ply").write_bytes(file.patched(file.positions + [[0, 0, 0.5]] * np.ones((n + 3, 1))))
    rows = np.frombuffer(
        (tmp_path / "b.ply").read_bytes().partition(b"end_header\n")[2], "<f4", 6 * (n + 3)
    ).reshape(-1, 6)
    np.testing.assert_allclose(rows[n:, [1, 3, 5]], [[0.6, 0, 0.8]] * 3, atol=1e-6)


FACES = b"3 0 1 2\n3 0 2 1\n"
EDGES = b"element edge 1\nproperty int from\nproperty int to\nend_header"
STRIP = b"element tristrips 1\nproperty list uchar int vertex_indices\nend_header\n"


@pytest.mark.parametrize(
    ("name", "content", "n_vertices", "n_faces"),
    [
        ("a.ply", CUT_TEXT.replace(b"end_header", EDGES) + FACES + b"0 1\n", 3, 2),
        ("a.ply", CUT_TEXT.partition(b"element face")[0] + STRIP + b"0 0 0\n1 0 0\n0 1 0\n2 0 1\n", 3, 0),
        ("a.ply", CUT_TEXT.partition(b"element face")[0] + STRIP + b"0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", 3, 1),
        ("a.ply", CUT_BINARY.replace(b"face 2", b"face 0"), 3, 0),
        ("a.ply", CUT_BINARY.replace(b"vertex 3", b"vertex 0").replace(b"face 2", b"face 0"), 0, 0),
        ("a.obj", b"v 0 0 0 # first\nv 1_0 0 0\nv 0 1 0\nf 1/1 2/2 -1/3 # a triangle\n", 3, 1),
        ("a.obj", b"o A\nv 0 0 0\nv 1 0 0\no B\nv 0 1 0\n", 3, 0),
        ("a.obj", b"o A\nv 0 0 0\nv 1 0 0\nv 0 1 0\no B\nf 1 2 3\no C\nf 3 2 1\n", 3, 2),
    ],
)
def test_files_that_are_odd_but_whole_are_read(tmp_path, name, content, n_vertices, n_faces):
    (tmp_path / name).write_bytes(content)
    file = open_file(tmp_path / name)
    assert (len(file.positions), file.n_faces) == (n_vertices, n_faces)
    assert file.patched(file.positions) == content
    parts = file.parts()
    assert sorted(np.concatenate([part.faces for part in parts]).tolist()) == list(range(n_faces))


def test_a_face_of_vertex_0_is_told_and_left_out(command, tmp_path):
    """Numbers of vertices begin at 1."""
    content = full_obj() + b"f 0 1 2\n"
    (tmp_path / "a.obj").write_bytes(content)
    result = command("denoise", tmp_path / "a.obj", tmp_path / "b.obj", *POSITIONS)
    assert result.code == 0 and "1 face names a vertex that does not exist" in result.err
    assert open_file(tmp_path / "a.obj").warnings
    assert (tmp_path / "b.obj").read_bytes().endswith(b"f 0 1 2\n")
