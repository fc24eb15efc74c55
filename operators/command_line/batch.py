# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The subcommand `batch`: denoise many files, with a report that says what a later run has left to do."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, closing, contextmanager
from pathlib import Path
from typing import Any

from ..batch.begun import Begun
from ..batch.inputs import PlanError, ReportError
from ..batch.lock import ReportLock
from ..batch.rows import DONE, RowFile, read_rows
from ..batch.task import Task
from ..files.safe_write import remove_leftovers
from .arguments import HelpFormatter
from .batch_arguments import add_batch_arguments
from .batch_plan import left_to_do, plan, reports_of, without_foreign
from .batch_progress import BatchProgress
from .messages import FAILURE, USAGE_ERROR, CommandError, Messages


def add_command(subparsers: argparse._SubParsersAction[Any]) -> None:
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
            names = {name for report in reports for name in Begun(report).names()}
            undone = [without_foreign(task, rows, names, arguments) for task in undone]
            begun.add(task.name for task in undone if not task.error and not os.path.lexists(task.target))
            folders = {Path(task.target).parent for task in tasks}
            for folder in folders:
                remove_leftovers(folder)
            jobs = [_job(task, rows) for task in undone]
            failed = _work(jobs, len(tasks), stack.enter_context(RowFile(reports[0])), arguments, messages)
            for folder in folders:
                remove_leftovers(folder)  # of processes that died
            if not failed:
                begun.forget()
    if failed:
        files = "1 file" if failed == 1 else f"{failed:,} files"
        raise CommandError(f"{files} of {len(tasks):,} failed; see {reports[0]}.", FAILURE)


def _job(task: Task, rows: Mapping[str, dict[str, Any]]) -> dict[str, Any]:
    """Return what a process is told to do, in plain values."""
    folder = Path(task.target).parent
    written = rows.get(task.name, {}).get("beside_output") or {}
    own = {os.path.normpath(folder / name): known for name, known in written.items()}
    return {"task": task.as_dict(), "source": task.source, "own": own}


def _work(
    jobs: list[dict[str, Any]], n_all: int, report: RowFile, arguments: argparse.Namespace, messages: Messages
) -> int:
    """Carry out the jobs, write their rows, and return how many failed."""
    from .batch_task import row_of

    if n_all > len(jobs):
        messages.say(f"{n_all - len(jobs):,} of {n_all:,} files are left as they are.")
    if not jobs:
        return 0
    failed = 0
    with (
        _results(jobs, arguments, messages) as results,
        BatchProgress(len(jobs), messages, arguments.verbose) as progress,
    ):
        for job, found in results:
            task = Task(**job["task"])
            row = row_of(task) | found
            if task.error and task.target:
                row["is_foreign"] = True
            report.append(row)
            progress.say(row)
            if row["status"] != DONE:
                failed += 1
                if arguments.fail_fast:
                    break
    return failed


@contextmanager
def _results(
    jobs: Sequence[dict[str, Any]], arguments: argparse.Namespace, messages: Messages
) -> Iterator[Iterator[tuple[dict[str, Any], dict[str, Any]]]]:
    """Give the rows of jobs, as they end: from this process, or from those of Dask."""
    from ...core.processors import default_threads
    from .batch_task import carry_out

    limits: dict[str, Any] = {"max_bytes": arguments.max_memory, "n_threads": 0}
    if arguments.jobs is not None or arguments.scheduler is not None:
        from ..farm.dask_farm import NoDask, of_scheduler, on_this_computer
        from ..farm.dispatch import FarmError

        try:
            with ExitStack() as stack:
                if arguments.scheduler is not None:
                    limits["n_threads"] = 1
                    farm = stack.enter_context(of_scheduler(arguments.scheduler))
                else:
                    n_processes = min(arguments.jobs, len(jobs))
                    limits["n_threads"] = max(1, default_threads() // n_processes)
                    farm = stack.enter_context(on_this_computer(n_processes, _environment()))
                function = "operators.command_line.batch_task:carry_out"
                rows = farm.results([job | limits for job in jobs], function)
                # An interrupt leaves it half-way: it says goodbye while the farm is still there.
                yield stack.enter_context(closing(rows))
                return
        except NoDask as error:
            if arguments.scheduler is not None:
                raise CommandError(str(error), USAGE_ERROR) from error
            messages.warn(f"--jobs has no effect, one file is worked on at a time. {error}")
        except FarmError as error:
            raise CommandError(str(error), FAILURE) from error
    yield ((job, carry_out(job | limits)) for job in jobs)


def _environment() -> dict[str, str]:
    """Return environment variables by which processes find the Blender they run in."""
    from .blender_process import BLENDER

    bpy = sys.modules.get("bpy")
    binary = getattr(getattr(bpy, "app", None), "binary_path", "")
    if bpy is not None and binary and not getattr(bpy.app, "module", False):
        return {BLENDER: binary}
    return {}


def _say_plan(undone: list[Task], n_all: int, messages: Messages) -> None:
    """Say what would be done."""
    for task in undone:
        if task.error:
            messages.say(f"{task.source} would fail: {task.error}")
        else:
            messages.say(f"{task.source} -> {task.target}")
    messages.say(f"{len(undone):,} of {n_all:,} files would be worked on.")


@contextmanager
def _as_usage_errors() -> Iterator[None]:
    """Turn what contradicts itself in a plan into a usage error, and a report that fails into a failure."""
    try:
        yield
    except ReportError as error:
        raise CommandError(str(error), FAILURE) from error
    except PlanError as error:
        raise CommandError(str(error), USAGE_ERROR) from error
