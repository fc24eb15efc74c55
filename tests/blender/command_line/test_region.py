# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Options of the command line for regions."""

import json
from dataclasses import asdict
from itertools import pairwise

import numpy as np
import pytest
from framelet.operators.command_line.parser import make_parser
from framelet.operators.command_line.region_arguments import region_options_from
from framelet.operators.properties.region_options import RegionOptions


@pytest.mark.parametrize(
    ("typed", "expected"),
    [
        ([], {}),
        (["--vertex-group", "Nose", "--invert-group"], {"vertex_group": "Nose", "invert_group": True}),
        (["--max-edges", "0.5"], {"limit": "EDGES", "max_edges": 0.5}),
        (["--max-length", "2"], {"limit": "LENGTH", "max_length": 2.0}),
        (["--weld", "--weld-distance", "0.25"], {"weld": True, "weld_distance": 0.25}),
        (
            ["--keep-sharp", "--along-normals", "--keep-volume"],
            {"keep_sharp": True, "along_normals": True, "keep_volume": True},
        ),
        (["--weld-distance", "0.25"], {"weld_distance": 0.25}),
        (["--no-weld"], {"weld": False}),
        (["--no-repair-folds", "--no-keep-hidden"], {"repair_folds": False, "keep_hidden": False}),
    ],
)
def test_what_is_typed_becomes_options(typed, expected):
    arguments = make_parser("framelet").parse_args(["denoise", "in.ply", "out.ply", *typed])
    assert region_options_from(arguments) == RegionOptions(**expected)


@pytest.mark.parametrize(
    ("typed", "message"),
    [
        (["--max-edges", "1", "--max-length", "1"], "--max-edges and --max-length are two limits"),
        (["--invert-group"], "--invert-group has no effect without --vertex-group"),
        (["--weld-distance", "1", "--no-weld"], "--weld-distance has no effect with --no-weld"),
        (["--max-edges", "-1"], "Farthest is -1; it must be between 0 and 1000"),
        (["--max-length", "far"], "'far' is not a number"),
    ],
)
def test_wrong_options_are_refused(typed, message, fails, tmp_path):
    assert message in fails("denoise", tmp_path / "in.ply", tmp_path / "out.ply", *typed, code=2)


def test_a_limit_is_kept_and_reported(command, grid, write_ply, read_ply, tmp_path):
    source, target, report = (tmp_path / name for name in ("in.ply", "out.ply", "report.json"))
    write_ply(source, grid.vertices, grid.faces)
    result = command(
        "denoise", source, target, "--preset", "tri-2", "--max-length", "0.02", "--report", report
    )
    assert result.code == 0
    moved = np.linalg.norm(read_ply(target).vertices.astype(float) - grid.vertices, axis=1)
    assert moved.max() == pytest.approx(0.02, rel=1e-3)
    content = json.loads(report.read_text(encoding="utf-8"))
    assert RegionOptions(**content["region"]) == RegionOptions(limit="LENGTH", max_length=0.02)
    assert content["region"] == asdict(RegionOptions(limit="LENGTH", max_length=0.02))
    (entry,) = content["objects"]
    for name in ("folded_faces", "folded_faces_before", "degenerate_faces", "damped_vertices"):
        assert entry[name] >= 0
    assert entry["welded_vertices"] == 0


def test_soups_from_stl_are_welded_in_files_of_vertices_of_their_own(
    command, grid, write_ply, read_ply, tmp_path
):
    corners = [vertex for face in grid.faces for vertex in face]
    starts = np.cumsum([0] + [len(face) for face in grid.faces])
    faces = [tuple(range(a, b)) for a, b in pairwise(starts)]
    source, target = tmp_path / "soup.ply", tmp_path / "out.ply"
    write_ply(source, grid.vertices[corners], faces)
    result = command("denoise", source, target, "--preset", "tri-2")
    assert result.code == 0
    assert "vertices welded" in result.out
    vertices = read_ply(target).vertices
    assert len(vertices) == len(corners)
    for vertex in range(len(grid.vertices)):
        same = vertices[np.array(corners) == vertex]
        assert len(same) == 0 or (same == same[0]).all()


def test_a_group_that_a_file_does_not_have(fails, grid, write_ply, tmp_path):
    source = tmp_path / "in.ply"
    write_ply(source, grid.vertices, grid.faces)
    text = fails("denoise", source, tmp_path / "out.ply", "--vertex-group", "Nose")
    assert "has no vertex group ‘Nose’; choose one that it has." in text


def test_help_names_every_option(command):
    text = command("denoise", "--help").out
    for word in ("--vertex-group", "--keep-sharp", "--max-edges", "--no-repair-folds", "--weld-distance"):
        assert word in text
