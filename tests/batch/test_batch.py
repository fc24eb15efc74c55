# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""A batch: what it does, what it leaves alone, what it says, and how it goes on."""

import hashlib
import io
import json
import os
import re
import sys

import pytest
from framelet.core.settings import DenoiseSettings
from framelet.operators.batch.inputs import find_files
from framelet.operators.batch.lock import ReportLock
from framelet.operators.command_line import main
from framelet.operators.files import open_file
from framelet.operators.properties.region_options import RegionOptions

from ..files.made import full_gltf
from .conftest import obj, rows_of, run

QUICK = ("--preset", "tri-2")


def batch(*words):
    """Run a batch in this process, which starts others; return its exit code."""
    return main(["batch", *map(os.fspath, words)])


def test_a_folder(scans, tmp_path, capsys):
    out = tmp_path / "out"
    before = {path: path.read_bytes() for path in scans.rglob("*.obj")}
    assert batch(scans, "--out", out) == 0
    assert {path: path.read_bytes() for path in scans.rglob("*.obj")} == before
    rows = rows_of(out / "report.jsonl")
    assert sorted(row["output"] for row in rows) == [
        *(f"{n}.obj" for n in range(4)),
        "left/0.obj",
        "left/1.obj",
    ]
    for row in rows:
        data = (out / row["output"]).read_bytes()
        assert row["status"] == "done" and row["error"] is None
        assert row["output_sha256"] == hashlib.sha256(data).hexdigest() != row["input_sha256"]
        assert row["n_vertices"] == 64 and row["n_faces"] == 98 and row["n_moved"] > 30
        assert 0 < row["displacement_rms"] < row["displacement_max"]
        assert row["defects"] == [
            {"kind": "open borders", "count": 28, "of": "vertex", "first": [0, 1, 2, 3, 4]}
        ]
        assert {"hash", "read", "defects", "denoise", "write", "publish"} <= set(row["seconds"])
        assert row["peak_bytes"] is None or row["peak_bytes"] > 10**7
        assert row["noise"][0]["sigma_high"] > 0
    assert "[6/6]" in capsys.readouterr().out


def test_a_row_alone_repeats_the_run(scans, tmp_path):
    out = tmp_path / "out"
    assert batch(scans / "0.obj", "--out", out, *QUICK, "--lambda", "0.2", "--max-edges", "0.1") == 0
    (row,) = rows_of(out / "report.jsonl")
    settings, region = DenoiseSettings(**row["settings"]), RegionOptions(**row["region"])
    assert settings.lambda_ == 0.2 and region.max_edges == 0.1
    options = ["--preset", "tri-2", "--lambda", settings.lambda_, "--max-edges", region.max_edges]
    assert main(["denoise", row["input"], str(tmp_path / "again.obj"), *map(str, options)]) == 0
    assert (tmp_path / "again.obj").read_bytes() == (out / "0.obj").read_bytes()


def test_a_second_run_does_what_is_left(scans, tmp_path):
    out = tmp_path / "out"
    report = out / "report.jsonl"
    assert batch(scans, "--out", out, *QUICK) == 0
    assert batch(scans, "--out", out, *QUICK) == 0
    assert len(rows_of(report)) == 6
    (out / "0.obj").unlink()  # is missing
    (out / "1.obj").write_text("damaged")
    (scans / "2.obj").write_text(obj(99))  # another input
    assert batch(scans, "--out", out, *QUICK) == 0
    assert sorted(row["output"] for row in rows_of(report)[6:]) == ["0.obj", "1.obj", "2.obj"]
    assert batch(scans, "--out", out, *QUICK, "--lambda", "0.1") == 0
    assert len(rows_of(report)) == 9 + 6
    assert batch(scans, "--out", out, *QUICK, "--lambda", "0.1", "--overwrite") == 0
    assert len(rows_of(report)) == 9 + 12


def test_bad_files_stop_nothing(scans, tmp_path, capsys):
    (scans / "empty.obj").touch()
    (scans / "nan.obj").write_text(obj(3).replace("v 0 0 ", "v nan 0 "))
    (scans / "noise.ply").write_bytes(os.urandom(500))
    out = tmp_path / "out"
    assert batch(scans, tmp_path / "missing.stl", "--out", out) == 1
    rows = {row["output"]: row for row in rows_of(out / "report.jsonl")}
    failed = {name for name, row in rows.items() if row["status"] == "failed"}
    assert failed == {"empty.obj", "nan.obj", "noise.ply", "missing.stl"}
    assert "is empty" in rows["empty.obj"]["error"]
    assert "is not a finite point" in rows["nan.obj"]["error"]
    assert "does not exist" in rows["missing.stl"]["error"]
    assert len(rows) == 10 and not (out / "nan.obj").exists()
    err = capsys.readouterr().err
    assert "4 files of 10 failed" in err and "Traceback" not in err
    # They are tried again, and only they.
    (scans / "empty.obj").write_text(obj(5))
    assert batch(scans, "--out", out) == 1
    assert [row["output"] for row in rows_of(out / "report.jsonl")[10:]].count("empty.obj") == 1
    assert len(rows_of(out / "report.jsonl")) == 10 + 3


def test_options_of_rows(scans, tmp_path):
    manifest = scans / "list.csv"
    manifest.write_text(
        "input,output,format,preset,lambda,weld\n"
        "0.obj,,,tri-2,0.3,\n"
        "1.obj,b/one.ply,,,,true\n"
        "2.obj,../2.obj,,,,\n"
        "3.obj,,,auto,0.3,\n"
        "left/0.obj,,ply,,,\n"
        "left/1.obj,,,nonsense,,\n"
    )
    out = tmp_path / "out"
    assert batch("--manifest", manifest, "--out", out) == 1
    rows = {row["input"]: row for row in rows_of(out / "report.jsonl")}
    rows = {os.path.relpath(key, scans): row for key, row in rows.items()}
    assert rows["0.obj"]["settings"]["lambda_"] == 0.3 and rows["0.obj"]["preset"] == "TRI_2"
    assert rows["1.obj"]["output"] == "b/one.ply" and rows["1.obj"]["region"]["weld"] is True
    assert open_file(out / "b" / "one.ply").n_faces == 98
    assert "leaves the folder" in rows["2.obj"]["error"] and not (tmp_path / "2.obj").exists()
    assert "--lambda has no effect" in rows["3.obj"]["error"]
    assert rows["left/0.obj"]["output"] == "0.ply"
    assert "'nonsense' is not one of" in rows["left/1.obj"]["error"]
    assert batch("--manifest", manifest, "--out", out, "--allow-outside") == 1
    assert (tmp_path / "2.obj").exists()


def test_json_manifest_and_slices(scans, tmp_path):
    manifest = tmp_path / "list.jsonl"
    rows = [{"input": str(scans / f"{n}.obj"), "strength": n / 4, "output": f"{n}.stl"} for n in range(4)]
    manifest.write_text("".join(json.dumps(row) + "\n" for row in rows))
    out = tmp_path / "out"
    for part in (1, 2, 3):
        assert batch("--manifest", manifest, "--out", out, "--slice", f"{part}/3") == 0
    found = [rows_of(out / f"report-{part}-of-3.jsonl") for part in (1, 2, 3)]
    assert [[row["output"] for row in each] for each in found] == [["0.stl", "3.stl"], ["1.stl"], ["2.stl"]]
    assert found[1][0]["settings"]["strength"] == 0.25
    # The whole knows what its parts did.
    assert batch("--manifest", manifest, "--out", out) == 0
    assert rows_of(out / "report.jsonl") == []


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ([], "nothing to do"),
        (["scans/*.ply"], "holds no mesh file"),
        (["scans/0.obj", "scans/left/0.obj"], "would both be written"),
        (["scans", "--name", "{stem.__class__}"], "{stem.__class__}; known are"),
        (["scans", "--lambda", "0.3"], "--lambda has no effect"),
        (["scans", "--slice", "4/3"], "is not a part"),
        (["scans", "--max-memory", "lots"], "is not a size"),
        (["--manifest", "scans/0.obj"], "must end in .csv"),
    ],
)
def test_plans_that_contradict_themselves(scans, tmp_path, capsys, monkeypatch, words, sentence):
    monkeypatch.chdir(tmp_path)
    assert batch(*words, "--out", "out") == 2
    assert sentence in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_inputs_are_never_written(scans, capsys):
    before = {path: path.read_bytes() for path in scans.rglob("*") if path.is_file()}
    assert batch(scans / "0.obj", scans / "1.obj", "--out", scans) == 2
    assert "is read and would be written" in capsys.readouterr().err
    assert {path: path.read_bytes() for path in scans.rglob("*") if path.is_file()} == before


def test_links_do_not_leave_the_folder(scans, tmp_path):
    out = tmp_path / "out"
    out.mkdir()
    (tmp_path / "elsewhere").mkdir()
    (out / "left").symlink_to(tmp_path / "elsewhere")
    assert batch(scans, "--out", out) == 1
    assert not list((tmp_path / "elsewhere").iterdir())
    assert sum(row["status"] == "failed" for row in rows_of(out / "report.jsonl")) == 2


def test_files_of_others_stay(scans, tmp_path):
    out = tmp_path / "out"
    out.mkdir()
    (out / "0.obj").write_text("mine")
    for _ in range(2):
        assert batch(scans, "--out", out, *QUICK) == 1
        assert (out / "0.obj").read_text() == "mine"
    assert "--overwrite" in rows_of(out / "report.jsonl")[-1]["error"]
    assert batch(scans, "--out", out, *QUICK, "--overwrite") == 0
    assert (out / "0.obj").read_text() != "mine"


def test_results_inside_the_inputs_are_no_inputs(scans):
    for _ in range(2):
        assert batch(scans, "--out", scans / "clean", *QUICK) == 0
    assert len(rows_of(scans / "clean" / "report.jsonl")) == 6
    assert not (scans / "clean" / "clean").exists()


def test_names_limit_and_dry_run(scans, tmp_path, capsys):
    out = tmp_path / "out"
    words = (f"{scans}/**/*.obj", "--out", out, "--format", "ply", "--name", "{number:3}_{stem}{suffix}")
    assert batch(*words, "--dry-run", *QUICK) == 0
    assert "6 of 6 files would be worked on" in capsys.readouterr().out
    assert not out.exists()
    assert batch(*words, "--limit", "2", *QUICK) == 0
    assert sorted(path.name for path in out.glob("*.ply")) == ["001_0.ply", "002_1.ply"]
    assert batch(*words, "--limit", "2", *QUICK) == 0
    assert len(list(out.glob("*.ply"))) == 4


def test_fail_fast(scans, tmp_path):
    (scans / "0.obj").write_text("")
    out = tmp_path / "out"
    assert batch(scans, "--out", out, "--fail-fast") == 1
    assert [row["output"] for row in rows_of(out / "report.jsonl")] == ["0.obj"]


def test_memory_is_estimated_before_the_work(scans, tmp_path):
    (scans / "0.obj").write_text(obj(0, 40))
    out = tmp_path / "out"
    assert batch(scans / "0.obj", "--out", out, "--max-memory", "1M") == 1
    assert batch(scans / "0.obj", "--out", out, "--max-memory", "10k") == 1
    assert batch(scans / "0.obj", "--out", out, "--max-memory", "1G") == 0
    first, second, third = rows_of(out / "report.jsonl")
    assert "1,600 vertices needs about" in first["error"] and "denoise" not in first["seconds"]
    assert "read" not in second["seconds"] and "held twice" in second["error"]
    assert third["status"] == "done"


def test_one_run_at_a_time(scans, tmp_path):
    out = tmp_path / "out"
    out.mkdir()
    with ReportLock(out / "report.jsonl"):
        _out, err = run("batch", scans, "--out", out, code=2)
        assert f"is being written by process {os.getpid()} on " in err
        assert not list(out.glob("*.obj"))
    run("batch", scans, "--out", out, *QUICK)


def test_quiet_and_verbose(scans, tmp_path):
    out, err = run("batch", scans, "--out", tmp_path / "a", "--quiet", *QUICK)
    assert (out, err) == ("", "")
    out, _err = run("batch", scans, "--out", tmp_path / "b", "--verbose", *QUICK)
    assert len(re.findall(r"^  .*denoise \d+\.\d\d s", out, re.MULTILINE)) == 6
    assert not list((tmp_path / "a").glob("*.begun"))


def test_what_a_file_refers_to_counts(scans, tmp_path):
    out = tmp_path / "out"
    (scans / "0.obj").write_text("mtllib 0.mtl\n" + obj(0))
    (scans / "0.mtl").write_text("newmtl a\nmap_Kd a.png\n")
    (scans / "a.png").write_bytes(b"one")
    words = (scans / "0.obj", "--out", out, *QUICK)
    assert batch(*words) == 0
    (row,) = rows_of(out / "report.jsonl")
    hashes = {name: hashlib.sha256((scans / name).read_bytes()).hexdigest() for name in ("0.mtl", "a.png")}
    assert row["beside_input"] == row["beside_output"] == hashes
    assert batch(*words) == 0 and len(rows_of(out / "report.jsonl")) == 1
    # Another texture: the copy of before is the batch's own, and follows.
    (scans / "a.png").write_bytes(b"another")
    assert batch(*words) == 0
    assert (out / "a.png").read_bytes() == b"another" and len(rows_of(out / "report.jsonl")) == 2
    assert not rows_of(out / "report.jsonl")[1]["warnings"]
    (out / "0.mtl").unlink()
    assert batch(*words) == 0
    assert (out / "0.mtl").exists() and len(rows_of(out / "report.jsonl")) == 3
    # What somebody else wrote there is left alone.
    (out / "a.png").write_bytes(b"mine")
    assert batch(*words) == 0
    assert (out / "a.png").read_bytes() == b"mine"
    assert "left alone" in rows_of(out / "report.jsonl")[3]["warnings"][0]


def test_a_buffer_that_a_killed_run_left_is_its_own(tmp_path):
    source = tmp_path / "in" / "scan.gltf"
    source.parent.mkdir()
    text, buffer = full_gltf("separate")
    source.write_bytes(text)
    (source.parent / "sheet data.bin").write_bytes(buffer)
    out = tmp_path / "out"
    assert batch(source, "--out", out, *QUICK) == 0
    whole = {path.name: path.read_bytes() for path in out.glob("s*")}
    report, buffers = out / "report.jsonl", sorted(set(whole) - {"scan.gltf"})
    (row,) = rows_of(report)
    assert buffers and sorted(row["beside_output"]) == buffers and set(row["beside_input"]) >= set(buffers)
    # Killed after the buffer was moved into its place, and before the file that names it was.
    (out / "scan.gltf").unlink()
    report.write_bytes(b"")
    assert batch(source, "--out", out, *QUICK) == 0
    assert {path.name: path.read_bytes() for path in out.glob("s*")} == whole
    # A buffer that has changed is seen.
    (out / buffers[0]).write_bytes(b"cut")
    assert batch(source, "--out", out, *QUICK) == 0
    assert (out / buffers[0]).read_bytes() == whole[buffers[0]] and len(rows_of(report)) == 2


@pytest.mark.parametrize("place", ["../../sheet.bin", "%2e%2e/%2E%2E/sheet.bin", "absolute"])
def test_a_buffer_is_never_written_outside_the_folder(tmp_path, place):
    source = tmp_path / "in" / "deep" / "scan.gltf"
    source.parent.mkdir(parents=True)
    text, buffer = full_gltf("separate")
    (tmp_path / "sheet.bin").write_bytes(buffer)
    uri = str(tmp_path / "sheet.bin") if place == "absolute" else place
    source.write_bytes(text.replace(b"sheet%20data.bin", uri.encode()))
    out = tmp_path / "far" / "away" / "out"
    assert batch(source, "--out", out, *QUICK) == 0
    assert (tmp_path / "sheet.bin").read_bytes() == buffer
    assert sorted(path.name for path in (tmp_path / "far").rglob("*.*")) == [
        "report.jsonl", "report.jsonl.lock", "scan.bin", "scan.gltf",
    ]  # fmt: skip
    assert all(path.is_relative_to(out) for path in (tmp_path / "far").rglob("*.*"))
    (row,) = rows_of(out / "report.jsonl")
    assert row["n_moved"] and len(row["beside_output"]) == 1
    assert batch(source, "--out", out, *QUICK) == 0 and len(rows_of(out / "report.jsonl")) == 1


def test_defects_have_kinds_and_numbers(scans, tmp_path):
    (scans / "0.obj").write_text(obj(0) + "v 9 9 9\nf 1 2 9\nf 1 1 2\nf 2 1 33\nf 1 2 17\n")
    assert batch(scans / "0.obj", "--out", tmp_path / "out", *QUICK) == 0
    (row,) = rows_of(tmp_path / "out" / "report.jsonl")
    found = {defect["kind"]: (defect["count"], defect["first"]) for defect in row["defects"]}
    assert found["degenerate faces"] == (1, [99])
    assert found["edges with more than two faces"] == (2, [0, 1])
    assert found["loose vertices"] == (1, [64])
    assert found["non-manifold vertices"][0] >= 2


class Terminal(io.StringIO):
    """What takes a bar."""

    def isatty(self):
        return True


def test_a_bar_on_a_terminal(scans, tmp_path, monkeypatch, capsys):
    pytest.importorskip("tqdm", reason="tqdm is not installed")
    (scans / "empty.obj").touch()
    monkeypatch.setattr(sys, "stderr", Terminal())
    assert batch(scans, "--out", tmp_path / "bar", *QUICK) == 1
    shown = sys.stderr.getvalue()
    assert "7/7" in shown and "1 failed" in shown and "empty.obj is empty." in shown
    assert capsys.readouterr().out == ""
    # Without tqdm there is a line a file.
    monkeypatch.setitem(sys.modules, "tqdm", None)
    monkeypatch.setattr(sys, "stderr", Terminal())
    assert batch(scans, "--out", tmp_path / "lines", *QUICK) == 1
    assert "7/7 [" not in sys.stderr.getvalue()
    assert capsys.readouterr().out.count("vertices, moved by") == 6


@pytest.mark.skipif(os.name == "nt", reason="pipes of Unix")
def test_pipes_in_a_folder_do_not_stop_it(scans, tmp_path):
    os.mkfifo(scans / "pipe.obj")
    (scans / "alias.obj").symlink_to(scans / "pipe.obj")
    found = {path.source.name for path in find_files([str(scans)], (".obj", ".ply"), tmp_path / "out")}
    assert found and not found & {"pipe.obj", "alias.obj"}
