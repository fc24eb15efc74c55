# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""A PLY with everything that it allows: denoised, and all that is no coordinate is as it was."""

import re
import struct

import numpy as np
import pytest
from framelet.core import PRESETS, SurfaceMesh, denoise
from framelet.operators.files import open_file

from .made import ORDERS, POSITIONS, denoised, full_ply, normals_of, sheet, with_normals


@pytest.mark.parametrize("coordinate", ["float", "double"])
@pytest.mark.parametrize("order", ORDERS)
def test_ply(command, tmp_path, order, coordinate):
    data, is_coordinate, n_head = full_ply(order, coordinate)
    source = tmp_path / "in.ply"
    source.write_bytes(data)
    before, after = denoised(command, source, tmp_path / "out.ply")
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
