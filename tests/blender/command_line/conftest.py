# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Small mesh files, written and read without Blender, and a way to call the command line."""

import sys
from pathlib import Path

import pytest
from file_fixtures import command, fails, grid, read_obj, read_ply, write_obj, write_ply  # noqa: F401

ROOT = Path(__file__).resolve().parents[3]

# What the console script does, for Pythons in which the package is not installed.
LAUNCHER = f"""
import importlib.util, sys
root = {str(ROOT)!r}
spec = importlib.util.spec_from_file_location(
    "framelet", root + "/__init__.py", submodule_search_locations=[root]
)
package = importlib.util.module_from_spec(spec)
sys.modules["framelet"] = package
spec.loader.exec_module(package)
"""


@pytest.fixture
def launcher():
    """Give what begins the code of a fresh Python: it makes the package importable."""
    return LAUNCHER


@pytest.fixture
def python():
    """Give the running Python."""
    return sys.executable
