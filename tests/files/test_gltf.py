# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""A glTF with everything that it allows: denoised, and all that is no coordinate is as it was."""

import json
import re
import struct

import numpy as np
import pytest
from framelet.core import PRESETS, SurfaceMesh, denoise

from .made import POSITIONS, denoised, full_gltf, full_obj, sheet


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
    before, after = denoised(command, source, target)
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
    before, after = denoised(command, tmp_path / "in.glb", tmp_path / "out.glb")
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


def test_gltf_cannot_be_made_of_others(fails, tmp_path):
    (tmp_path / "in.obj").write_bytes(full_obj())
    sentence = fails("denoise", tmp_path / "in.obj", tmp_path / "out.gltf", code=2)
    assert "write .glb" in sentence
