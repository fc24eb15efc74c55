# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""The benchmark runs, on meshes made in code, and its files say what they should; times are not tested."""

import csv
import subprocess
import sys
from pathlib import Path

import pytest

PROGRAM = Path(__file__).parent / "run.py"


def run(*words):
    """Run the benchmark in a fresh Python."""
    command = [sys.executable, str(PROGRAM), *map(str, words)]
    return subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)


@pytest.fixture(scope="module")
def quick(tmp_path_factory):
    """Folder with what a quick run wrote."""
    folder = tmp_path_factory.mktemp("benchmark")
    result = run("--quick", "--output", folder)
    assert result.returncode == 0, result.stderr
    return folder


@pytest.fixture(scope="module")
def rows(quick):
    """The rows of the CSV file by mesh, algorithm and choice."""
    with (quick / "results.csv").open(encoding="utf-8", newline="") as file:
        return {(row["mesh"], row["algorithm"], row["choice"]): row for row in csv.DictReader(file)}


def test_every_algorithm_has_a_default_and_a_best(rows):
    pairs = {(mesh, algorithm) for mesh, algorithm, choice in rows if choice != "noisy"}
    assert {algorithm for _, algorithm in pairs} >= {"BILATERAL", "TRI_1", "TRI_2", "QUAD_1", "QUAD_2"}
    for mesh, algorithm in pairs:
        default, best = (float(rows[mesh, algorithm, choice]["angle"]) for choice in ("default", "best"))
        assert best <= default


def test_denoising_helps_on_meshes_made_in_code(rows):
    for mesh, algorithm, choice in rows:
        # What runs at its default only may smooth too much: the extra levels of the presets do.
        if choice == "best" and rows[mesh, algorithm, choice]["group"] != "EXTRA":
            angle, noisy = (
                float(row["angle"]) for row in (rows[mesh, algorithm, choice], rows[mesh, "", "noisy"])
            )
            assert angle < 0.6 * noisy, (mesh, algorithm)


def test_levels_change_the_result(rows):
    for frame, mesh in (("BOX_SPLINE_111", "made/box_tri"), ("LINEAR_SPLINE", "made/bumpy_sphere_quad")):
        one, two = (float(rows[mesh, f"{frame} STRAIGHT {n}", "default"]["angle"]) for n in (1, 2))
        assert abs(two - one) > 0.1


def test_straight_keeps_the_edges_of_a_box(rows):
    mean, straight = (
        float(rows["made/box_tri", f"BOX_SPLINE_111 {rule} 1", "default"]["crease_angle"])
        for rule in ("MEAN", "STRAIGHT")
    )
    assert straight < mean


def test_tables_can_be_written_again(quick, tmp_path):
    result = run("--again", quick, "--output", tmp_path)
    assert result.returncode == 0, result.stderr
    assert (tmp_path / "results.csv").read_text() == (quick / "results.csv").read_text()
    text = (tmp_path / "frames.md").read_text(encoding="utf-8")
    for title in ("presets on triangles", "presets on quads", "means", "stencils", "levels"):
        assert f"## {title}\n" in text
    assert "| 1 of triangles | Tri-2 |" in text


def test_unknown_mesh(tmp_path):
    result = run("made/nothing", "--output", tmp_path)
    assert result.returncode == 2
    assert result.stderr.startswith("There is no mesh 'made/nothing'; choose from made/box_quad, ")
