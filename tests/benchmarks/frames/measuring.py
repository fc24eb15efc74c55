# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Run algorithms on cases, in several processes, and keep what came out as rows."""

import math
import os
from collections.abc import Callable, Iterable
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from time import perf_counter
from typing import NamedTuple

import checkout  # noqa: F401
from algorithms import Algorithm, algorithms_for
from cases import load, measure
from framelet.core import DenoiseSettings, denoise


class Row(NamedTuple):
    """One line of the results; its fields are the columns of the CSV file."""

    mesh: str
    vertices: int
    group: str
    algorithm: str
    frame: str
    stencil: str
    levels: int
    choice: str
    """noisy, default or best."""
    lambda_: float
    sigma_c: float
    sigma_s: float
    is_at_end: bool
    """True if the best lambda is the smallest or the largest of the grid."""
    angle: float
    crease_angle: float
    rms: float
    flips: int
    seconds: float


Task = tuple[str, Algorithm]


def run_all(names: Iterable[str], is_quick: bool, n_processes: int, say: Callable[[str], None]) -> list[Row]:
    """Run everything on some cases.

    Parameters
    ----------
    names : iterable of str
        Names of cases, large ones first.
    is_quick : bool
        True runs a small part.
    n_processes : int
        Processes at a time, each with one thread.
    say : callable
        Takes a line for people.

    Returns
    -------
    list of Row
        In the order of the cases and algorithms, whatever finished first.
    """
    rows: list[Row] = []
    tasks: list[Task] = []
    for name in names:
        case = load(name)
        rows.append(_row(name, None, None, "noisy", measure(case, case.noisy.vertices), 0.0))
        tasks += [
            (name, algorithm) for algorithm in algorithms_for(case.is_quad, case.clean.n_vertices, is_quick)
        ]
    # One thread each: two processes are faster than one with two threads, and times are comparable.
    for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ[variable] = "1"
    began = perf_counter()
    with ProcessPoolExecutor(n_processes, get_context("spawn")) as pool:
        for number, found in enumerate(pool.map(run_task, tasks), 1):
            rows += found
            if number % 25 == 0 or number == len(tasks):
                say(f"{number} of {len(tasks)} algorithms, {perf_counter() - began:.0f} s")
    return rows


def run_task(task: Task) -> list[Row]:
    """Run an algorithm at its default and over its grid; return the default's row and the best one's."""
    name, algorithm = task
    default = _run(name, algorithm, algorithm.settings, "default")
    others = [
        _run(name, algorithm, algorithm.settings.with_changes(**change), "best") for change in algorithm.grid
    ]
    best = min([default._replace(choice="best"), *others], key=lambda row: row.angle)
    tried = [row.lambda_ for row in (default, *others)]
    is_at_end = algorithm.settings.method != "BILATERAL" and best.lambda_ in (min(tried), max(tried))
    return [default, best._replace(is_at_end=is_at_end)]


def _run(name: str, algorithm: Algorithm, settings: DenoiseSettings, choice: str) -> Row:
    """Denoise a case and measure the result."""
    case = load(name)
    began = perf_counter()
    vertices = denoise(case.noisy, settings.with_changes(threads=1), connectivity=case.connectivity).vertices
    seconds = perf_counter() - began
    return _row(name, algorithm, settings, choice, measure(case, vertices), seconds)


def _row(name, algorithm, settings, choice, measurement, seconds) -> Row:
    """Put together a row."""
    is_frame = settings is not None and settings.method == "POSITIONS"
    is_bilateral = settings is not None and settings.method == "BILATERAL"
    return Row(
        mesh=name,
        vertices=load(name).clean.n_vertices,
        group=algorithm.group if algorithm else "",
        algorithm=algorithm.name if algorithm else "",
        frame=settings.frame if is_frame else "",
        stencil=settings.stencil if is_frame else "",
        levels=settings.levels if is_frame else 0,
        choice=choice,
        lambda_=settings.lambda_ if is_frame else math.nan,
        sigma_c=settings.sigma_c if is_bilateral else math.nan,
        sigma_s=settings.sigma_s if is_bilateral else math.nan,
        is_at_end=False,
        **measurement._asdict(),
        seconds=seconds,
    )
