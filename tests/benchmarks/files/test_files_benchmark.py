# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The benchmark of files runs with what is there; times are not tested."""

import subprocess
import sys
from pathlib import Path

PROGRAM = Path(__file__).parent / "run.py"


def test_small_run():
    words = [sys.executable, str(PROGRAM), "--side", "20", "--repeats", "1"]
    result = subprocess.run(words, capture_output=True, text=True, timeout=300, check=False)
    assert result.returncode == 0, result.stderr
    rows = [line for line in result.stdout.splitlines() if line.startswith("| ")]
    assert len(rows) == 6 and "framelet on" not in result.stderr
    assert all(" s, " in row.split("|")[2] for row in rows[1:])
