# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Imports point one way: ui, operators, core, and without a circle among the rooms of each."""

import ast
import re
from functools import cache
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
LAYERS = ("core", "operators", "ui")
SYSTEM = {
    *("os", "platform", "ctypes", "resource", "signal", "subprocess", "multiprocessing", "shutil", "socket"),
    *("sys.platform", "sys.getwindowsversion", "a path of the system"),
}
"""Modules and names by which a program asks the operating system."""


def room_of(name):
    """Return the room of a module: its folder, or the module itself beside the folders."""
    parts = name.split(".")
    return ".".join(parts[:2])


def imports_of(path):
    """Yield the modules that a file imports by relative names, as dotted names from the root."""
    package = path.relative_to(ROOT).parent.parts
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.level:
            base = [*package[: len(package) - node.level + 1], *(node.module or "").split(".")]
            base = [part for part in base if part]
            for alias in node.names:
                is_module = ROOT.joinpath(*base, alias.name).with_suffix(".py").exists()
                is_room = ROOT.joinpath(*base, alias.name).is_dir()
                yield ".".join([*base, alias.name] if is_module or is_room else base)


@cache
def arrows_of(layer):
    """Return, for each room of a layer, what it imports of the project."""
    arrows = {}
    for path in sorted((ROOT / layer).rglob("*.py")):
        name = ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")
        if name != layer:
            arrows.setdefault(room_of(name), set()).update(imports_of(path))
    return arrows


@pytest.mark.parametrize("layer", LAYERS)
def test_layers_know_those_below_only(layer):
    below = LAYERS[: LAYERS.index(layer) + 1]
    for room, names in arrows_of(layer).items():
        assert {name.split(".")[0] for name in names} <= set(below), room


def asks_the_system(path):
    """Yield what a file uses of the operating system, by line."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        names = []
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and not node.level:
            names = [node.module, *(f"{node.module}.{alias.name}" for alias in node.names)]
        elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            names = [f"{node.value.id}.{node.attr}"]
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            names = ["a path of the system"] if re.search(r"/(proc|sys|dev|etc|tmp)/", node.value) else []
        for name in names:
            if name.split(".")[0] in SYSTEM or name in SYSTEM:
                yield f"{path.relative_to(ROOT)}:{node.lineno} {name}"


def test_core_knows_no_operating_system():
    found = [line for path in sorted((ROOT / "core").rglob("*.py")) for line in asks_the_system(path)]
    assert not found, found
    assert list(asks_the_system(ROOT / "operators" / "machine.py")), "the test sees nothing"


@pytest.mark.parametrize("layer", LAYERS)
def test_no_rooms_import_each_other(layer):
    graph = {
        room: {room_of(name) for name in names if name.startswith(f"{layer}.")} - {room}
        for room, names in arrows_of(layer).items()
    }
    assert len(graph) > 3
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        pytest.fail(" -> ".join(error.args[1]))
