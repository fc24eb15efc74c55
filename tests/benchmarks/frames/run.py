# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compare presets, frames, stencils, levels and the bilateral baseline on noisy meshes.

It needs Python and NumPy only:

    python3 .ci/environment.py run core -- tests/benchmarks/frames/run.py

Meshes come from the folder that FRAMELET_MESHES names, by default shared/meshes beside the checkout; without
one they are made in code.
"""

import argparse
import sys
from pathlib import Path

import checkout
from algorithms import MAX_VERTICES
from cases import LARGEST, case_names
from dilation import Cost, measure_all
from measuring import Row, run_all
from records import read_records, write_records
from tables import (
    Results,
    cost_table,
    extra_table,
    frame_table,
    full_list,
    level_table,
    preset_table,
    stencil_table,
)

PAGE = checkout.ROOT / "docs" / "benchmarks.md"
LIST = checkout.ROOT / "docs" / "benchmarks_frames.md"
FOLDER = Path(__file__).resolve().parent
RESULTS, COSTS = "results.csv", "dilation.csv"


def main() -> int:
    """Run the benchmark and return the exit code."""
    arguments = parse()
    try:
        rows, costs = measure(arguments)
    except ValueError as error:
        print(error, file=sys.stderr)
        return 2
    sections = make_sections(rows, costs)
    text = "\n".join(f"## {title}\n\n{table}" for title, table in sections.items())
    arguments.output.mkdir(parents=True, exist_ok=True)
    (arguments.output / "frames.md").write_text(text, encoding="utf-8")
    for folder in [arguments.output, *([FOLDER] if arguments.update else [])]:
        write_records(rows, folder / RESULTS)
        if costs:
            write_records(costs, folder / COSTS)
    say(f"Wrote frames.md and {RESULTS} in {arguments.output}.")
    if arguments.update:
        update_page(sections)
        LIST.write_text(list_page(sections["list"]), encoding="utf-8")
        say("Updated the tables in docs.")
    return 0


def measure(arguments: argparse.Namespace) -> tuple[list[Row], list[Cost]]:
    """Return the results, of a new run or of an earlier one."""
    if arguments.again is not None:
        costs = arguments.again / COSTS
        rows = read_records(Row, arguments.again / RESULTS)
        return rows, read_records(Cost, costs) if costs.is_file() else []
    names = case_names(arguments.meshes, arguments.quick)
    rows = run_all(names, arguments.quick, arguments.processes, say)
    return rows, [] if arguments.quick or arguments.no_dilation else measure_all(say)


def parse() -> argparse.Namespace:
    """Return the options."""
    parser = argparse.ArgumentParser(
        description="Compare presets, frames, stencils and levels on noisy meshes."
    )
    parser.add_argument(
        "meshes",
        nargs="*",
        metavar="MESH",
        help=f"names such as tri/fandisk or made/box_quad (default: all with at most {LARGEST:,} vertices, "
        f"every frame up to {MAX_VERTICES:,})",
    )
    parser.add_argument("--quick", action="store_true", help="two small meshes made in code, few algorithms")
    parser.add_argument("--no-dilation", action="store_true", help="leave out time and memory of dilation")
    parser.add_argument("--processes", type=int, default=2, help="runs at a time (default: %(default)s)")
    parser.add_argument(
        "--output",
        type=Path,
        default=Path("build/benchmarks"),
        help="folder for the tables, frames.md, and the CSV files",
    )
    parser.add_argument(
        "--again",
        type=Path,
        metavar="FOLDER",
        help="only write the tables again, from the CSV files of a run",
    )
    parser.add_argument("--update", action="store_true", help="write the tables into docs as well")
    return parser.parse_args()


def make_sections(rows: list[Row], costs: list[Cost]) -> dict[str, str]:
    """Return the tables by the names that they have in the page."""
    results = Results(rows)
    sections = {
        "presets on triangles": preset_table(results, is_quad=False),
        "presets on quads": preset_table(results, is_quad=True),
        "levels of presets on triangles": extra_table(results, is_quad=False),
        "levels of presets on quads": extra_table(results, is_quad=True),
        "stencils": stencil_table(results),
        "levels": level_table(results),
        "frames on triangles": frame_table(results, is_quad=False),
        "frames on quads": frame_table(results, is_quad=True),
    }
    if costs:
        sections["dilation"] = cost_table(costs)
    sections["list"] = full_list(results)
    return sections


def update_page(sections: dict[str, str]) -> None:
    """Put the tables between the marks of the page."""
    text = PAGE.read_text(encoding="utf-8")
    for name, table in sections.items():
        begin, end = f"<!-- begin {name} -->\n", f"<!-- end {name} -->"
        if begin in text:
            before, rest = text.split(begin, 1)
            text = before + begin + table + end + rest.split(end, 1)[1]
    PAGE.write_text(text, encoding="utf-8")


def list_page(table: str) -> str:
    """Return the page with every result."""
    return (
        "# All results\n\n"
        "Written by `tests/benchmarks/frames/run.py --update`; [Benchmarks](benchmarks.md) explains the\n"
        "columns. Angles are in degrees, rms in mean edge lengths of the clean mesh, seconds on one thread.\n"
        "A λ with an asterisk is the smallest or the largest that was tried.\n"
        "The same as a CSV file: `tests/benchmarks/frames/results.csv`.\n\n" + table
    )


def say(line: str) -> None:
    """Print a line at once."""
    print(line, flush=True)


if __name__ == "__main__":
    sys.exit(main())
