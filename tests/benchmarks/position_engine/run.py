# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measure what would make the position engine better, each change with a λ of its own.

It needs Python and NumPy only:

    python3 .ci/environment.py run core -- tests/benchmarks/position_engine/run.py

Meshes come from the folder that FRAMELET_MESHES names, by default shared/meshes beside the checkout; without
one they are made in code.
"""

import argparse
import sys
from pathlib import Path

import position_sources
from cases import CaseName, mesh_folder, model_names
from records import read_records, write_records
from shapes import MADE
from trial_tables import make_sections
from trials import FACTORS, QUICK_FACTORS, Trial, run_case

PAGE = position_sources.ROOT / "docs" / "benchmarks_positions.md"
RESULTS = "trials.csv"
MODELS = (
    "tri/fandisk",
    "tri/cadarm2k",
    "tri/arm8k",
    "tri/plate5k",
    "tri/camelhead_open11k",
    "quad/fandisk1742",
    "quad/bunny_hexsurf7706",
    "quad/spot2930",
    "quad/horse2400",
)
NOISES = ("normal 0.1", "normal 0.3", "normal 0.5")
QUICK_NOISES = ("normal 0.1", "normal 0.3")
SEED = 0


def main() -> int:
    """Run the benchmark and return the exit code."""
    arguments = parse()
    try:
        trials = measure(arguments)
    except ValueError as error:
        print(error, file=sys.stderr)
        return 2
    arguments.output.mkdir(parents=True, exist_ok=True)
    for folder in [arguments.output, *([position_sources.FOLDER] if arguments.update else [])]:
        write_records(trials, folder / RESULTS)
    sections = make_sections(trials)
    text = "\n".join(f"## {title}\n\n{table}" for title, table in sections.items())
    (arguments.output / "positions.md").write_text(text, encoding="utf-8")
    if arguments.update:
        update_page(sections)
    say(f"Wrote positions.md and {RESULTS} in {arguments.output}.")
    return 0


def measure(arguments: argparse.Namespace) -> list[Trial]:
    """Return the results, of a new run or of an earlier one."""
    if arguments.again is not None:
        return read_records(Trial, arguments.again / RESULTS)
    usual = list(MODELS) if mesh_folder() is not None else list(MADE)
    wanted = arguments.models or ([] if arguments.quick else usual)
    trials: list[Trial] = []
    for model in model_names(wanted, arguments.quick):
        for noise in QUICK_NOISES if arguments.quick else NOISES:
            factors = QUICK_FACTORS if arguments.quick else FACTORS
            trials += run_case(CaseName(model, noise, SEED), factors)
            say(f"{model}, {noise}: {len(trials):,} results")
    kinds = {trial.is_quad for trial in trials}
    if len(kinds) < 2:
        raise ValueError(
            "There is a table for each kind of faces; name a model of triangles and one of quads."
        )
    return trials


def parse() -> argparse.Namespace:
    """Return the options."""
    parser = argparse.ArgumentParser(description="Measure what would make the position engine better.")
    parser.add_argument("models", nargs="*", metavar="MODEL", help=f"default: {', '.join(MODELS)}")
    parser.add_argument("--quick", action="store_true", help="two small models made in code, two noises")
    parser.add_argument(
        "--output", type=Path, default=Path("build/benchmarks"), help="folder for the results"
    )
    parser.add_argument(
        "--again", type=Path, metavar="FOLDER", help="only write the tables again, from a CSV file"
    )
    parser.add_argument("--update", action="store_true", help="write docs/benchmarks_positions.md as well")
    return parser.parse_args()


def update_page(sections: dict[str, str]) -> None:
    """Put the tables between the marks of the page."""
    text = PAGE.read_text(encoding="utf-8")
    for name, table in sections.items():
        begin, end = f"<!-- begin {name} -->\n", f"<!-- end {name} -->"
        before, rest = text.split(begin, 1)
        text = before + begin + table + end + rest.split(end, 1)[1]
    PAGE.write_text(text, encoding="utf-8")


def say(line: str) -> None:
    """Print a line at once."""
    print(line, flush=True)


if __name__ == "__main__":
    sys.exit(main())
