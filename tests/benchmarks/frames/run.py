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

import checkout  # noqa: F401
from algorithms import MAX_VERTICES
from cases import LARGEST, case_names
from dilation import Cost, measure_all
from measuring import Row, run_all
from records import read_records, write_records
from science_page import update_page
from tables import (
    Results,
    cost_table,
    extra_table,
    frame_table,
    level_table,
    mean_table,
    preset_table,
    stencil_table,
)

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
    write_records(rows, arguments.output / RESULTS)
    if costs:
        write_records(costs, arguments.output / COSTS)
    say(text)
    say(f"Wrote frames.md and {RESULTS} in {arguments.output}.")
    if arguments.update:
        update_page({"algorithms and frames": sections["means"]})
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
        default=Path("build/benchmarks/frames"),
        help="folder for the tables, frames.md, and the CSV files",
    )
    parser.add_argument(
        "--again",
        type=Path,
        metavar="FOLDER",
        help="only write the tables again, from the CSV files of a run",
    )
    parser.add_argument("--update", action="store_true", help="write the table of means into docs")
    return parser.parse_args()


def make_sections(rows: list[Row], costs: list[Cost]) -> dict[str, str]:
    """Return the tables by the names that they have in the page."""
    results = Results(rows)
    sections = {
        "means": mean_table(results),
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
    return sections


def say(line: str) -> None:
    """Print a line at once."""
    print(line, flush=True)


if __name__ == "__main__":
    sys.exit(main())
