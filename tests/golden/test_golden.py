# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""No preset changes without a word: results are those of the table, and the table tells small changes."""

import numpy as np
import pytest
from framelet import core

from . import results


@pytest.fixture(scope="module")
def table():
    return results.read_rows(results.TABLE)


def row(edge, before, after):
    return [f"{number:.6f}" for number in results.checksums(edge, before, after)]


def test_results_are_those_of_the_table(table):
    """After a change that is meant: `make golden`, and say in the change log what it changes."""
    found = {
        (mesh, preset): row(edge, before, after)
        for mesh, preset, edge, before, after in results.results(core)
    }
    assert results.differences(found, table) == []
    assert {preset for _, preset in table} == set(core.PRESETS)


def test_a_preset_that_is_a_hundredth_stronger_is_told(table):
    points, faces = results.MESHES["triangle roof"]()
    before = (points + results.NOISE * results.numbers(points.shape, 7)).astype(np.float32)
    surface = core.SurfaceMesh.from_faces(before, faces)
    changed = core.PRESETS["TRI_2"].settings.with_changes(lambda_=0.303)
    ((_, _, edge, _, _),) = (
        found for found in results.results(core, {"TRI_2"}) if found[0] == "triangle roof"
    )
    case = ("triangle roof", "TRI_2")
    found = {case: row(edge, before, core.denoise(surface, changed).vertices)}
    assert results.differences(found, {case: table[case]}) != []


def test_bits_count_where_no_library_rounds():
    same, other = (["0.1"] * (results.N_SUMS + 1) + [digest] for digest in ("a", "b"))
    assert results.differences({("m", "TRI_2"): same}, {("m", "TRI_2"): other}) == ["m, TRI_2: other bits"]
    assert results.differences({("m", "AUTO"): same}, {("m", "AUTO"): other}) == []
    assert results.differences({("m", "AUTO"): same}, {}) == ["m, AUTO: only in one table"]


def test_numbers_look_random():
    found = results.numbers((20_000,), 3)
    assert abs(found.mean()) < 0.02 and found.std() == pytest.approx(1.0, abs=0.02)
    assert abs(np.corrcoef(found[:-1], found[1:])[0, 1]) < 0.03
