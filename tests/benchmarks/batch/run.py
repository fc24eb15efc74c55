# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measure how many small meshes a batch does in a second, and what a file costs beyond its work.

    python3 .ci/environment.py run core -- tests/benchmarks/batch/run.py

Each way is one run of the command line; with Dask the start of its processes is counted by itself. The load
says how busy the computer was: with more than one for each core the times say little. Processor time, of all
processes together, is the same on a busy computer; a run of few files takes away what the start takes.
"""

import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[3]
PROGRAM = "import sys; from framelet.operators.command_line import main; sys.exit(main())"
TIMEOUT = 3600


def main():
    """Run the benchmark."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--files", type=int, default=200)
    parser.add_argument("--side", type=int, default=32, help="vertices along each side of a mesh")
    parser.add_argument("--preset", default="auto")
    parser.add_argument("--jobs", type=int, nargs="+", default=[1, 2], help="numbers of processes with Dask")
    arguments = parser.parse_args()
    print("| | Start | A file | Its work | Beyond, for each process | Processor time of a file | Load |")
    print("|---" * 7 + "|")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "framelet").symlink_to(ROOT)
        (folder / "scans").mkdir()
        few = max(2, arguments.files // 20)
        for number in range(arguments.files):
            write_sheet(folder / "scans" / f"{number}.obj", arguments.side, number)
        ways = {"one after the other": ()} | {f"--jobs {n}": ("--jobs", str(n)) for n in arguments.jobs}
        for way, words in ways.items():
            n_jobs, name = int(words[1]) if words else 1, way.replace(" ", "_")
            *_times, at_start = measure(
                folder, f"few_{name}", (*words, "--limit", str(few)), arguments.preset
            )
            start, each, work, processor = measure(folder, name, words, arguments.preset)
            processor = (processor - at_start) / (arguments.files - few)
            print(
                f"| {way} | {start:.1f} s | {1e3 * each:.0f} ms | {1e3 * work:.0f} ms | "
                f"{1e3 * (n_jobs * each - work):.0f} ms | {1e3 * processor:.0f} ms | "
                f"{os.getloadavg()[0]:.1f} |",
                flush=True,
            )


def measure(folder, name, words, preset):
    """Return seconds until the first file was done, from one to the next, and of the work on one, and of
    processor time of all processes together."""
    environment = os.environ | {"PYTHONPATH": str(folder), "OPENBLAS_NUM_THREADS": "1"}
    command = [sys.executable, "-c", PROGRAM, "batch", str(folder / "scans"), "--out", str(folder / name)]
    began, before = time.time(), processor_seconds()
    subprocess.run(
        [*command, "--quiet", "--preset", preset, *words], env=environment, check=True, timeout=TIMEOUT
    )
    rows = [json.loads(line) for line in (folder / name / "report.jsonl").read_text().splitlines()]
    ended = sorted(row["ended"] for row in rows)
    each = (ended[-1] - ended[0]) / (len(ended) - 1)
    # The first file of each process loads the program.
    work = float(np.median([sum(row["seconds"].values()) for row in rows]))
    return ended[0] - began, each, work, processor_seconds() - before


def processor_seconds():
    """Return the processor time of all processes that ended below this one."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def write_sheet(path, side, seed):
    """Write a noisy sheet of side * side vertices."""
    x, y = np.meshgrid(np.arange(side), np.arange(side), indexing="ij")
    z = np.random.default_rng(seed).normal(0, 0.1, x.shape)
    number = np.arange(side * side).reshape(side, side) + 1
    a, b = number[:-1, :-1].ravel(), number[1:, :-1].ravel()
    c, d = number[1:, 1:].ravel(), number[:-1, 1:].ravel()
    lines = [f"v {p} {q} {r:.6f}" for p, q, r in zip(x.ravel(), y.ravel(), z.ravel(), strict=True)]
    lines += [f"f {p} {q} {r}\nf {p} {r} {s}" for p, q, r, s in zip(a, b, c, d, strict=True)]
    path.write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
