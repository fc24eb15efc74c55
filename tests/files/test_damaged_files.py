# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""What is no mesh is refused with a sentence; what is odd but whole is read."""

import re
import struct

import numpy as np
import pytest
from framelet.operators.files import FileError, open_file

from .made import full_gltf, full_ply, full_stl_binary, sheet

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
