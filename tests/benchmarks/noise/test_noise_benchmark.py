# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The benchmark of the noise estimate runs, and its table can be written again."""

import csv
import subprocess
import sys
from pathlib import Path

PROGRAM = Path(__file__).parent / "run.py"


def run(*words):
    """Run the benchmark in a fresh Python."""
    command = [sys.executable, str(PROGRAM), *map(str, words)]
    return subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)


def test_quick_run_and_table(tmp_path):
    result = run("--quick", "--output", tmp_path)
    assert result.returncode == 0, result.stderr
    with (tmp_path / "noise.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 2 * 12
    for row in rows:
        if row["kind"] in ("normals", "directions"):
            assert 0.85 < float(row["ratio"]) < 1.15, row
    text = (tmp_path / "noise.md").read_text(encoding="utf-8")
    assert "made/box_tri (1,538)" in text
    again = run("--again", tmp_path, "--output", tmp_path / "again")
    assert again.returncode == 0, again.stderr
    assert (tmp_path / "again" / "noise.md").read_text(encoding="utf-8") == text


def test_unknown_mesh(tmp_path):
    result = run("made/nothing", "--output", tmp_path)
    assert result.returncode == 2
    assert result.stderr.startswith("There is no mesh 'made/nothing'; choose from ")
