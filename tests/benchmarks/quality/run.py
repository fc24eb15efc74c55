# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compare Framelet's presets with published filters at their best, on models, noises and seeds.

    python3 .ci/environment.py run benchmarks -- tests/benchmarks/quality/run.py

Meshes come from the folder that FRAMELET_MESHES names, by default shared/meshes beside the checkout; without
one models are made in code. What is in the CSV files already is not run again.
"""

import argparse
import os
import sys
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from importlib.util import find_spec
from multiprocessing import get_context
from pathlib import Path
from time import perf_counter

import sources
from cases import QUICK_NOISES, SEEDS, CaseName, mesh_folder, model_names
from measuring import Row, Task, run_task
from methods import METHODS
from noise import NOISES
from results import Results
from store import Store
from tables import full_table, method_table, model_table, problem_table, target_table, write_wide

PAGE = sources.ROOT / "docs" / "benchmarks_quality.md"
PLOT = sources.ROOT / "docs" / "images" / "quality.png"


def main() -> int:
    """Run the benchmark and return the exit code."""
    arguments = parse()
    if arguments.meshes:
        os.environ["FRAMELET_MESHES"] = str(arguments.meshes.resolve())
    folder = arguments.output or (Path("build/quality") if arguments.quick else sources.FOLDER)
    try:
        names = model_names(arguments.only, arguments.quick)
        for method in (*arguments.methods, *arguments.rerun):
            if method not in METHODS:
                raise ValueError(f"There is no method {method!r}; choose from {', '.join(METHODS)}.")
    except ValueError as error:
        print(error, file=sys.stderr)
        return 2
    if mesh_folder() is None:
        say("There are no development meshes; models are made in code.")
    store = Store(folder)
    if not arguments.tables:
        cases = cases_of(names, arguments)
        store.forget(arguments.rerun, cases)
        methods = arguments.methods or list(METHODS)
        for method in METHODS.values():
            if method.name in methods and not method.is_available():
                say(f"{method.name} is left out: its library is not installed here.")
        run_missing(store, cases, methods, arguments.processes)
    write_results(store, folder, is_for_docs=arguments.update)
    return 0


def cases_of(names: list[str], arguments: argparse.Namespace) -> list[CaseName]:
    """Return the cases that are wanted, seed by seed: tuned settings come before they are needed."""
    noises = arguments.noises or (QUICK_NOISES if arguments.quick else list(NOISES))
    seeds = arguments.seeds or (SEEDS[:2] if arguments.quick else SEEDS)
    return [CaseName(name, noise, seed) for seed in sorted(seeds) for name in names for noise in noises]


def run_missing(store: Store, cases: list[CaseName], methods: list[str], n_processes: int) -> None:
    """Run what the store does not have."""
    began = perf_counter()
    for seed in dict.fromkeys(case.seed for case in cases):
        tasks = [task for case in cases if case.seed == seed and (task := store.task(case, methods))]
        for number, (task, rows) in enumerate(run_tasks(tasks, n_processes), 1):
            store.add(rows)
            case = task.case
            say(
                f"seed {seed}: {number} of {len(tasks)}, {case.model}, {case.noise}, "
                f"{perf_counter() - began:.0f} s"
            )


def run_tasks(tasks: list[Task], n_processes: int) -> Iterator[tuple[Task, list[Row]]]:
    """Yield tasks with their rows as they are done, in order."""
    if n_processes < 2:
        yield from ((task, run_task(task)) for task in tasks)
        return
    for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ[variable] = "1"
    with ProcessPoolExecutor(n_processes, get_context("spawn")) as pool:
        yield from zip(tasks, pool.map(run_task, tasks), strict=True)


def write_results(store: Store, folder: Path, is_for_docs: bool) -> None:
    """Write the one table as a CSV file, the tables for people, and the plot."""
    results = Results(store.rows)
    if not results.cases:
        say("No case has results of AUTO and of the baselines yet; there is no table to write.")
        return
    write_wide(results, folder / "results.csv")
    sections = make_sections(results)
    text = "\n".join(f"## {title}\n\n{table}" for title, table in sections.items())
    (folder / "quality.md").write_text(text, encoding="utf-8")
    if is_for_docs:
        update_page(sections)
    if find_spec("matplotlib") is None:
        say("matplotlib is not installed here; the plot is left out.")
    else:
        from plot import draw

        draw(results, PLOT if is_for_docs else folder / "quality.png")
    say(f"Wrote results.csv and quality.md in {folder}" + (", and updated docs." if is_for_docs else "."))


def make_sections(results: Results) -> dict[str, str]:
    """Return the tables by the names that they have in the page."""
    return {
        "targets": target_table(results),
        "methods": method_table(results),
        "models": model_table(results),
        "misses": problem_table(results),
        "cases": full_table(results),
    }


def update_page(sections: dict[str, str]) -> None:
    """Put the tables between the marks of the page."""
    text = PAGE.read_text(encoding="utf-8")
    for name, table in sections.items():
        begin, end = f"<!-- begin {name} -->\n", f"<!-- end {name} -->"
        before, rest = text.split(begin, 1)
        text = before + begin + table + end + rest.split(end, 1)[1]
    PAGE.write_text(text, encoding="utf-8")


def parse() -> argparse.Namespace:
    """Return the options."""
    parser = argparse.ArgumentParser(description="Compare Framelet's presets with published filters.")
    parser.add_argument("--meshes", type=Path, help="folder of the development meshes")
    parser.add_argument("--quick", action="store_true", help="two small models made in code, two noises")
    parser.add_argument("--only", nargs="+", default=[], metavar="MODEL", help="models, such as tri/fandisk")
    parser.add_argument("--methods", nargs="+", default=[], metavar="METHOD", help=", ".join(METHODS))
    parser.add_argument("--noises", nargs="+", choices=list(NOISES), help="default: all")
    parser.add_argument("--seeds", nargs="+", type=int, help="default: 0 1 2; 0 is the one of tuning")
    parser.add_argument(
        "--rerun", nargs="+", default=[], metavar="METHOD", help="forget the results of these methods first"
    )
    parser.add_argument("--tables", action="store_true", help="run nothing, only write tables and plot")
    parser.add_argument("--processes", type=int, default=1, help="runs at a time (default: %(default)s)")
    parser.add_argument("--output", type=Path, help="folder of the CSV files (default: the benchmark's own)")
    parser.add_argument("--update", action="store_true", help="write page and plot into docs")
    return parser.parse_args()


def say(line: str) -> None:
    """Print a line at once."""
    print(line, flush=True)


if __name__ == "__main__":
    sys.exit(main())
