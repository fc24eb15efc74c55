# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The defects that are reported of a file: their kinds, how many there are, and which come first."""

import numpy as np
import pytest
from framelet.operators.files import gltf, open_file
from framelet.operators.files.defects import defects_of
from framelet.operators.files.surface import surface_of

from .made import full_stl_binary, sheet


def found_in(path):
    return {each["kind"]: (each["count"], each["of"], each["first"]) for each in defects_of(open_file(path))}


def obj(vertices, faces):
    lines = [f"v {x} {y} {z}" for x, y, z in vertices]
    return "\n".join([*lines, *("f " + " ".join(str(v + 1) for v in face) for face in faces)]) + "\n"


CUBE = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
SIDES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
TRIANGLES = [face for a, b, c, d in SIDES for face in ((a, b, c), (a, c, d))]


@pytest.mark.parametrize("faces", [SIDES, TRIANGLES])
def test_a_closed_surface_has_none(tmp_path, faces):
    (tmp_path / "a.obj").write_text(obj(CUBE, faces))
    assert found_in(tmp_path / "a.obj") == {}


@pytest.mark.parametrize("faces", [SIDES, TRIANGLES])
def test_each_kind(tmp_path, faces):
    n, size = len(faces), len(faces[0])
    for change, kind, expected in [
        ([*faces, (*faces[2][1:], faces[2][0])], "double faces", (1, "face", [n])),
        ([*faces, faces[2][::-1]], "double faces", (1, "face", [n])),
        (faces[1:], "open borders", (size, "vertex", sorted(faces[0]))),
        ([faces[0][::-1], *faces[1:]], "neighbors that are turned over", (size, "vertex", sorted(faces[0]))),
        ([*faces, (0, 1, 7)], "edges with more than two faces", None),
        ([*faces, (5, 5, 6)], "degenerate faces", (1, "face", [n])),
    ]:
        (tmp_path / "a.obj").write_text(obj(CUBE, change))
        found = found_in(tmp_path / "a.obj")
        assert kind in found, kind
        if expected is not None:
            assert found == {kind: expected}, kind
    (tmp_path / "a.obj").write_text(obj([*CUBE, (9, 9, 9), (3, 4, 5)], faces))
    assert found_in(tmp_path / "a.obj") == {"loose vertices": (2, "vertex", [8, 9])}


@pytest.mark.parametrize(("height", "is_flat"), [(0.0, True), (1e-13, True), (1e-9, False), (1.0, False)])
def test_faces_without_area(tmp_path, height, is_flat):
    vertices = np.array([(0, 0, 0), (2, 0, 0), (1, height, 0)])
    (tmp_path / "a.obj").write_text(obj(vertices.tolist(), [(0, 1, 2)]))
    assert ("degenerate faces" in found_in(tmp_path / "a.obj")) == is_flat
    # A quad in one line, and one that comes to a point.
    square = np.array([(0, 0, 0), (2, 0, 0), (2, height, 0), (0, height, 0)])
    (tmp_path / "a.obj").write_text(obj(square.tolist(), [(0, 1, 2, 3)]))
    assert ("degenerate faces" in found_in(tmp_path / "a.obj")) == is_flat


def test_what_a_format_splits_is_no_border(tmp_path):
    """A glTF file has vertices for each side of a seam; only the rim of the sheet is a border."""
    points, faces = sheet()
    points = points.astype(np.float32)
    soup, corners = points[faces].reshape(-1, 3), np.arange(faces.size)
    (tmp_path / "a.obj").write_text(obj(points.tolist(), faces.tolist()))
    rim = found_in(tmp_path / "a.obj")["open borders"][0]
    (tmp_path / "a.stl").write_bytes(full_stl_binary())
    (tmp_path / "a.glb").write_bytes(gltf.new_file(soup, np.arange(0, faces.size + 1, 3), corners))
    for name in ("a.stl", "a.glb"):
        assert found_in(tmp_path / name)["open borders"][0] == rim < len(points)
    # In an OBJ file it may be meant.
    (tmp_path / "a.obj").write_text(obj(soup.tolist(), corners.reshape(-1, 3).tolist()))
    assert found_in(tmp_path / "a.obj")["open borders"][0] == len(soup)


def test_loose_edges_go_with_the_part_whose_vertices_they_join(tmp_path):
    lines = [*("v 0 0 0", "v 1 0 0", "v 0 1 0"), *("v 5 0 0", "v 6 0 0", "v 5 1 0", "v 6 6 6")]
    (tmp_path / "a.obj").write_text(
        "\n".join([*lines[:3], "o A", "f 1 2 3", *lines[3:], "o B", "f 4 5 6", "l 4 7"])
    )
    file = open_file(tmp_path / "a.obj")
    _first, second = file.parts()
    surface = surface_of(file, second)
    names = second.vertices[surface.edges]
    assert sorted(map(tuple, np.sort(names, axis=1).tolist())) == [(3, 4), (3, 5), (3, 6), (4, 5)]
