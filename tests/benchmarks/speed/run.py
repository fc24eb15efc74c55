# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measure seconds and peak memory of Framelet and of other programs, stage by stage, each run by itself.

    python3 .ci/environment.py run speed -- tests/benchmarks/speed/run.py

Writes a table, a CSV file and a plot. Runs follow each other, so that none takes the other's cores.
"""

import argparse
import json
import subprocess
import sys
from pathlib import Path

import loading
from plan import OTHERS, QUICK_SIZES, SIZES, make_plan
from science_page import update_page
from shapes import torus_file
from tables import COLUMNS, PAGE_RUNS, full_table, read_rows, seconds_table, target_table, write_rows

FOLDER = Path(__file__).resolve().parent
TIMEOUT = 900
"""Seconds after which a run is given up."""

SHORT = 10.0
REPEATS = 3
"""Runs of fewer seconds are made so many times; the best one counts."""


def main():
    """Run the benchmark and return the exit code."""
    arguments = parse()
    try:
        plan = [] if arguments.again else chosen_runs(arguments)
    except ValueError as error:
        print(error, file=sys.stderr)
        return 2
    arguments.output.mkdir(parents=True, exist_ok=True)
    rows = read_rows(arguments.again) if arguments.again else measured(plan, arguments)
    sections = {"targets": target_table(rows), "seconds": seconds_table(rows), "all": full_table(rows)}
    text = "\n".join(f"## {name}\n\n{table}" for name, table in sections.items())
    (arguments.output / "speed.md").write_text(text, encoding="utf-8")
    write_rows(rows, arguments.output / "speed.csv")
    say(text)
    if arguments.update:
        update_page({"speed": seconds_table(rows, PAGE_RUNS)})
    try:
        from plot import draw
    except ImportError:
        say("There is no matplotlib here, so there is no plot.")
    else:
        draw(rows, arguments.output / "speed.png")
    return 0


def measured(plan, arguments):
    """Measure, and return rows with the digits that files have, so that tables can be written again alike."""
    path = arguments.output / "speed.csv"
    write_rows(measure(plan, arguments), path)
    return read_rows(path)


def parse():
    """Return the options."""
    parser = argparse.ArgumentParser(description="Measure seconds and peak memory.")
    parser.add_argument("--sizes", type=int, nargs="+", help=f"numbers of vertices (default: {SIZES})")
    parser.add_argument("--only", default="", metavar="TEXT", help="runs with this in their names")
    parser.add_argument(
        "--skip", nargs="+", default=[], metavar="TEXT", help="no runs with one of these in their names"
    )
    parser.add_argument("--quick", action="store_true", help="small meshes, core only")
    parser.add_argument("--no-blender", action="store_true", help="leave out the runs inside Blender")
    parser.add_argument("--no-others", action="store_true", help=f"leave out {', '.join(OTHERS.values())}")
    parser.add_argument(
        "--blender", default="bpy-4.5", help="environment with Blender (default: %(default)s)"
    )
    parser.add_argument(
        "--output", type=Path, default=Path("build/benchmarks/speed"), help="folder for results"
    )
    parser.add_argument("--again", type=Path, metavar="CSV", help="only write tables and plot again")
    parser.add_argument("--update", action="store_true", help="write the table of seconds into docs")
    return parser.parse_args()


def chosen_runs(arguments):
    """Return the runs that the options ask for; raises ValueError, in one sentence, if there are none."""
    sizes = arguments.sizes or (QUICK_SIZES if arguments.quick else SIZES)
    with_blender = not (arguments.quick or arguments.no_blender)
    plan = make_plan(sizes, with_blender=with_blender, with_others=not arguments.no_others)
    chosen = [
        run
        for run in plan
        if arguments.only in run.what and not any(text in run.what for text in arguments.skip)
    ]
    if not chosen:
        skipped = f" without those that have {arguments.skip}" if arguments.skip else ""
        names = ", ".join(dict.fromkeys(f"‘{run.what}’" for run in plan))
        raise ValueError(f"No run has {arguments.only!r} in its name{skipped}; the names are {names}.")
    return chosen


def measure(plan, arguments):
    """Make all runs, one after the other, and return a row of the table for each."""
    blender = python_of(arguments.blender) if any(run.kind == "blender" for run in plan) else ""
    rows = []
    for number, run in enumerate(plan, 1):
        n_tries = 1 if arguments.quick else REPEATS
        found = measure_best(run, arguments.output / "meshes", blender, n_tries)
        if "missing" in found:
            say(f"[{number}/{len(plan)}] {run.what}, {run.size:,}: left out, {found['missing']}")
            continue
        stages = found.pop("stages")
        order = {True: "shuffled", False: "natural"}[run.is_shuffled]
        row = {"what": run.what, "order": run.source or order, "asked": run.size, **found, **stages}
        rows.append({name: row.get(name, "") for name in COLUMNS})
        write_rows(rows, arguments.output / "speed.csv")  # what is there is kept, whatever comes
        say(f"[{number}/{len(plan)}] {run.what}, {found['n_vertices']:,}: {stages['all']:.2f} s")
    return rows


def measure_best(run, meshes, blender, n_tries):
    """Make one run, or the best of several if it is short: what else the computer does only adds time."""
    found = measure_one(run, meshes, blender)
    if "missing" in found or found["stages"]["all"] > SHORT:
        return found
    tries = [found, *(measure_one(run, meshes, blender) for _ in range(n_tries - 1))]
    return best_of([each for each in tries if "missing" not in each])


def best_of(tries):
    """Return the run that took the least time, with the least time of a second run among all."""
    best = min(tries, key=lambda found: found["stages"]["all"])
    again = [found["stages"]["rerun"] for found in tries if "rerun" in found["stages"]]
    return {**best, "stages": {**best["stages"], **({"rerun": min(again)} if again else {})}}


def measure_one(run, meshes, blender):
    """Make one run in a process of its own and return what it found."""
    source = run.source or str(torus_file(meshes.resolve(), run.size, run.is_shuffled))
    python = blender if run.kind == "blender" else sys.executable
    what = [run.name, source] if run.kind == "baseline" else [source, json.dumps(run.options)]
    command = [python, str(FOLDER / f"{run.kind}_task.py"), *what]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=TIMEOUT, check=False)
    except subprocess.TimeoutExpired:
        return {"missing": f"it takes more than {TIMEOUT} s"}
    if done.returncode:
        return {"missing": f"it failed: {done.stderr.strip().splitlines()[-1:]}"}
    return json.loads(done.stdout.strip().splitlines()[-1])


def python_of(environment):
    """Return the Python of an environment."""
    command = [sys.executable, str(loading.ROOT / ".ci" / "environment.py"), "path", environment]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()


def say(text):
    """Print a line at once."""
    print(text, flush=True)


if __name__ == "__main__":
    sys.exit(main())
