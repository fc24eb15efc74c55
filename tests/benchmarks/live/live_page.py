# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables of what is measured live, on the screen and in `docs/science/benchmarks.md`."""

import argparse
import re
from pathlib import Path

PAGE = Path(__file__).resolve().parents[3] / "docs" / "science" / "benchmarks.md"


def table(unit, results, text_of):
    """Return the results as a table, a column for each mesh; `text_of` gives the text of a value."""
    lines = [
        f"| {unit} | " + " | ".join(f"{each['Vertices']:,} vertices" for each in results) + " |",
        "| --- |" + " --: |" * len(results),
    ]
    for name in list(results[0])[1:]:
        lines.append(f"| {name} | " + " | ".join(text_of(each[name]) for each in results) + " |")
    return "\n".join(lines) + "\n"


def with_table(text, found, marker):
    """Return the text of a page with a table between the comments `begin` and `end` of its marker."""
    between = re.compile(rf"(<!-- begin {marker} -->\n).*?(<!-- end {marker} -->)", re.DOTALL)
    return between.sub(lambda match: match[1] + found + match[2], text)


def run(description, sizes, measure, table_of, marker):
    """Measure each size with Framelet enabled, print the table, and write it if asked; return the results."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--sizes", type=int, nargs="+", default=sizes)
    parser.add_argument("--update", action="store_true")
    options = parser.parse_args()
    import loading  # noqa: F401  # makes the checkout the package

    # isort: split
    import framelet

    framelet.register()
    try:
        results = [measure(size) for size in options.sizes]
    finally:
        framelet.unregister()
    found = table_of(results)
    print(found)
    if options.update:
        PAGE.write_text(with_table(PAGE.read_text(encoding="utf-8"), found, marker), encoding="utf-8")
    return results
