# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""An STL with everything that it allows: denoised, and all that is no coordinate is as it was."""

import re

import numpy as np
import pytest
from framelet.operators.files import open_file

from .made import denoised, full_stl_binary, full_stl_text, sheet


@pytest.mark.parametrize("make", [full_stl_text, full_stl_binary])
def test_stl(command, tmp_path, make):
    source = tmp_path / "in.stl"
    source.write_bytes(make())
    before, after = denoised(command, source, tmp_path / "out.stl")
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
