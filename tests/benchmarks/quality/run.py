# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measure AUTO against published filters at their best, on models, noises and seeds.

    python3 .ci/environment.py run benchmarks -- tests/benchmarks/quality/run.py --rerun AUTO

Meshes come from the folder that FRAMELET_MESHES names, by default shared/meshes beside the checkout; without
one models are made in code. `cases.csv` has the best baselines of the development meshes, so that only AUTO
runs. `--methods LBNF GNF BILATERAL TAUBIN` runs the baselines again, which takes hours. What is in the output
folder already is not run again, unless `--rerun` names it.
"""

import argparse
import math
import os
import sys
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from time import perf_counter

import sources  # noqa: F401
from cases import QUICK_NOISES, SEEDS, CaseName, mesh_folder, model_names
from measuring import Row, Task, run_task
from methods import BASELINES, METHODS
from noise import NOISES
from records import write_records
from results import AUTO, KEPT, Line, combined, read_lines
from science_page import update_page
from store import Store
from tables import model_table, noise_table, summary, target_table


def main() -> int:
    """Run the benchmark and return the exit code."""
    arguments = parse()
    if arguments.meshes:
        os.environ["FRAMELET_MESHES"] = str(arguments.meshes.resolve())
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
    store = Store(arguments.output)
    cases = cases_of(names, arguments)
    if not arguments.tables:
        methods = arguments.methods or (list(METHODS) if arguments.quick else [AUTO])
        if not any(name in BASELINES for name in methods):
            known = {line.case for line in combined(store.rows, read_lines())}
            n_asked, cases = len(cases), [case for case in cases if case in known]
            if len(cases) < n_asked:
                say(f"{n_asked - len(cases)} cases have no baselines and are left out.")
        store.forget(arguments.rerun, cases)
        for method in METHODS.values():
            if method.name in methods and not method.is_available():
                say(f"{method.name} is left out: its library is not installed here.")
        run_missing(store, cases, methods, arguments.processes)
    lines = combined(store.rows, read_lines())
    write_results([line for line in lines if line.case in set(cases)], arguments.output)
    if arguments.update:
        write_records(lines, KEPT)
        measured = measured_of(lines)
        update_page({"quality": noise_table(measured), "quality targets": target_table(measured)})
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


def write_results(lines: list[Line], folder: Path) -> None:
    """Write and print the tables."""
    measured = measured_of(lines)
    if not measured:
        say("No case has results of AUTO and of the baselines yet; there is no table to write.")
        return
    write_records(measured, folder / "cases.csv")
    tables = {
        "By noise": noise_table(measured),
        "Targets": target_table(measured),
        "By model": model_table(measured),
    }
    text = "\n".join(f"## {title}\n\n{table}" for title, table in tables.items())
    (folder / "quality.md").write_text(f"{text}\n{summary(measured)}\n", encoding="utf-8")
    say(f"{text}\n{summary(measured)}")


def measured_of(lines: list[Line]) -> list[Line]:
    """Return the lines with a result of AUTO."""
    return [line for line in lines if not math.isnan(line.auto_angle)]


def parse() -> argparse.Namespace:
    """Return the options."""
    parser = argparse.ArgumentParser(description="Measure AUTO against published filters.")
    parser.add_argument("--meshes", type=Path, help="folder of the development meshes")
    parser.add_argument("--quick", action="store_true", help="two small models made in code, two noises")
    parser.add_argument("--only", nargs="+", default=[], metavar="MODEL", help="models, such as tri/fandisk")
    parser.add_argument(
        "--methods", nargs="+", default=[], metavar="METHOD", help=f"default: AUTO; {', '.join(METHODS)}"
    )
    parser.add_argument("--noises", nargs="+", choices=list(NOISES), help="default: all")
    parser.add_argument("--seeds", nargs="+", type=int, help="default: 0 1 2; 0 is the one of tuning")
    parser.add_argument(
        "--rerun", nargs="+", default=[], metavar="METHOD", help="forget the results of these methods first"
    )
    parser.add_argument("--tables", action="store_true", help="run nothing, only write the tables")
    parser.add_argument("--processes", type=int, default=1, help="runs at a time (default: %(default)s)")
    parser.add_argument(
        "--output", type=Path, default=Path("build/benchmarks/quality"), help="folder of what is measured"
    )
    parser.add_argument(
        "--update", action="store_true", help="write cases.csv beside this file, and the tables in docs"
    )
    return parser.parse_args()


def say(line: str) -> None:
    """Print a line at once."""
    print(line, flush=True)


if __name__ == "__main__":
    sys.exit(main())
