# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""The report as JSON: everything needed to repeat a run and to judge it."""

import json
from dataclasses import fields

import bpy
import pytest
from framelet.core import PRESETS, DenoiseReport, DenoiseSettings, NoiseEstimate, SurfaceMesh, denoise


@pytest.fixture
def report(command, grid, write_ply, tmp_path):
    """The report of a run."""
    source = write_ply(tmp_path / "in.ply", grid.vertices, grid.faces)
    options = ["--preset", "tri-1", "--lambda", "0.7", "--report", tmp_path / "report.json"]
    result = command("denoise", source, tmp_path / "out.ply", *options)
    assert result.code == 0
    assert result.out.endswith(f"Wrote {tmp_path / 'out.ply'} and {tmp_path / 'report.json'}.\n")
    return json.loads((tmp_path / "report.json").read_text(encoding="utf-8"))


def test_settings_can_be_used_again(report):
    expected = PRESETS["TRI_1"].settings.with_changes(lambda_=0.7)
    assert DenoiseSettings(**report["settings"]) == expected
    assert report["preset"] == "TRI_1"


def test_settings_that_were_used(report):
    (entry,) = report["objects"]
    assert entry["settings"] == report["settings"]
    assert (entry["noise"], entry["recipe"]) == (None, "")


def test_noise_and_what_was_chosen(command, grid, write_ply, tmp_path):
    source = write_ply(tmp_path / "in.ply", grid.vertices, grid.faces)
    options = ["--strength", "0.9", "--report", tmp_path / "report.json"]
    result = command("denoise", source, tmp_path / "out.ply", *options)
    assert result.code == 0
    report = json.loads((tmp_path / "report.json").read_text(encoding="utf-8"))
    (entry,) = report["objects"]
    expected = denoise(SurfaceMesh.from_faces(grid.vertices, grid.faces)).report
    assert report["preset"] == "AUTO"
    assert DenoiseSettings(**entry["settings"]) == DenoiseSettings(method="AUTO", strength=0.9)
    assert list(entry["noise"]) == [item.name for item in fields(NoiseEstimate)]
    assert entry["noise"]["sigma_edges"] == pytest.approx(expected.noise.sigma_edges, rel=1e-4)
    assert entry["recipe"] and f"chosen for it: {entry['recipe']}." in result.out
    assert f"noise of {entry['noise']['sigma']:.4g} (" in result.out


def test_versions_and_names(report, tmp_path):
    assert report["framelet"][0].isdigit()
    assert report["blender"].split(".")[:2] == [str(number) for number in bpy.app.version[:2]]
    assert report["input"] == str(tmp_path / "in.ply")
    assert report["output"] == str(tmp_path / "out.ply")


def test_all_fields_of_the_result(report, grid):
    (entry,) = report["objects"]
    assert list(entry) == ["name", *(item.name for item in fields(DenoiseReport))]
    assert entry["name"] == "in"
    assert entry["n_vertices"] == len(grid.vertices)
    assert entry["n_faces"] == len(grid.faces)
    assert entry["loose_vertices"] == 1
    assert entry["volume_change"] is None
    assert entry["displacement_max"] >= entry["displacement_rms"] > 0
    assert report["skipped"] == []


def test_skipped_objects(command, grid, write_obj, tmp_path):
    n = len(grid.used_vertices)
    source = write_obj(tmp_path / "in.obj", grid.used_vertices, grid.faces_of_used, before="o Good")
    source.write_text(source.read_text() + f"o Bad\nv 0 0 90\nv 1 0 90\nl {n + 1} {n + 2}\n")
    result = command(
        "denoise", source, tmp_path / "out.obj", "--report", tmp_path / "report.json", "--preset", "positions"
    )
    assert result.code == 0
    assert "warning: ‘Bad’ has no faces" in result.err
    report = json.loads((tmp_path / "report.json").read_text(encoding="utf-8"))
    assert [entry["name"] for entry in report["objects"]] == ["Good"]
    assert [entry["name"] for entry in report["skipped"]] == ["Bad"]


def test_numbers_json_has_no_words_for():
    from framelet.operators.command_line.report_file import _plain

    assert _plain({"a": [float("nan"), float("inf"), 1.5], "b": (True, None, "x")}) == {
        "a": [None, None, 1.5],
        "b": [True, None, "x"],
    }
