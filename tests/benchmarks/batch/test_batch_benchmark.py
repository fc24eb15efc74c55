# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The benchmark of batches runs with few files; times are not tested."""

import subprocess
import sys
from pathlib import Path

import pytest

PROGRAM = Path(__file__).parent / "run.py"


def test_small_run():
    pytest.importorskip("distributed", reason="Dask distributed is not installed (framelet[farm])")
    words = [sys.executable, str(PROGRAM), "--files", "4", "--side", "8", "--preset", "tri-2", "--jobs", "2"]
    result = subprocess.run(words, capture_output=True, text=True, timeout=300, check=False)
    assert result.returncode == 0, result.stderr
    rows = [line for line in result.stdout.splitlines() if line.startswith("| ")][1:]
    assert [row.split(" | ")[0] for row in rows] == ["| one after the other", "| --jobs 2"]
    assert all(row.count(" ms ") == 4 for row in rows)
