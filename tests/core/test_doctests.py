# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The examples in docstrings of the core and on the page for researchers."""

import doctest
import importlib
import pkgutil
from pathlib import Path

import framelet.core as core
import numpy as np
import pytest

PAGE = Path(core.__file__).resolve().parents[1] / "docs" / "scripts" / "library.md"
MODULES = [item.name for item in pkgutil.walk_packages(core.__path__, "framelet.core.")]


@pytest.mark.parametrize("name", MODULES)
def test_examples_of_docstrings(name):
    module = importlib.import_module(name)
    names = {"np": np} | {each: getattr(core, each) for each in core.__all__}
    found = doctest.testmod(module, extraglobs=names, optionflags=doctest.ELLIPSIS)
    assert found.failed == 0


def test_the_page_for_researchers():
    found = doctest.testfile(str(PAGE), module_relative=False, optionflags=doctest.ELLIPSIS)
    assert found.failed == 0 and found.attempted > 15


def test_there_are_examples():
    """The entrances have some."""
    for name in ("denoise", "estimate_noise", "compare", "FrameTransform", "split_bregman", "SurfaceMesh"):
        assert ">>> " in getattr(core, name).__doc__, name
