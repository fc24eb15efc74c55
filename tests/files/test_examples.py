# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""The examples in the docstrings give what they say."""

import doctest
import importlib
import pkgutil

import pytest
from framelet.operators import files

NAMES = [name for _finder, name, _is_package in pkgutil.iter_modules(files.__path__)]


@pytest.mark.parametrize("name", NAMES)
def test_examples(name):
    module = importlib.import_module(f"framelet.operators.files.{name}")
    assert doctest.testmod(module).failed == 0


def test_most_modules_have_examples():
    modules = [importlib.import_module(f"framelet.operators.files.{name}") for name in NAMES]
    assert sum(doctest.testmod(module).attempted > 0 for module in modules) >= 10
