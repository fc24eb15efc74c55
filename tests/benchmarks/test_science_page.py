# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables go between their marks and nowhere else."""

import sys
from pathlib import Path

import pytest

sys.path.append(str(Path(__file__).resolve().parent))

from science_page import update_page


def test_a_table_takes_the_place_of_the_old_one(tmp_path):
    page = tmp_path / "page.md"
    page.write_text("a\n<!-- begin x -->\nold\n<!-- end x -->\nb\n", encoding="utf-8")
    update_page({"x": "| new |\n"}, page)
    update_page({"x": "| newer |\n"}, page)
    assert page.read_text(encoding="utf-8") == "a\n<!-- begin x -->\n| newer |\n<!-- end x -->\nb\n"


def test_a_table_without_a_place_is_refused(tmp_path):
    page = tmp_path / "page.md"
    page.write_text("a\n", encoding="utf-8")
    with pytest.raises(ValueError, match="no place for the table 'x'"):
        update_page({"x": "| new |\n"}, page)
    assert page.read_text(encoding="utf-8") == "a\n"
