# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Command lines, manifests and reports that nobody would write: one sentence, or what they say.

`FRAMELET_FUZZ` says how many of each, as in `test_fuzz.py`.
"""

import argparse
import json
import os

import numpy as np
import pytest
from framelet.operators.batch import rows
from framelet.operators.batch.inputs import PlanError
from framelet.operators.batch.manifest import read_manifest
from framelet.operators.command_line.parser import make_parser

from .made import sheet, with_normals
from .test_fuzz import mutated

N_EACH = int(os.environ.get("FRAMELET_FUZZ", "300")) // 3

MANIFESTS = {
    "a.csv": b"input,output,format,preset,strength,weld,iterations\n"
    b'a.ply,b/a.ply,,tri-2,,true,5\n"a b.ply",,stl,auto,0.5,false,\na.ply,c.obj,obj,,,,\n',
    "a.jsonl": b'{"input": "a.ply", "output": "b/a.ply", "preset": "tri-2", "weld": true, "iterations": 5}\n'
    b'{"input": "a b.ply", "strength": 0.5, "format": "stl"}\n\n{"input": "a.ply", "output": null}\n',
}
NESTED = b"[" * 100_000
"""So deep that a parser of JSON gives up, other than by saying what is wrong."""

HOSTILE_WORDS = [
    *(
        "",
        " ",
        "-",
        "--",
        "-1",
        "0",
        "1e999",
        "nan",
        "-inf",
        "NaN",
        "1e-400",
        "9" * 400,
        "0x10",
        "½",
        "١",
        "1_0",
    ),
    *(
        "\udce9",
        "a\0b",
        "x" * 300,
        "\n",
        "'",
        "%s",
        "{0}",
        "../..",
        ".",
        "*",
        "[",
        "a=b",
        "true",
        "tri-2",
        "auto",
    ),
]


def test_damaged_manifests(tmp_path):
    rng = np.random.default_rng(1)
    n_read = 0
    for name, content in MANIFESTS.items():
        for number in range(N_EACH // 2):
            path = tmp_path / name
            damaged = mutated(content, rng)
            path.write_bytes(damaged)
            try:
                found = read_manifest(path)
            except PlanError as error:
                assert "\n" not in str(error) and str(error).endswith("."), (number, damaged)
                continue
            n_read += 1
            for row in found:
                assert row.error or row.source.name, (number, damaged)
                assert all(word.startswith("--") for word in row.options)
    assert n_read > N_EACH // 10


def test_a_manifest_that_is_nested_too_deep_is_refused(tmp_path):
    path = tmp_path / "a.jsonl"
    path.write_bytes(b'{"input": ' + NESTED)
    with pytest.raises(PlanError, match="line 1, is no JSON"):
        read_manifest(path)


@pytest.mark.parametrize("name", MANIFESTS)
def test_damaged_manifests_by_the_door(command, tmp_path, name):
    """The whole plan is made, and nothing is done."""
    rng = np.random.default_rng(2)
    path = tmp_path / name
    for number in range(max(N_EACH // 20, 1)):
        damaged = mutated(MANIFESTS[name], rng)
        path.write_bytes(damaged)
        result = command("batch", "--manifest", path, "--out", tmp_path / "out", "--dry-run")
        assert result.code in (0, 1, 2) and "Traceback" not in result.err, (number, damaged, result.err)
        assert result.code == 0 or result.err.splitlines()[-1].startswith("framelet: "), (damaged, result.err)
        assert not (tmp_path / "out").exists()


def test_damaged_reports_are_read_as_far_as_they_are_whole(tmp_path):
    rng = np.random.default_rng(3)
    lines = [
        json.dumps(
            {"output": f"{k}.ply", "status": "done", "ended": 1.5 + k, "key": "a", "input_sha256": "b"}
        )
        for k in range(4)
    ]
    content = "\n".join(lines).encode() + b"\n"
    path = tmp_path / "report.jsonl"
    for number in range(N_EACH):
        damaged = mutated(content, rng)
        path.write_bytes(damaged)
        found = rows.read_rows([path])
        for name, row in found.items():
            assert row["output"] == name and isinstance(row["status"], str), (number, damaged)
        whole = sum(line.encode() in damaged.split(b"\n") for line in lines)
        assert len(found) >= whole - 1, (number, damaged)  # a hostile line may take the name of another one


def test_a_line_of_a_report_that_is_nested_too_deep_is_passed_over(tmp_path):
    path = tmp_path / "report.jsonl"
    path.write_bytes(NESTED + b'\n{"output": "a.ply", "status": "done", "ended": 1}\n')
    assert list(rows.read_rows([path])) == ["a.ply"]


def options_of(parser):
    """Return the options of every command, with whether each takes a value."""
    (commands,) = (action for action in parser._actions if isinstance(action, argparse._SubParsersAction))
    return {
        name: [
            (action.option_strings[-1], action.nargs != 0, [str(choice) for choice in action.choices or ()])
            for action in command._actions
            if action.option_strings
            and action.option_strings[-1] not in ("--help", "--scheduler", "--report")
        ]
        for name, command in commands.choices.items()
    }


def test_command_lines_that_nobody_would_write(command, tmp_path, monkeypatch):
    """Exit code 0, 1 or 2, no traceback, and a sentence for what cannot be."""
    monkeypatch.chdir(tmp_path)
    source = tmp_path / "in.ply"
    source.write_bytes(with_normals(*sheet(), np.zeros((len(sheet()[0]), 3)), "binary_little_endian"))
    before, known = source.read_bytes(), options_of(make_parser("framelet"))
    rng = np.random.default_rng(4)
    for number in range(N_EACH):
        name = str(rng.choice(list(known)))
        words = [name, *(["in.ply", "out.ply"] if rng.random() < 0.8 else [])]
        for index in rng.integers(len(known[name]), size=rng.integers(0, 4)):
            option, takes_value, choices = known[name][index]
            if option in ("--in-place", "--overwrite", "--force"):
                continue
            words.append(option)
            if takes_value or rng.random() < 0.1:
                pool = choices if choices and rng.random() < 0.5 else HOSTILE_WORDS
                words.append(str(rng.choice(pool)))
        if rng.random() < 0.2:
            words.insert(int(rng.integers(len(words) + 1)), str(rng.choice(HOSTILE_WORDS)))
        result = command(*words)
        assert result.code in (0, 1, 2) and "Traceback" not in result.err, (number, words, result.err)
        if result.code:
            last = result.err.splitlines()[-1]
            assert last.startswith("framelet: ") and last.endswith((".", ".)")), (number, words, result.err)
        assert source.read_bytes() == before, (number, words)
