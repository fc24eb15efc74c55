# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Inputs that failed once: rows of the table beside them."""

import numpy as np
import pytest
from framelet.operators.files import open_file

from .made import sheet  # noqa: F401

QUICK = ("--preset", "tri-2")


@pytest.fixture
def denoised(command, cases, tmp_path):
    """A function that denoises a case; returns what was read, what was written, and both contents."""

    def run(name, *options):
        target = tmp_path / name
        result = command("denoise", cases / name, target, *options)
        assert result.code == 0, result.err
        return open_file(cases / name), open_file(target), (cases / name).read_bytes(), target.read_bytes()

    return run


def angle(before, after):
    """Return the mean angle in degrees between the triangles of two files."""
    normals = []
    for file in (before, after):
        corners = file.positions[file.corner_vertex.reshape(-1, 3)]
        normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normals.append(normal / np.linalg.norm(normal, axis=1, keepdims=True))
    return np.degrees(np.arccos(np.clip((normals[0] * normals[1]).sum(axis=1), -1, 1))).mean()


def test_georeferenced(denoised):
    far_before, far, old, new = denoised("georeferenced.ply")
    near_before, near, *_ = denoised("georeferenced_local.ply")
    assert far.precision == np.float64 and len(old) == len(new)
    moved_far, moved_near = far.positions - far_before.positions, near.positions - near_before.positions
    assert np.abs(moved_far).max() > 0.05
    np.testing.assert_allclose(moved_far, moved_near, atol=1e-4)
    assert angle(far, near) < 0.01 and angle(far_before, far) > 10


@pytest.mark.parametrize("name", ["ply_properties.ply", "ply_double_faces.ply", "ply_300_corners.ply"])
def test_ply(denoised, name):
    before, after, old, new = denoised(name, *QUICK)
    assert np.array_equal(before.corner_vertex, after.corner_vertex)
    assert np.array_equal(before.face_offset, after.face_offset)
    assert old.split(b"end_header\n")[0] == new.split(b"end_header\n")[0]
    if name == "ply_300_corners.ply":
        rows = [each.split(b"end_header\n")[1].splitlines()[len(before.positions) :] for each in (old, new)]
        assert rows[0] == rows[1] and np.diff(after.face_offset).max() == 300
        return
    width = {"ply_properties.ply": 31, "ply_double_faces.ply": 12}[name]
    bodies = [
        np.frombuffer(each.split(b"end_header\n", 1)[1], np.uint8, len(before.positions) * width).reshape(
            -1, width
        )
        for each in (old, new)
    ]
    assert (
        np.array_equal(bodies[0][:, 12:], bodies[1][:, 12:])
        and (bodies[0][:, :12] != bodies[1][:, :12]).any()
    )
    end = len(old) - (len(old.split(b"end_header\n", 1)[1]) - bodies[0].size)
    assert old[end:] == new[end:]


def test_obj_groups(denoised, tmp_path, cases):
    *_, old, new = denoised("obj_groups.obj", *QUICK)
    lines = list(zip(old.split(b"\n"), new.split(b"\n"), strict=True))
    changed = [first for first, second in lines if first != second]
    assert len(changed) == 400 and all(line.startswith(b"v ") for line in changed)
    assert (tmp_path / "obj_groups.mtl").read_bytes() == (cases / "obj_groups.mtl").read_bytes()
    assert (tmp_path / "textures" / "tile 1.png").exists()


def test_stl_upper_case(denoised):
    before, after, old, new = denoised("stl_upper_case.stl", *QUICK)
    assert before.n_faces == after.n_faces == 722
    assert old.split()[:3] == new.split()[:3] == [b"SOLID", b"PART", b"FACET"]


@pytest.mark.parametrize("name", ["uv_split.glb", "uv_split.ply"])
def test_uv_split(denoised, cases, name):
    before, after, *_ = denoised(name)
    same = np.load(cases / "clean" / "uv_split_same.npy")
    low, high = np.full((same.max() + 1, 3), np.inf), np.full((same.max() + 1, 3), -np.inf)
    np.minimum.at(low, same, after.positions)
    np.maximum.at(high, same, after.positions)
    assert np.array_equal(low, high)
    assert angle(before, after) > 10


def test_nan(fails, cases, tmp_path):
    fails("denoise", cases / "reliability" / "nan.ply", tmp_path / "out.ply", *QUICK)
    assert not (tmp_path / "out.ply").exists()


@pytest.mark.parametrize("name", ["importer_abort_1.ply", "importer_segv.obj"])
def test_what_ended_the_importer(command, cases, tmp_path, name):
    result = command("denoise", cases / "reliability" / name, tmp_path / f"out{name[-4:]}", *QUICK)
    assert result.code in (0, 1) and "Traceback" not in result.err
    assert (result.code == 0) == (tmp_path / f"out{name[-4:]}").exists()
