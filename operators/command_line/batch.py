# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The subcommand `batch`: denoise many files, with a report that says what a later run has left to do."""

from __future__ import annotations

import argparse
import copy
import os
import re
import sys
from collections.abc import Iterable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import asdict
from pathlib import Path
from typing import Any

from ..batch.begun import Begun
from ..batch.inputs import Found, PlanError, find_files
from ..batch.lock import ReportLock
from ..batch.manifest import Row, read_manifest
from ..batch.places import DEFAULT_TEMPLATE, check_collisions, named, place_in
from ..batch.progress import TimeLeft
from ..batch.rows import DONE, RowFile, is_done, read_rows
from ..batch.task import Task
from ..batch.workers import THREADS, Workers
from ..files.formats import PATCHED_TYPES
from ..files.safe_write import remove_leftovers
from ..properties.output_choices import IN_PLACE, OUTPUTS
from .arguments import HelpFormatter, add_setting_options, as_word, choice_list, choice_type, settings_from
from .file_types import BLENDER_TYPES
from .messages import FAILURE, USAGE_ERROR, CommandError, Messages, complain
from .region_arguments import add_region_options, region_options_from

TYPES = (*PATCHED_TYPES, *BLENDER_TYPES)
_SIZE = re.compile(r"(\d+(?:\.\d+)?)\s*([KMGT]?)B?", re.IGNORECASE)


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
    files = parser.add_argument_group("files")
    files.add_argument(
        "inputs", metavar="INPUTS", nargs="*", help="files, folders or patterns, as 'scans/**/*.ply'"
    )
    files.add_argument("--out", metavar="DIR", type=Path, required=True, help="the folder for the results")
    files.add_argument(
        "--manifest", metavar="FILE", type=Path,
        help="a .csv or .jsonl file with a row a mesh: input, output, format, and any option",
    )  # fmt: skip
    files.add_argument(
        "--name", metavar="TEMPLATE", default=DEFAULT_TEMPLATE,
        help=f"names of results (default: {DEFAULT_TEMPLATE}); {{preset}} and {{number:5}} are there, too",
    )  # fmt: skip
    files.add_argument(
        "--format",
        metavar="TYPE",
        type=_format,
        help="type of the results, as ply (default: that of each input)",
    )
    files.add_argument(
        "--allow-outside", action="store_true", help="let the manifest name results outside DIR"
    )
    files.add_argument("--report", metavar="FILE.jsonl", type=Path, help="the report (default: in DIR)")
    files.add_argument(
        "--overwrite", action="store_true", help="do everything anew, and replace files that no batch wrote"
    )
    work = parser.add_argument_group("work")
    work.add_argument("--jobs", metavar="N", type=_count, default=1, help="files at a time (default: 1)")
    work.add_argument(
        "--scheduler",
        metavar="tcp://HOST:PORT",
        help="work on the machines of a Dask scheduler (framelet[farm])",
    )
    work.add_argument(
        "--slice", metavar="I/N", type=_slice, help="only part I of N, from 1, with a report of its own"
    )
    work.add_argument(
        "--limit", dest="at_most", metavar="N", type=_count, help="work on so many files at most"
    )
    work.add_argument("--max-memory", metavar="SIZE", type=_size, help="the most that a file may take, as 8G")
    work.add_argument("--fail-fast", action="store_true", help="end at the first file that fails")
    work.add_argument("--dry-run", action="store_true", help="say what would be done, and do nothing")
    add_denoise_options(parser)
    talk = parser.add_mutually_exclusive_group()
    talk.add_argument("--quiet", action="store_true", help="print nothing but errors")
    talk.add_argument("--verbose", action="store_true", help="print warnings and times of each file, too")
    parser.set_defaults(run=run)


def add_denoise_options(parser: argparse.ArgumentParser) -> None:
    """Add what can differ from file to file."""
    identifiers = [choice.identifier for choice in OUTPUTS]
    parser.add_argument(
        "--output", type=choice_type(identifiers), metavar=choice_list(identifiers), default=IN_PLACE,
        help="where the denoised surface goes in a .blend file (default: in-place)",
    )  # fmt: skip
    add_setting_options(parser)
    add_region_options(parser)


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
        reports = _reports(arguments)
        rows = read_rows(path for path in reports if path.exists())
        if arguments.dry_run:
            _say_plan(_undone(tasks, rows, arguments), len(tasks), messages)
            return
        arguments.out.mkdir(parents=True, exist_ok=True)
        with ExitStack() as stack:
            stack.enter_context(ReportLock(reports[0]))
            # Another run may have gone on until we had the lock.
            rows = read_rows(path for path in reports if path.exists())
            undone = _undone(tasks, rows, arguments)
            begun = Begun(reports[0])
            undone = [_without_foreign(task, rows, begun.names(), arguments) for task in undone]
            begun.add(task.name for task in undone if not task.error and not os.path.lexists(task.target))
            for folder in {Path(task.target).parent for task in tasks}:
                remove_leftovers(folder)
            failed = _work(undone, len(tasks), stack.enter_context(RowFile(reports[0])), arguments, messages)
            if not failed:
                begun.forget()
    if failed:
        files = "1 file" if failed == 1 else f"{failed:,} files"
        raise CommandError(f"{files} of {len(tasks):,} failed; see {reports[0]}.", FAILURE)


def plan(arguments: argparse.Namespace) -> list[Task]:
    """Return what is to be done, the slice that was asked for; nothing is written.

    Raises
    ------
    PlanError
        If the arguments contradict each other, or two files have one place.
    CommandError
        If an option has no effect.
    """
    if not arguments.inputs and arguments.manifest is None:
        raise PlanError("There is nothing to do; name files, folders or a --manifest.")
    if arguments.report is not None and arguments.report.suffix != ".jsonl":
        raise PlanError(f"The report cannot be {arguments.report}; its name must end in .jsonl.")
    # What is wrong for all files is told once.
    settings_from(arguments)
    region_options_from(arguments)
    named(arguments.name, Path("name"), "", 1, "")
    items = [(found, None) for found in find_files(arguments.inputs, TYPES, arguments.out)]
    rows = [] if arguments.manifest is None else read_manifest(arguments.manifest)
    everything: list[tuple[Found, Row | None]] = [*items]
    everything += [(Found(row.source, Path(row.source.name)), row) for row in rows]
    tasks = [_task(found, row, number, arguments) for number, (found, row) in enumerate(everything, 1)]
    check_collisions(tasks)
    if arguments.slice is None:
        return tasks
    part, parts = arguments.slice
    return tasks[part - 1 :: parts]


def _task(found: Found, row: Row | None, number: int, arguments: argparse.Namespace) -> Task:
    """Return the task of a file; what is wrong with its row is its error."""
    source = os.path.abspath(found.source)
    try:
        if row is not None:
            if row.error:
                raise PlanError(row.error)
            arguments = _with_options(arguments, row.options)
        kind = arguments.format or found.source.suffix.lower()
        if row is not None and row.format:
            kind = _format(row.format)
        name = row.output if row is not None else ""
        if not name:
            name = named(arguments.name, found.name, kind, number, as_word(arguments.preset))
        target = place_in(arguments.out, name, arguments.allow_outside)
        if target.suffix.lower() not in TYPES:
            raise PlanError(f"{source} is no mesh file; its name must end in {', '.join(TYPES)}.")
        root = os.path.abspath(arguments.out)
        below = target.relative_to(root).as_posix() if target.is_relative_to(root) else str(target)
        return Task(
            source,
            str(target),
            below,
            arguments.preset,
            asdict(settings_from(arguments)),
            asdict(region_options_from(arguments)),
            arguments.output,
        )
    except (ValueError, CommandError, argparse.ArgumentTypeError) as error:
        # Without a place of its own, the file is named by its number.
        return Task(source, "", f"#{number}", error=str(error))


def _with_options(arguments: argparse.Namespace, options: list[str]) -> argparse.Namespace:
    """Return the arguments with those of a row put over them."""
    from .parser import Parser

    parser = Parser(prog="framelet denoise", add_help=False, allow_abbrev=False)
    add_denoise_options(parser)
    if not options:
        return arguments
    return parser.parse_args(options, copy.copy(arguments))


def _reports(arguments: argparse.Namespace) -> list[Path]:
    """Return the report that is written, and then those that are read besides."""
    if arguments.report is not None:
        return [arguments.report]
    part = "" if arguments.slice is None else f"-{arguments.slice[0]}-of-{arguments.slice[1]}"
    own = arguments.out / f"report{part}.jsonl"
    return [own, *(path for path in reports_in(arguments.out) if path != own)]


def reports_in(folder: Path) -> list[Path]:
    """Return the reports of batches in a folder."""
    return sorted({*folder.glob("report.jsonl"), *folder.glob("report-*-of-*.jsonl")})


def _undone(tasks: list[Task], rows: dict[str, dict[str, Any]], arguments: argparse.Namespace) -> list[Task]:
    """Return the tasks that are left to do."""
    left: list[Task] = []
    for task in tasks:
        if arguments.at_most is not None and len(left) == arguments.at_most:
            break
        if arguments.overwrite or task.error or not is_done(task, rows.get(task.name)):
            left.append(task)
    return left


def _without_foreign(
    task: Task, rows: dict[str, dict[str, Any]], begun: set[str], arguments: argparse.Namespace
) -> Task:
    """Return the task, with an error if a file is at its place that no batch wrote."""
    is_ours = task.name in begun or not rows.get(task.name, {"is_foreign": True}).get("is_foreign")
    if task.error or arguments.overwrite or is_ours or not os.path.lexists(task.target):
        return task
    sentence = (
        f"{task.target} exists, and no report says that a batch wrote it; add --overwrite to replace it."
    )
    return Task(task.source, task.target, task.name, error=sentence)


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
    from ...core.processors import available_cores
    from .blender_process import BLENDER

    threads = str(max(1, available_cores() // n_workers))
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


def _format(text: str) -> str:
    """Read a type of file, with or without its dot."""
    kind = "." + text.lower().lstrip(".")
    if kind not in TYPES:
        raise argparse.ArgumentTypeError(f"{text!r} is not one of {', '.join(each[1:] for each in TYPES)}")
    return kind


def _count(text: str) -> int:
    """Read a number from 1."""
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number from 1")
    return int(text)


def _slice(text: str) -> tuple[int, int]:
    """Read I/N."""
    part, _slash, parts = text.partition("/")
    if not (part.isdecimal() and parts.isdecimal() and 1 <= int(part) <= int(parts)):
        raise argparse.ArgumentTypeError(f"{text!r} is not a part of a number, as 3/20")
    return int(part), int(parts)


def _size(text: str) -> int:
    """Read a number of bytes, as 8G."""
    match = _SIZE.fullmatch(text.strip())
    if match is None:
        raise argparse.ArgumentTypeError(f"{text!r} is not a size, as 8G or 500M")
    return int(float(match[1]) * 1000 ** " KMGT".index(match[2].upper() or " "))
