# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""The examples in the docstrings give what they say."""

import doctest
import importlib
import pkgutil

import pytest
from framelet.operators import batch

NAMES = [f"batch.{item.name}" for item in pkgutil.iter_modules(batch.__path__)]
NAMES += ["command_line.batch_task"]


@pytest.mark.parametrize("name", NAMES)
def test_examples(name):
    module = importlib.import_module(f"framelet.operators.{name}")
    found = doctest.testmod(module)
    assert found.failed == 0
    assert found.attempted or name.split(".")[1] in ("rows", "lock", "begun")
