# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The benchmark of sliders runs, and what it measures is quicker than computing."""

import importlib.util
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def program(monkeypatch):
    monkeypatch.setattr(sys, "path", [str(ROOT / "tests" / "benchmarks" / "live"), *sys.path])
    path = ROOT / "tests" / "benchmarks" / "live" / "run.py"
    spec = importlib.util.spec_from_file_location("live_benchmark", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_a_small_mesh(program):
    found = program.measure(2000, rounds=3)
    assert found["Vertices"] == pytest.approx(2000, rel=0.1)
    assert all(value > 0.0 for value in found.values())
    assert found["Live Equalizer, a gain"] < found["Storing the levels, once"]
    lines = program.table([found, found]).splitlines()
    assert len(lines) == 2 + len(found) - 1 and lines[0].count(" vertices |") == 2


def test_the_page_has_the_table(program):
    names = ("Amount", "Live Equalizer, a gain", "Smooth of Blender, a factor")
    check_page(program.live_page, "sliders", names)


def test_the_preview_is_measured(monkeypatch):
    monkeypatch.setattr(sys, "path", [str(ROOT / "tests" / "benchmarks" / "live"), *sys.path])
    import preview

    found = preview.measure(400)
    assert found["Vertices"] == pytest.approx(400, rel=0.1)
    names = list(found)[1:]
    assert all(wall > 0.0 and processor > 0.0 for wall, processor in map(found.get, names))
    assert found["Strength 0.6: first picture"][1] < found["Strength 0.6: result"][1]
    lines = preview.table([found]).splitlines()
    assert len(lines) == 2 + len(names) and "400" not in lines[2]
    check_page(preview.live_page, "preview", names)


def check_page(live_page, marker, names):
    """Fail unless the page has the table, and a new one takes the place of it alone."""
    text = live_page.PAGE.read_text("utf-8")
    before, rest = text.split(f"<!-- begin {marker} -->\n")
    old, after = rest.split(f"<!-- end {marker} -->")
    assert all(f"| {name} |" in old for name in names)
    changed = live_page.with_table(text, "new\n", marker)
    assert changed == f"{before}<!-- begin {marker} -->\nnew\n<!-- end {marker} -->{after}"
