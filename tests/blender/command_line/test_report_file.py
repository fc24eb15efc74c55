# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""The report as JSON: everything needed to repeat a run and to judge it."""

import json
from dataclasses import fields

import numpy as np
import pytest
from framelet.core import PRESETS, DenoiseReport, DenoiseSettings, NoiseBelief, SurfaceMesh, denoise


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
    assert entry["noise"] is None


@pytest.fixture
def denoised(command, write_ply, tmp_path):
    """A function that denoises with the default preset; returns the output and the entry in the report."""

    def run(vertices, faces, *options):
        source = write_ply(tmp_path / "in.ply", vertices, faces)
        result = command(
            "denoise", source, tmp_path / "out.ply", *options, "--report", tmp_path / "report.json"
        )
        assert result.code == 0
        report = json.loads((tmp_path / "report.json").read_text(encoding="utf-8"))
        assert report["preset"] == "AUTO"
        (entry,) = report["objects"]
        return result.out, entry

    return run


def test_the_noise_that_was_removed(denoised, grid):
    out, entry = denoised(grid.vertices, grid.faces, "--noise", "wide", "--strength", "0.9", "--passes", "1")
    settings = DenoiseSettings(method="AUTO", noise="WIDE", strength=0.9, passes=1)
    assert DenoiseSettings(**entry["settings"]) == settings
    expected = denoise(SurfaceMesh.from_faces(grid.vertices, grid.faces), settings).report
    noise = entry["noise"]
    names = [item.name for item in fields(NoiseBelief)]
    assert list(noise) == [*names, "sigma_low_edges", "sigma_high_edges", "is_clean"]
    for name in names:
        wanted = getattr(expected.noise, name)
        assert noise[name] == (wanted if isinstance(wanted, str) else pytest.approx(wanted, rel=1e-4))
    for end in ("low", "high"):
        sigma = noise[f"sigma_{end}"]
        assert noise[f"sigma_{end}_edges"] == pytest.approx(sigma / entry["mean_edge_length"]) and sigma > 0
    assert noise["is_clean"] is False
    assert ": 1 pass, " in out
    low, high, in_edges = noise["sigma_low"], noise["sigma_high"], "sigma_{}_edges".format
    assert f"  noise of {low:.3g} to {high:.3g} ({noise[in_edges('low')]:.3g} to " in out
    assert f" {noise[in_edges('high')]:.3g} mean edge lengths)" in out
    assert (" edges wide" in out) == (noise["width"] > 0.4)
    assert (" % spikes" in out) == (noise["spikes"] > 0)
    assert (" % was clean and stayed." in out) == (noise["clean"] > 0)


def test_a_clean_mesh_and_strength_zero_have_words_of_their_own(denoised, grid):
    flat = grid.used_vertices * np.float32([1, 1, 0])
    out, entry = denoised(flat, grid.faces_of_used)
    assert "\n  clean already.\n" in out and ": 0 passes, 0 vertices moved" in out
    assert entry["noise"]["is_clean"] is True and entry["noise"]["clean"] == 1
    out, entry = denoised(flat, grid.faces_of_used, "--strength", "0")
    assert "\n  strength is 0, so that nothing moves.\n" in out and "clean already" not in out
    assert entry["noise"]["is_clean"] is False


def test_all_words_on_noise():
    from types import SimpleNamespace

    from framelet.operators.command_line.denoise import _describe_noise

    noise = NoiseBelief(0.02, 0.2, 0.2, False, 0.02, 0.01, 0.04, 3.21, 0.012, 0.3)
    report = SimpleNamespace(settings=PRESETS["AUTO"].settings, mean_edge_length=0.1)
    assert _describe_noise(report, noise) == (
        "  noise of 0.01 to 0.04 (0.1 to 0.4 mean edge lengths), about 3.2 edges wide, 1.2 % spikes; "
        "30 % was clean and stayed."
    )


def test_versions_and_names(report, tmp_path):
    assert report["framelet"][0].isdigit()
    assert report["blender"] is None and report["error"] is None  # PLY files are read without it
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
    from framelet.operators.command_line.report_file import plain

    assert plain({"a": [float("nan"), float("inf"), 1.5], "b": (True, None, "x")}) == {
        "a": [None, None, 1.5],
        "b": [True, None, "x"],
    }


def test_the_version_of_blender_where_it_was_used(command, grid, write_ply, tmp_path):
    import bpy

    source = write_ply(tmp_path / "in.ply", grid.vertices, grid.faces)
    words = ["denoise", source, tmp_path / "out.blend", "--preset", "tri-2", "--report", tmp_path / "r.json"]
    assert command(*words).code == 0
    report = json.loads((tmp_path / "r.json").read_text(encoding="utf-8"))
    assert report["blender"].split(".")[:2] == [str(number) for number in bpy.app.version[:2]]
    (entry,) = report["objects"]
    assert list(entry) == ["name", *(item.name for item in fields(DenoiseReport))]
