# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Manifests whose rows say what cannot be: a sentence for the row, and the other rows are worked on."""

import json
import sys

import pytest
from framelet.operators.command_line import main

from .conftest import obj, rows_of


def run(folder, name, *words):
    """Run a batch of a manifest in this process; return its exit code."""
    given = ("batch", "--manifest", folder / name, "--out", folder / "out", "--preset", "tri-2", *words)
    return main([str(word) for word in given])


@pytest.fixture
def folder(tmp_path):
    for name in ("a.obj", "b.obj", "a\u2028.obj", "a\x85.obj", "a\nb.obj"):
        (tmp_path / name).write_text(obj(1))
    return tmp_path


def run_rows(folder, rows, code):
    """Run a batch of these rows and a good one; return the errors of the rows."""
    lines = [json.dumps(row, ensure_ascii=False) for row in [*rows, {"input": "b.obj", "output": "good.obj"}]]
    (folder / "a.jsonl").write_text("\n".join(lines), "utf-8", errors="surrogatepass")
    before = {path: path.read_bytes() for path in folder.glob("*.obj")}
    assert run(folder, "a.jsonl") == code
    assert {path: path.read_bytes() for path in folder.glob("*.obj")} == before
    assert (folder / "out" / "good.obj").is_file()
    return [row["error"] for row in rows_of(folder / "out" / "report.jsonl") if row["status"] == "failed"]


@pytest.mark.parametrize(
    ("row", "message"),
    [
        ({"input": ["a.obj"]}, "‘input’ is ['a.obj']; it must be a text"),
        ({"input": 5}, "‘input’ is 5; it must be a text"),
        ({"input": True}, "‘input’ is True; it must be a text"),
        ({"input": None}, "names no input"),
        ({"input": "a.obj", "output": {"x": 1}}, "‘output’ is {'x': 1}; it must be a text"),
        ({"input": "a.obj", "format": 3}, "‘format’ is 3; it must be a text"),
        ({"input": "a\0.obj"}, "no file can be named as ‘input’ is"),
        ({"input": "a.obj", "output": "x\0.obj"}, "no file can be named as ‘output’ is"),
        ({"input": "a.obj", "output": "x/"}, "out/x is no mesh file"),
        ({"input": "a.obj", "output": "report.jsonl"}, "out/report.jsonl is no mesh file"),
        ({"input": "a.obj", "output": "../a.obj"}, "leaves the folder"),
        ({"input": "a.obj", "output": "x" * 300 + ".obj"}, "name too long"),
        ({"input": "a.obj", "strength": [1]}, "'[1]' is not a number"),
        ({"input": "a.obj", "strength": float("nan")}, "Strength is nan"),
        ({"input": "a.obj", "in_place": True}, "unrecognized arguments: --in-place"),
        ({"input": "a.obj", "overwrite": True}, "unrecognized arguments: --overwrite"),
    ],
)
def test_a_row_that_cannot_be_is_told(folder, row, message):
    (error,) = run_rows(folder, [row], 1)
    assert message.lower() in error.lower() and "\n" not in error and error.endswith((".", ".)"))


def test_half_of_a_letter_is_no_name(folder):
    (folder / "a.jsonl").write_text('{"input": "a\\ud800.obj"}\n{"input": "b.obj"}\n')
    assert run(folder, "a.jsonl") == 1
    failed, done = sorted(rows_of(folder / "out" / "report.jsonl"), key=lambda row: row["status"] == "done")
    assert "no file can be named as ‘input’ is" in failed["error"] and done["status"] == "done"


@pytest.mark.parametrize("name", ["a\u2028.obj", "a\x85.obj", "a\nb.obj"])
def test_names_with_line_ends_are_names(folder, name):
    assert run_rows(folder, [{"input": name, "output": f"new {name}"}], 0) == []
    assert (folder / "out" / f"new {name}").is_file()


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        ([("a.obj", "x.obj"), ("b.obj", "x.obj")], "would both be written"),
        ([("a.obj", "x.obj"), ("b.obj", "./y/../x.obj")], "would both be written"),
        ([("a.obj", ""), ("a.obj", "")], "would both be written"),
        ([("a.obj", "../b.obj"), ("b.obj", "")], "is read and would be written"),
    ],
)
def test_rows_that_get_in_each_others_way_stop_all(folder, capsys, rows, message):
    lines = [json.dumps({"input": source, "output": output}) for source, output in rows]
    (folder / "a.jsonl").write_text("\n".join(lines))
    before = {path: path.read_bytes() for path in folder.iterdir()}
    assert run(folder, "a.jsonl", "--allow-outside") == 2
    assert message in capsys.readouterr().err
    assert {path: path.read_bytes() for path in folder.iterdir()} == before


@pytest.mark.parametrize(
    ("first", "second", "systems"),
    [
        ("x.obj", "x.obj", ("linux", "darwin")),
        ("x.obj", "X.OBJ", ("darwin",)),
        ("\u00e1.obj", "a\u0301.obj", ("darwin",)),
        ("x.obj", "y.obj", ()),
    ],
)
@pytest.mark.parametrize("system", ["linux", "darwin"])
def test_names_that_a_disk_takes_for_one(folder, capsys, monkeypatch, system, first, second, systems):
    rows = [{"input": "a.obj", "output": first}, {"input": "b.obj", "output": second}]
    (folder / "a.jsonl").write_text("\n".join(map(json.dumps, rows)))
    monkeypatch.setattr(sys, "platform", system)
    assert run(folder, "a.jsonl") == (2 if system in systems else 0)
    assert ("would both be written" in capsys.readouterr().err) == (system in systems)


def test_two_columns_of_one_name_are_refused(folder, capsys):
    (folder / "a.csv").write_text("input,strength,input\na.obj,0.5,b.obj\n")
    assert run(folder, "a.csv") == 2
    assert "has two columns ‘input’; leave one of them out" in capsys.readouterr().err
