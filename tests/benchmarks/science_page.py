# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The page docs/science/benchmarks.md, whose tables the benchmarks write."""

from collections.abc import Mapping
from pathlib import Path

PAGE = Path(__file__).resolve().parents[2] / "docs" / "science" / "benchmarks.md"


def update_page(tables: Mapping[str, str], page: Path = PAGE) -> None:
    """Put tables between their marks in a page.

    Parameters
    ----------
    tables : mapping of str to str
        Markdown by the names of the marks.
    page : Path
        The page.

    Raises
    ------
    ValueError
        If the page has no marks of a name.
    """
    text = page.read_text(encoding="utf-8")
    for name, table in tables.items():
        begin, end = f"<!-- begin {name} -->\n", f"<!-- end {name} -->"
        if begin not in text or end not in text:
            raise ValueError(f"{page.name} has no place for the table {name!r}; add its two marks.")
        before, rest = text.split(begin, 1)
        text = before + begin + table + end + rest.split(end, 1)[1]
    page.write_text(text, encoding="utf-8")
