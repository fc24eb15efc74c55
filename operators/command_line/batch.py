# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The subcommand `batch`: denoise many files, with a report that says what a later run has left to do."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Iterable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

from ..batch.begun import Begun
from ..batch.inputs import PlanError
from ..batch.lock import ReportLock
from ..batch.progress import TimeLeft
from ..batch.rows import DONE, RowFile, read_rows
from ..batch.task import Task
from ..batch.workers import THREADS, Workers
from ..files.safe_write import remove_leftovers
from .arguments import HelpFormatter
from .batch_arguments import add_batch_arguments
from .batch_plan import left_to_do, plan, reports_of, without_foreign
from .messages import FAILURE, USAGE_ERROR, CommandError, Messages, complain


def add_command(subparsers: argparse._SubParsersAction) -> None:
    """Add the subcommand to the parser of the program."""
    parser = subparsers.add_parser(
        "batch",
        help="denoise many files",
        description="Denoise many files. Each result is a file below DIR; what was done is in "
        "DIR/report.jsonl, a line a file. The same command once more does what is missing, has changed "
        "or failed.",
        usage="%(prog)s INPUTS... --out DIR [options]",
        epilog="example: %(prog)s scans --out clean --jobs 4\n"
        "example: %(prog)s --manifest scans.csv --out clean --slice 3/20",
        formatter_class=HelpFormatter,
        allow_abbrev=False,
    )
    add_batch_arguments(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> None:
    """Carry out the subcommand.

    Parameters
    ----------
    arguments : argparse.Namespace
        From the parser.

    Raises
    ------
    CommandError
        If it cannot be begun, or a file failed.
    """
    messages = Messages(arguments.quiet)
    with _as_usage_errors():
        tasks = plan(arguments)
        reports = reports_of(arguments)
        rows = read_rows(path for path in reports if path.exists())
        if arguments.dry_run:
            _say_plan(left_to_do(tasks, rows, arguments), len(tasks), messages)
            return
        arguments.out.mkdir(parents=True, exist_ok=True)
        with ExitStack() as stack:
            stack.enter_context(ReportLock(reports[0]))
            # Another run may have gone on until we had the lock.
            rows = read_rows(path for path in reports if path.exists())
            undone = left_to_do(tasks, rows, arguments)
            begun = Begun(reports[0])
            undone = [without_foreign(task, rows, begun.names(), arguments) for task in undone]
            begun.add(task.name for task in undone if not task.error and not os.path.lexists(task.target))
            for folder in {Path(task.target).parent for task in tasks}:
                remove_leftovers(folder)
            failed = _work(undone, len(tasks), stack.enter_context(RowFile(reports[0])), arguments, messages)
            if not failed:
                begun.forget()
    if failed:
        files = "1 file" if failed == 1 else f"{failed:,} files"
        raise CommandError(f"{files} of {len(tasks):,} failed; see {reports[0]}.", FAILURE)


def _work(
    tasks: list[Task], n_all: int, report: RowFile, arguments: argparse.Namespace, messages: Messages
) -> int:
    """Work on the tasks, write their rows, and return how many failed."""
    from .batch_task import row_of

    if n_all > len(tasks):
        messages.say(f"{n_all - len(tasks):,} of {n_all:,} files are left as they are.")
    left, failed = TimeLeft(len(tasks)), 0
    foreign = {task.name for task in tasks if task.error and task.target}
    jobs = (task.as_dict() | {"max_bytes": arguments.max_memory} for task in tasks)
    with _results(jobs, len(tasks), arguments) as results:
        for job, found in results:
            fields = {name: value for name, value in job.items() if name != "max_bytes"}
            row = row_of(Task(**fields)) | found
            if row["output"] in foreign:
                row["is_foreign"] = True
            report.append(row)
            _say_row(row, left.one_more(), arguments, messages)
            if row["status"] != DONE:
                failed += 1
                if arguments.fail_fast:
                    break
    return failed


@contextmanager
def _results(
    jobs: Iterable[dict[str, Any]], number: int, arguments: argparse.Namespace
) -> Iterator[Iterator[tuple[dict[str, Any], dict[str, Any]]]]:
    """Give the rows of jobs, as they end, from processes here or on other machines."""
    if arguments.scheduler is not None:
        from ..farm.dask_farm import results

        with results(list(jobs), arguments.scheduler) as found:
            yield found
        return
    n_workers = max(1, min(arguments.jobs, number))
    with Workers(n_workers, _environment(n_workers)) as workers:
        yield workers.run(jobs)


def _environment(n_workers: int) -> dict[str, str]:
    """Return environment variables by which processes share the cores, and find the Blender they run in."""
    from ...core.processors import default_threads
    from .blender_process import BLENDER

    threads = str(max(1, default_threads() // n_workers))
    environment = {THREADS: threads}
    bpy = sys.modules.get("bpy")
    binary = getattr(getattr(bpy, "app", None), "binary_path", "")
    if bpy is not None and binary and not getattr(bpy.app, "module", False):
        environment[BLENDER] = binary
    return environment


def _say_plan(undone: list[Task], n_all: int, messages: Messages) -> None:
    """Say what would be done."""
    for task in undone:
        if task.error:
            messages.say(f"{task.source} would fail: {task.error}")
        else:
            messages.say(f"{task.source} -> {task.target}")
    messages.say(f"{len(undone):,} of {n_all:,} files would be worked on.")


def _say_row(row: dict[str, Any], where: str, arguments: argparse.Namespace, messages: Messages) -> None:
    """Say what came of a file."""
    if row["status"] != DONE:
        named = "" if row["input"] in row["error"] else f"{row['input']}: "
        complain(f"{where}: {named}{row['error']}")
        return
    seconds = sum(row["seconds"].values())
    messages.say(
        f"{where}: {row['output']} in {seconds:.2f} s, {row['n_vertices']:,} vertices, moved by "
        f"{row['displacement_max_edges']:.2g} edges at most, {row['folded_faces']:,} folded faces."
    )
    if arguments.verbose:
        stages = ", ".join(f"{name} {value:.2f} s" for name, value in row["seconds"].items())
        messages.say(f"  {stages}")
        for sentence in row["warnings"]:
            messages.warn(sentence)


@contextmanager
def _as_usage_errors() -> Iterator[None]:
    """Turn what contradicts itself in a plan into a usage error."""
    try:
        yield
    except PlanError as error:
        raise CommandError(str(error), USAGE_ERROR) from error
