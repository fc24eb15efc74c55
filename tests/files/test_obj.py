# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""An OBJ with everything that it allows: denoised, and all that is no coordinate is as it was."""

import re

import numpy as np
import pytest
from framelet.operators.files import open_file

from .made import POSITIONS, denoised, full_obj, sheet


@pytest.mark.parametrize("newline", ["\n", "\r\n"])
def test_obj(command, tmp_path, newline):
    source = tmp_path / "in.obj"
    source.write_bytes(full_obj(newline))
    before, after = denoised(command, source, tmp_path / "out.obj")
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


def test_all_at_one_place(fails, tmp_path):
    (tmp_path / "in.obj").write_bytes(b"v 1 1 1\n" * 3 + b"f 1 2 3\n")
    sentence = fails("denoise", tmp_path / "in.obj", tmp_path / "out.obj", *POSITIONS)
    assert "at the same place" in sentence and "distance" not in sentence


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


def test_a_face_of_vertex_0_is_told_and_left_out(command, tmp_path):
    """Numbers of vertices begin at 1."""
    content = full_obj() + b"f 0 1 2\n"
    (tmp_path / "a.obj").write_bytes(content)
    result = command("denoise", tmp_path / "a.obj", tmp_path / "b.obj", *POSITIONS)
    assert result.code == 0 and "1 face names a vertex that does not exist" in result.err
    assert open_file(tmp_path / "a.obj").warnings
    assert (tmp_path / "b.obj").read_bytes().endswith(b"f 0 1 2\n")
