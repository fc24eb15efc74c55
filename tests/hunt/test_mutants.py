# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The rooms of the mutants have code and tests: with a wrong name `make mutants` ended before the files."""

import pytest

from .mutants import EXPLAINED, ROOMS, ROOT, files_of


@pytest.mark.parametrize("room", ROOMS)
def test_code_and_told_by_a_room_are_there(room):
    code, tests = ROOMS[room]
    assert files_of(code)
    assert [name for name in tests if not (ROOT / "tests" / name).exists()] == []


def test_explained_mutants_are_of_code_that_is_there():
    for name in EXPLAINED:
        path, change = name.split(": ", 1)
        assert (ROOT / path).is_file() and "  ->  " in change
