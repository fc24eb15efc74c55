# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""The subcommand `report`: the summary, the table, and the page with pictures."""

import base64
import csv
import os
import re
import struct
import zlib

import numpy as np
import pytest
from framelet.operators.batch.pictures import as_png, picture, view_of
from framelet.operators.batch.summary import look_of
from framelet.operators.command_line import main

from .conftest import obj


@pytest.fixture
def out(scans, tmp_path):
    """A batch with a file that failed, and a name that a page must not take for its own."""
    (scans / "empty.obj").touch()
    (scans / "<img src=x onerror=alert(1)>&.obj").write_text(obj(7))
    assert main(["batch", str(scans), "--out", str(tmp_path / "out"), "--preset", "tri-2"]) == 1
    return tmp_path / "out"


def report(*words):
    """Run the subcommand in this process; return its exit code."""
    return main(["report", *map(os.fspath, words)])


def test_summary_and_files(out, tmp_path, capsys):
    page, table = tmp_path / "look.html", tmp_path / "look.csv"
    assert report(out, "--html", page, "--csv", table) == 0
    said = capsys.readouterr().out.splitlines()
    assert said[0] == "8 files: 7 done, 1 failed."
    assert said[4].startswith("empty.obj") and said[4].endswith("is empty.")
    with table.open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 8 and rows[0]["status"] == "failed"
    assert {row["n_vertices"] for row in rows[1:]} == {"64"}
    text = page.read_text()
    assert "<img src=x" not in text and "&lt;img src=x onerror=alert(1)&gt;&amp;.obj" in text
    assert "<script" not in text and "http" not in text.replace("http-equiv", "")
    assert text.index("empty.obj") < text.index("0.obj")
    images = [decoded(found) for found in re.findall(r"data:image/png;base64,([^\"]+)", text)]
    assert len(images) == 14
    for before, after in zip(images[::2], images[1::2], strict=True):
        # The sheet is seen, and it is smoother afterwards.
        assert before.shape == (240, 240) and (before < 255).mean() > 0.5
        assert 0 < roughness(after) < 0.7 * roughness(before)


def decoded(text):
    """Return the pixels of a picture of one channel."""
    data = base64.b64decode(text)
    at = data.index(b"IDAT")
    (length,) = struct.unpack(">I", data[at - 4 : at])
    _width, height = struct.unpack(">II", data[16:24])
    return np.frombuffer(zlib.decompress(data[at + 4 : at + 4 + length]), np.uint8).reshape(height, -1)[:, 1:]


def roughness(image):
    """Return how much gray differs within the middle."""
    return float(image[80:160, 80:160].std())


def test_pictures_of_files_that_are_others_now_are_left_out(out, scans, tmp_path):
    page = tmp_path / "look.html"
    (out / "0.obj").write_text(obj(1))
    (scans / "1.obj").unlink()
    assert report(out / "report.jsonl", "--html", page, "--quiet") == 0
    assert page.read_text().count("data:image/png") == 2 * 5
    assert report(out, "--html", page, "--pictures", "2", "--quiet") == 0
    assert page.read_text().count("data:image/png") == 2 * 2


def test_what_cannot_be_reported(tmp_path, capsys):
    assert report(tmp_path) == 2
    assert "holds no report of a batch" in capsys.readouterr().err
    assert report(tmp_path / "missing.jsonl") == 1
    assert "missing.jsonl cannot be read" in capsys.readouterr().err
    (tmp_path / "report.jsonl").write_text('{"cut": ')
    assert report(tmp_path, "--html", tmp_path / "page.txt") == 2
    assert report(tmp_path) == 0


def test_a_file_that_is_no_report_is_told(tmp_path, capsys):
    (tmp_path / "mesh.obj").write_text(obj(7))
    assert report(tmp_path / "mesh.obj") == 2
    assert "mesh.obj holds no row of a batch; name the report of one." in capsys.readouterr().err
    (tmp_path / "report.jsonl").touch()  # of a batch that was killed at once
    assert report(tmp_path / "report.jsonl") == 0


def test_what_needs_a_look():
    row = {"status": "done", "folded_faces": 0, "folded_faces_before": 2, "n_moved": 5, "noise": [None]}
    assert look_of(row) == (0.0, [])
    assert look_of(row | {"volume_change": -0.05}).reasons == ["volume -5.0%"]
    assert look_of(row | {"displacement_max_edges": 4.0}).reasons == ["a vertex moved by 4.0 edges"]
    assert look_of(row | {"n_moved": 0}).reasons == ["nothing moved"]
    assert look_of(row | {"n_moved": 0, "noise": [{"is_clean": True}]}).reasons == []
    assert look_of(row | {"folded_faces": 5}).weight > look_of(row | {"warnings": ["w"]}).weight > 0


def test_the_nearer_surface_is_seen():
    # A dark slope behind a bright square, and one that is named first.
    square = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    view = view_of(square)
    toward = view.axes[2] * 0.3
    offset, corners = np.array([0, 4, 8]), np.arange(8)
    alone = picture(square, offset[:2], corners[:4], view, 40)
    slope = np.array([[0.3, 0.3, -2], [0.7, 0.3, 2], [0.7, 0.7, 2], [0.3, 0.7, -2]])
    for where, is_seen in ((-10 * toward, False), (10 * toward, True)):
        both = picture(np.concatenate((slope + where, square)), offset, corners, view, 40)
        assert (both[20, 20] != alone[20, 20]) == is_seen
    assert (alone[3:-3, 3:-3] < 255).all() and alone[0, 0] == 255


def test_pictures_of_nothing():
    empty = picture(np.zeros((0, 3)), np.zeros(1, int), np.zeros(0, int), view_of(np.zeros((0, 3))), 10)
    assert (empty == 255).all() and as_png(empty).endswith(b"IEND\xaeB`\x82")
    points = np.full((3, 3), np.nan)
    assert (picture(points, np.array([0, 3]), np.arange(3), view_of(points), 10) == 255).all()


def test_files_whose_scene_cannot_be_shown_have_no_pictures(tmp_path):
    """The meshes of the file can be denoised, but what it shows is damaged."""
    scans, page = tmp_path / "scans", tmp_path / "look.html"
    scans.mkdir()
    (scans / "a.obj").write_text(obj(1))
    assert main(["denoise", str(scans / "a.obj"), str(scans / "b.glb"), "--strength", "0"]) == 0
    content = (scans / "b.glb").read_bytes()
    assert b'"scene":0' in content
    (scans / "b.glb").write_bytes(content.replace(b'"scene":0', b'"scene":7'))
    assert main(["batch", str(scans), "--out", str(tmp_path / "out"), "--preset", "tri-2"]) == 0
    assert report(tmp_path / "out", "--html", page, "--quiet") == 0
    assert page.read_text().count("data:image/png") == 2
