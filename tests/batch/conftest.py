# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Folders of small meshes, and the command line in a process without Blender."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = f"""
import importlib.util, sys
sys.modules["bpy"] = None
root = {str(ROOT)!r}
spec = importlib.util.spec_from_file_location(
    "framelet", root + "/__init__.py", submodule_search_locations=[root]
)
package = importlib.util.module_from_spec(spec)
sys.modules["framelet"] = package
spec.loader.exec_module(package)
from framelet.operators.command_line import main
sys.exit(main())
"""
TIMES = ("seconds", "ended", "peak_bytes")
"""What differs between two runs that did the same."""


def obj(seed, n=8):
    """Return the text of a noisy sheet."""
    x, y = np.meshgrid(np.arange(n), np.arange(n), indexing="ij")
    z = np.random.default_rng(seed).normal(0, 0.1, x.shape)
    lines = [f"v {a} {b} {c:.6f}" for a, b, c in zip(x.ravel(), y.ravel(), z.ravel(), strict=True)]
    number = np.arange(n * n).reshape(n, n) + 1
    for a, b, c, d in zip(
        *(part.ravel() for part in (number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:])),
        strict=True,
    ):
        lines += [f"f {a} {b} {c}", f"f {a} {c} {d}"]
    return "\n".join(lines) + "\n"


@pytest.fixture
def scans(tmp_path):
    """A folder of six meshes, two of them in a folder of their own."""
    folder = tmp_path / "scans"
    (folder / "left").mkdir(parents=True)
    for number in range(4):
        (folder / f"{number}.obj").write_text(obj(number))
    for number in range(2):
        (folder / "left" / f"{number}.obj").write_text(obj(10 + number))
    return folder


def start(*words, **options):
    """Start the command line."""
    command = [sys.executable, "-c", PROGRAM, *map(os.fspath, words)]
    return subprocess.Popen(
        command, **{"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True, **options}
    )


def run(*words, code=0, **options):
    """Run the command line; return what it printed on each stream."""
    process = start(*words, **options)
    out, err = process.communicate(timeout=600)
    assert process.returncode == code, (out, err)
    return out, err


def rows_of(path):
    """Return the rows of a report, in order."""
    return [json.loads(line) for line in path.read_text().splitlines()]


def state_of(out):
    """Return all that a batch leaves, without times: the bytes of results, and the last row of each."""
    files = {
        path.relative_to(out).as_posix(): path.read_bytes()
        for path in out.rglob("*")
        if path.is_file() and not path.name.startswith("report.jsonl")
    }
    last = {}
    for line in (out / "report.jsonl").read_text().splitlines():
        try:
            row = json.loads(line)
        except ValueError:
            continue  # a run was killed as it wrote
        last[row["output"]] = _timeless(row)
    return files, last


def _timeless(value):
    if isinstance(value, dict):
        hidden = (*TIMES, "target")
        return {key: _timeless(item) for key, item in value.items() if key not in hidden}
    return [_timeless(item) for item in value] if isinstance(value, list) else value
