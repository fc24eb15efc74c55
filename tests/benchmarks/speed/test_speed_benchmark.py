# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The speed benchmark runs, and its files say what they should; times are not tested."""

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
    """Folder with what a quick run of one method of each kind wrote."""
    folder = tmp_path_factory.mktemp("speed")
    result = run("--quick", "--skip", "thread", "Automatic", "Prismatic", "--output", folder)
    assert result.returncode == 0, result.stderr
    return folder


def test_every_run_has_its_stages(quick):
    with (quick / "speed.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert {row["what"] for row in rows} >= {"Tri-2", "Tri-2, shuffled", "Adaptive, 3 levels", "Free-Form"}
    for row in rows:
        assert float(row["all"]) > 0
        assert float(row["solve"]) > 0
        if row["what"] == "Tri-2":
            stages = sum(
                float(row[name])
                for name in ("check", "connectivity", "normalize", "stencils", "solve", "report")
            )
            assert 0.5 * float(row["all"]) < stages <= 1.001 * float(row["all"])
            assert float(row["rerun"]) > 0
            assert float(row["iteration"]) > 0 < float(row["floor"])
            assert float(row["estimate"]) > float(row["peak"])
    asked = sorted({int(row["asked"]) for row in rows})
    assert asked == [2000, 4000]


def test_tables_can_be_written_again(quick, tmp_path):
    again = run("--again", quick / "speed.csv", "--output", tmp_path)
    assert again.returncode == 0, again.stderr
    first, second = ((folder / "speed.csv").read_text(encoding="utf-8") for folder in (quick, tmp_path))
    assert first.splitlines()[0] == second.splitlines()[0]
    assert len(first.splitlines()) == len(second.splitlines())
    assert (quick / "speed.md").read_text(encoding="utf-8") == (tmp_path / "speed.md").read_text(
        encoding="utf-8"
    )


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        (("--only", "Tri-3"), "No run has 'Tri-3' in its name; the names are "),
        (("--only", "Tri-2", "--skip", "Tri", "x"), "No run has 'Tri-2' in its name without those that have"),
    ],
)
def test_a_name_that_fits_no_run_is_an_error(words, reason, tmp_path):
    folder = tmp_path / "speed"
    result = run("--quick", "--output", folder, *words)
    assert result.returncode == 2
    assert result.stderr.startswith(reason)
    assert len(result.stderr.splitlines()) == 1
    for name in ("‘Tri-2’", "‘Tri-2, shuffled’", "‘Adaptive, 3 levels’", "‘Automatic’"):
        assert result.stderr.count(name) == 1, "each name is told once, whatever the number of sizes"
    assert not folder.exists(), "nothing is written"


def test_the_best_of_several_runs():
    """In a Python of its own, as other benchmarks have modules of the same names."""
    tries = [{"stages": {"all": t, "rerun": r}, "peak": p} for t, r, p in ((3, 2, 1), (1, 9, 5), (2, 1, 7))]
    code = f"import sys; sys.path.insert(0, {str(PROGRAM.parent)!r}); import run; print(run.best_of({tries}))"
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert result.stdout.strip() == str({"stages": {"all": 1, "rerun": 1}, "peak": 5})
