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
    monkeypatch.setattr(sys, "path", list(sys.path))
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
    text = program.PAGE.read_text("utf-8")
    assert len(program.TABLE.findall(text)) == 1
    for name in ("Amount", "Live Equalizer, a gain", "Smooth of Blender, a factor"):
        assert f"| {name} |" in text


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
    text = preview.PAGE.read_text("utf-8")
    assert len(preview.TABLE.findall(text)) == 1 and all(f"| {name} |" in text for name in names)
