# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""All formats alike: no byte changes without need, seams close, one becomes the other."""

import numpy as np
import pytest
from framelet.core import PRESETS, Region, SurfaceMesh, denoise
from framelet.operators.files import open_file

from .made import POSITIONS, full_gltf, full_obj, full_ply, full_stl_binary, full_stl_text, sheet


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
