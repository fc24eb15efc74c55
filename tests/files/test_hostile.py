# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that say what is not so: counts, lengths and places, one lie at a time."""

import json
import re
import struct
import tracemalloc

import numpy as np
import pytest
from framelet.operators.files import FileError, open_file
from framelet.operators.files.gltf_container import as_binary
from framelet.operators.files.stl import HEAD, TRIANGLE

from .made import full_stl_text, sheet

QUICK = ("--preset", "tri-2")


def stl(n=4, head=b"triangles", count=None, behind=b""):
    """Return a binary STL file with n triangles, whose header speaks of `count`."""
    points, faces = sheet()
    rows = np.zeros(n, TRIANGLE)
    rows["corners"] = points[faces[:n]]
    number = struct.pack("<I", n if count is None else count)
    return head.ljust(HEAD - 4) + number + rows.tobytes() + behind


def with_nan(content, at):
    return content[:at] + struct.pack("<f", np.nan) + content[at + 4 :]


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(
    ("content", "message"),
    [
        (stl(4, count=5), "speaks of 5 triangles, but the file has room for 4; it was cut off"),
        (stl(4, b"solid", count=5), "speaks of 5 triangles, but the file has room for 4; it was cut off"),
        (stl(4, count=2**32 - 1), "speaks of 4,294,967,295 triangles"),
        (
            stl(4, count=0),
            "speaks of 0 triangles, but the file has room for 4; it was not written to its end",
        ),
        (stl()[: HEAD - 1], "begins neither with"),
        (b"solid", "No triangle"),
        (
            full_stl_text().replace(b"endloop", b"vertex 1 2 3\r\nendloop", 1),
            "no triangles",
        ),
        (b"solid\nfacet normal 0 0 1\nouter loop\nendloop\nendfacet\nendsolid\n", "no triangles"),
    ],
)
def test_stl_that_lies_is_refused(fails, tmp_path, content, message):
    (tmp_path / "a.stl").write_bytes(content)
    assert message in fails("denoise", tmp_path / "a.stl", tmp_path / "b.stl", *QUICK)
    assert not (tmp_path / "b.stl").exists()


@pytest.mark.parametrize("content", [stl(0), stl(0, b"solid"), with_nan(stl(), HEAD + 12)])
def test_stl_without_a_surface_is_refused(fails, tmp_path, content):
    (tmp_path / "a.stl").write_bytes(content)
    assert re.search(
        "has no faces|not a finite", fails("denoise", tmp_path / "a.stl", tmp_path / "b.stl", *QUICK)
    )
    assert not (tmp_path / "b.stl").exists()


@pytest.mark.parametrize("head", [b"solid", b"  SOLID facet normal 0 0 1"])
@pytest.mark.parametrize("behind", [b"", b"\r\n"])
def test_a_binary_stl_that_begins_like_text(command, tmp_path, head, behind):
    content = stl(9, head, behind=behind)
    (tmp_path / "a.stl").write_bytes(content)
    result = command("denoise", tmp_path / "a.stl", tmp_path / "b.stl", *QUICK)
    assert result.code == 0 and "room" not in result.err
    after = (tmp_path / "b.stl").read_bytes()
    assert len(after) == len(content) and after[:HEAD] == content[:HEAD] and after.endswith(behind)
    assert open_file(tmp_path / "b.stl").n_faces == 9


def test_triangles_behind_those_of_the_header_are_told_and_stay(command, tmp_path):
    content = stl(9, count=7)
    (tmp_path / "a.stl").write_bytes(content)
    result = command("denoise", tmp_path / "a.stl", tmp_path / "b.stl", *QUICK)
    assert result.code == 0 and "speaks of 7 triangles, but the file has room for 9" in result.err
    assert (tmp_path / "b.stl").read_bytes()[-2 * TRIANGLE.itemsize :] == content[-2 * TRIANGLE.itemsize :]


def test_a_text_stl_with_a_byte_order_mark(command, tmp_path):
    content = b"\xef\xbb\xbf" + full_stl_text()
    (tmp_path / "a.stl").write_bytes(content)
    assert command("denoise", tmp_path / "a.stl", tmp_path / "b.stl", *QUICK).code == 0
    after = (tmp_path / "b.stl").read_bytes()
    assert after.startswith(content[:8]) and after != content
    assert open_file(tmp_path / "b.stl").n_faces == open_file(tmp_path / "a.stl").n_faces


def gltf(*changes, chunk=None):
    """Return a GLB file with one sheet, and with other values at some places of its JSON text.

    Parameters
    ----------
    *changes : tuple of path and value
        The path as a string, as "accessors.0.count".
    """
    points, faces = sheet()
    data = points.astype("<f4").tobytes() + faces.astype("<u4").tobytes()
    n, size = len(points), 12 * len(points)
    content = {
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "translation": [0, 0, 1]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": n, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5125, "count": faces.size, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": size},
            {"buffer": 0, "byteOffset": size, "byteLength": len(data) - size},
        ],
        "buffers": [{"byteLength": len(data)}],
    }
    for path, value in changes:
        *above, last = (int(key) if key.isdigit() else key for key in path.split("."))
        inner = content
        for key in above:
            inner = inner[key]
        inner[last] = value
    return as_binary(json.dumps(content).encode(), data if chunk is None else chunk)


def sparse(count, numbers=0, values=0):
    return {
        "count": count,
        "indices": {"bufferView": numbers, "componentType": 5125},
        "values": {"bufferView": values},
    }


N = len(sheet()[0])
NO_COUNTS = [-1, 2**62, 1.5, np.inf, None, True, "4", [4]]
COUNTS = [
    "accessors.0.count",
    "accessors.1.count",
    "accessors.0.bufferView",
    "bufferViews.0.buffer",
    "bufferViews.0.byteLength",
    "bufferViews.0.byteOffset",
    "bufferViews.0.byteStride",
    "buffers.0.byteLength",
    "meshes.0.primitives.0.indices",
    "meshes.0.primitives.0.attributes.POSITION",
]


@pytest.mark.parametrize("path", COUNTS)
def test_glb_with_what_is_no_count_is_refused(tmp_path, path):
    for value in NO_COUNTS:
        (tmp_path / "a.glb").write_bytes(gltf((path, value)))
        with pytest.raises(FileError) as caught:
            open_file(tmp_path / "a.glb")
        assert "stands where a number of elements should be" in str(caught.value), value


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ([("accessors.0.count", N + 1)], "ends behind its view"),
        ([("accessors.0.byteOffset", 4)], "ends behind its view"),
        ([("bufferViews.0.byteStride", 16)], "ends behind its view"),
        ([("bufferViews.0.byteStride", 8)], "ends behind its view"),
        ([("bufferViews.1.byteLength", 2**30)], "ends behind its buffer"),
        ([("bufferViews.1.byteOffset", 12 * N + 4)], "ends behind its buffer"),
        ([("buffers.0.byteLength", 2**30)], "it was cut off"),
        ([("accessors.0.type", "VEC2")], "not three coordinates"),
        ([("accessors.1.componentType", 5126)], "no whole numbers"),
        ([("accessors.1.componentType", 1)], "damaged"),
        ([("accessors.1.bufferView", 7)], "damaged"),
        ([("accessors.0.sparse", sparse(N, 1))], "not in order"),
        ([("accessors.0.sparse", sparse(10**6, 1))], "ends behind its view"),
        ([("accessors.0.sparse", sparse(-1, 1))], "number of elements"),
        ([("accessors.0.sparse", {"count": 1})], "damaged"),
        ([("meshes.0.primitives", 5)], "damaged"),
    ],
)
def test_glb_that_lies_is_refused(fails, tmp_path, changes, message):
    (tmp_path / "a.glb").write_bytes(gltf(*changes))
    assert message in fails("denoise", tmp_path / "a.glb", tmp_path / "b.glb", *QUICK)
    assert not (tmp_path / "b.glb").exists()


@pytest.mark.parametrize(
    ("at", "number", "message"),
    [
        (8, 2**32 - 1, "header speaks of 4,294,967,295 bytes"),
        (8, 12, "damaged"),
        (12, 2**32 - 1, "A chunk is longer than the file"),
        (12, 0, "damaged"),
        (16, 7, "first chunk of the file is not JSON"),
        (4, 1, "glTF version 1"),
    ],
)
def test_chunks_that_lie_are_refused(fails, tmp_path, at, number, message):
    content = bytearray(gltf())
    struct.pack_into("<I", content, at, number)
    (tmp_path / "a.glb").write_bytes(content)
    assert message in fails("denoise", tmp_path / "a.glb", tmp_path / "b.glb", *QUICK)
    (tmp_path / "a.glb").write_bytes(content[:15])
    assert "ends within its header" in fails("denoise", tmp_path / "a.glb", tmp_path / "b.glb", *QUICK)


@pytest.mark.parametrize(("offset", "is_refused"), [(0, True), (12 * 300 - 1, True), (12 * 300, False)])
def test_indices_where_coordinates_are_written_are_refused(tmp_path, offset, is_refused):
    """Faces would be others when vertices moved."""
    chunk = np.random.default_rng(0).random((300, 3)).astype("<f4").tobytes() + bytes(range(60))
    content = gltf(
        ("accessors.0.count", 300),
        ("accessors.1", {"bufferView": 1, "componentType": 5121, "count": 60, "type": "SCALAR"}),
        ("bufferViews.0.byteLength", 12 * 300),
        ("bufferViews.1", {"buffer": 0, "byteOffset": offset, "byteLength": 60}),
        ("buffers.0.byteLength", len(chunk)),
        chunk=chunk,
    )
    (tmp_path / "a.glb").write_bytes(content)
    if is_refused:
        with pytest.raises(FileError, match="share bytes"):
            open_file(tmp_path / "a.glb")
    else:
        assert open_file(tmp_path / "a.glb").n_faces == 20


@pytest.mark.parametrize("n", [0, 1])
def test_sparse_values_of_few_elements(tmp_path, n):
    """Element 0 has no number but 0, which no view holds by chance: the corner that comes first names it."""
    assert sheet()[1][0, 0] == 0
    (tmp_path / "a.glb").write_bytes(gltf(("accessors.0.sparse", sparse(n, 1))))
    file = open_file(tmp_path / "a.glb")
    np.testing.assert_array_equal(file.positions, sheet()[0].astype(np.float32))


def test_one_sparse_value_that_differs(tmp_path):
    points, faces = sheet()
    other = np.float32([[7, 8, 9]])
    data = points.astype("<f4").tobytes() + faces.astype("<u4").tobytes()
    chunk = data + np.uint32(5).tobytes() + other.tobytes()
    views = [
        {"buffer": 0, "byteOffset": 0, "byteLength": 12 * N},
        {"buffer": 0, "byteOffset": 12 * N, "byteLength": len(data) - 12 * N},
        {"buffer": 0, "byteOffset": len(data), "byteLength": 4},
        {"buffer": 0, "byteOffset": len(data) + 4, "byteLength": 12},
    ]
    content = gltf(
        ("bufferViews", views),
        ("buffers.0.byteLength", len(chunk)),
        ("accessors.0.sparse", sparse(1, 2, 3)),
        chunk=chunk,
    )
    (tmp_path / "a.glb").write_bytes(content)
    file = open_file(tmp_path / "a.glb")
    assert file.positions[5].tolist() == [7, 8, 9]
    moved = file.positions + np.array([0, 0, 1])
    (tmp_path / "b.glb").write_bytes(file.patched(moved))
    np.testing.assert_allclose(open_file(tmp_path / "b.glb").positions, moved, atol=1e-6)


PRIMITIVE = {"attributes": {"POSITION": 0}, "indices": 1}
ZEROS = {"componentType": 5126, "count": 2**18, "type": "VEC3"}
VIEW = {"bufferView": 0, "componentType": 5121, "count": 12 * N, "type": "VEC3"}


@pytest.mark.parametrize(
    "changes",
    [
        [("accessors.0", {**ZEROS, "count": 2**24})],
        [
            ("accessors", [ZEROS] * 300),
            ("meshes.0.primitives", [{"attributes": {"POSITION": number}} for number in range(300)]),
        ],
        [("meshes.0.primitives", [PRIMITIVE] * 30_000)],
        [
            ("accessors", [{**VIEW, "count": 4 * N}] * 5000),
            ("meshes.0.primitives", [{"attributes": {"POSITION": number}} for number in range(5000)]),
        ],
    ],
)
def test_small_files_do_not_fill_the_memory(tmp_path, changes):
    (tmp_path / "a.glb").write_bytes(gltf(*changes))
    tracemalloc.start()
    try:
        with pytest.raises(FileError, match=r"but holds .* bytes; it is damaged"):
            open_file(tmp_path / "a.glb")
        assert tracemalloc.get_traced_memory()[1] < 150e6
    finally:
        tracemalloc.stop()


def test_primitives_that_share_their_vertices_cost_them_once(command, tmp_path):
    """As programs for construction write them: one list of vertices, and many primitives that use a few."""
    points, faces = sheet()
    n = len(points)
    corners = faces.astype("<u4")
    n_parts = len(faces) // 2
    normals = np.tile(np.float32([0, 0, 1]), (n, 1))
    many = 400  # as many vertices, of which no face speaks
    points = np.concatenate((points, np.tile(points[:1], (many * n, 1))))
    normals = np.concatenate((normals, np.tile(normals[:1], (many * n, 1))))
    chunk = points.astype("<f4").tobytes() + normals.tobytes() + corners.tobytes()
    size = 12 * len(points)
    content = gltf(
        (
            "meshes.0.primitives",
            [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2 + k} for k in range(n_parts)],
        ),
        (
            "accessors",
            [{"bufferView": k, "componentType": 5126, "count": len(points), "type": "VEC3"} for k in range(2)]
            + [
                {"bufferView": 2, "byteOffset": 24 * k, "componentType": 5125, "count": 6, "type": "SCALAR"}
                for k in range(n_parts)
            ],
        ),
        (
            "bufferViews",
            [
                {"buffer": 0, "byteOffset": 0, "byteLength": size},
                {"buffer": 0, "byteOffset": size, "byteLength": size},
                {"buffer": 0, "byteOffset": 2 * size, "byteLength": corners.nbytes},
            ],
        ),
        ("buffers.0.byteLength", len(chunk)),
        chunk=chunk,
    )
    (tmp_path / "a.glb").write_bytes(content)
    tracemalloc.start()
    try:
        file = open_file(tmp_path / "a.glb")
        moved = file.positions.copy()
        moved[:n, 2] += np.random.default_rng(0).normal(0, 0.1, n)
        data = file.patched(moved)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert peak < 60 * len(content), peak / len(content)
    (tmp_path / "b.glb").write_bytes(data)
    after = open_file(tmp_path / "b.glb")
    np.testing.assert_allclose(after.positions, moved, atol=1e-6)
    # A normal is that of all triangles at it, whichever primitive they belong to.
    triangles = moved[faces]
    areas = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    expected = np.zeros((n, 3))
    for column in faces.T:
        np.add.at(expected, column, areas)
    expected /= np.linalg.norm(expected, axis=1, keepdims=True)
    at = len(data) - len(chunk) + size
    found = np.frombuffer(data[at : at + size], "<f4").reshape(-1, 3)
    np.testing.assert_allclose(found[:n], expected, atol=1e-5)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ([("nodes.0.mesh", 1)], "names mesh 1, but there are 1"),
        ([("nodes.0.mesh", -1)], "number of elements"),
        ([("scenes.0.nodes", [5])], "scene of the file is damaged"),
        ([("scenes.0.nodes", [-1])], "number of elements"),
        ([("scenes.0.nodes", [])], "shows none of its meshes"),
        ([("nodes.0.scale", [1e300, 1, 1])], "new file cannot hold; scale the surface down"),
        ([("nodes.0.scale", [1e39, 1, 1])], "go to 1.1e+40, which the float32 numbers"),
        ([("nodes.0.scale", [1e-50] * 3), ("nodes.0.translation", [0, 0, 0])], "scale the surface up"),
        ([("nodes.0.translation", [np.nan, 1, 1])], "not finite"),
        (
            [
                ("nodes", [{"mesh": 0, "translation": [k, 0, 0]} for k in range(4)]),
                ("scenes.0.nodes", [3, 9]),
            ],
            "damaged",
        ),
    ],
)
def test_a_scene_that_lies_is_not_converted(command, fails, tmp_path, changes, message):
    (tmp_path / "a.glb").write_bytes(gltf(*changes))
    for kind in ("ply", "stl", "obj"):
        assert message in fails("denoise", tmp_path / "a.glb", tmp_path / f"b.{kind}", *QUICK)
        assert not (tmp_path / f"b.{kind}").exists()
    # The meshes themselves are as good as any.
    assert command("denoise", tmp_path / "a.glb", tmp_path / "b.glb", *QUICK).code == 0


def test_a_scene_larger_than_the_memory_is_not_converted(fails, tmp_path):
    n_vertices, n_nodes = 600_000, 20_000
    chunk = (
        np.random.default_rng(0).random((n_vertices, 3)).astype("<f4").tobytes()
        + sheet()[1].astype("<u4").tobytes()
    )
    content = gltf(
        ("nodes", [{"mesh": 0}] * n_nodes),
        ("scenes.0.nodes", list(range(n_nodes))),
        ("accessors.0.count", n_vertices),
        ("bufferViews.0.byteLength", 12 * n_vertices),
        ("bufferViews.1.byteOffset", 12 * n_vertices),
        ("buffers.0.byteLength", len(chunk)),
        chunk=chunk,
    )
    (tmp_path / "a.glb").write_bytes(content)
    said = fails("denoise", tmp_path / "a.glb", tmp_path / "b.ply", "--strength", "0")
    assert "shows 12,000,000,000 vertices" in said and not (tmp_path / "b.ply").exists()


@pytest.mark.parametrize(("size", "way"), [(1e60, "down"), (1e-60, "up")])
def test_doubles_that_single_precision_cannot_hold_are_not_converted(command, fails, tmp_path, size, way):
    points, faces = sheet()
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in (points * size).tolist()]
    lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in faces]
    (tmp_path / "a.obj").write_text("\n".join(lines))
    for kind in ("stl", "glb"):
        said = fails("denoise", tmp_path / "a.obj", tmp_path / f"b.{kind}", *QUICK)
        assert f"scale the surface {way} first" in said, said
        assert not (tmp_path / f"b.{kind}").exists()


@pytest.mark.parametrize(
    ("mode", "expected"),
    [
        (5, [[0, 1, 2], [2, 1, 3], [2, 3, 4]]),
        (6, [[0, 1, 2], [0, 2, 3], [0, 3, 4]]),
    ],
)
def test_strips_and_fans_are_triangles(tmp_path, mode, expected):
    """With indices, without, and with too few of them for a triangle."""
    places = [("accessors.1", {"bufferView": 1, "componentType": 5121, "count": 5, "type": "SCALAR"})]
    chunk = (
        sheet()[0].astype("<f4").tobytes()
        + bytes(range(5))
        + bytes(len(sheet()[1].astype("<u4").tobytes()) - 5)
    )
    (tmp_path / "a.glb").write_bytes(gltf(("meshes.0.primitives.0.mode", mode), *places, chunk=chunk))
    assert open_file(tmp_path / "a.glb").corner_vertex.reshape(-1, 3).tolist() == expected
    (tmp_path / "a.glb").write_bytes(
        gltf(
            ("meshes.0.primitives", [{"attributes": {"POSITION": 0}, "mode": mode}]), ("accessors.0.count", 5)
        )
    )
    assert open_file(tmp_path / "a.glb").corner_vertex.reshape(-1, 3).tolist() == expected
    (tmp_path / "a.glb").write_bytes(gltf(("meshes.0.primitives.0.mode", mode), ("accessors.1.count", 2)))
    assert open_file(tmp_path / "a.glb").n_faces == 0


def test_as_many_normals_as_positions(tmp_path):
    attributes = {"POSITION": 0, "NORMAL": 2}
    normals = {"bufferView": 0, "componentType": 5126, "count": N - 1, "type": "VEC3"}
    faces = sheet()[1]
    listed = [
        {"bufferView": 0, "componentType": 5126, "count": N, "type": "VEC3"},
        {"bufferView": 1, "componentType": 5125, "count": faces.size, "type": "SCALAR"},
        normals,
    ]
    content = gltf(("accessors", listed), ("meshes.0.primitives.0.attributes", attributes))
    (tmp_path / "a.glb").write_bytes(content)
    with pytest.raises(FileError, match="not one NORMAL for each position"):
        open_file(tmp_path / "a.glb")


def test_nodes_place_meshes_by_matrices_and_below_each_other(command, tmp_path):
    """A node that is its own child is placed once, and without a scene all meshes are shown as they are."""
    turned = [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1]
    nodes = [{"children": [1], "matrix": turned}, {"mesh": 0, "translation": [0, 0, 2], "children": [0]}]
    points = sheet()[0].astype(np.float32)
    expected = np.stack((5 - points[:, 1], points[:, 0], points[:, 2] + 2), axis=1)
    for changes, places in (([("nodes", nodes)], expected), ([("scenes", [])], points)):
        (tmp_path / "a.glb").write_bytes(gltf(*changes))
        assert command("denoise", tmp_path / "a.glb", tmp_path / "b.ply", "--strength", "0").code == 0
        np.testing.assert_allclose(open_file(tmp_path / "b.ply").positions, places, atol=1e-5)
        (tmp_path / "b.ply").unlink()
