# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a batch is to do: a task for each file, and those that are left of them."""

from __future__ import annotations

import argparse
import copy
import os
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from ..batch.inputs import Found, PlanError, find_files
from ..batch.manifest import Row, read_manifest
from ..batch.places import check_collisions, named, place_in
from ..batch.rows import is_done
from ..batch.task import Task
from .arguments import as_word, settings_from
from .batch_arguments import TYPES, add_denoise_options, mesh_type
from .messages import CommandError
from .region_arguments import region_options_from


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
            kind = mesh_type(row.format)
        name = row.output if row is not None else ""
        if not name:
            name = named(arguments.name, found.name, kind, number, as_word(arguments.preset))
        target = place_in(arguments.out, name, arguments.allow_outside)
        if target.suffix.lower() not in TYPES:
            wrong = target if row is not None and row.output else source
            raise PlanError(f"{wrong} is no mesh file; its name must end in {', '.join(TYPES)}.")
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


def reports_of(arguments: argparse.Namespace) -> list[Path]:
    """Return the report that is written, and then those that are read besides."""
    if arguments.report is not None:
        return [arguments.report]
    part = "" if arguments.slice is None else f"-{arguments.slice[0]}-of-{arguments.slice[1]}"
    own = arguments.out / f"report{part}.jsonl"
    return [own, *(path for path in reports_in(arguments.out) if path != own)]


def reports_in(folder: Path) -> list[Path]:
    """Return the reports of batches in a folder."""
    return sorted({*folder.glob("report.jsonl"), *folder.glob("report-*-of-*.jsonl")})


def left_to_do(
    tasks: list[Task], rows: Mapping[str, dict[str, Any]], arguments: argparse.Namespace
) -> list[Task]:
    """Return the tasks that are left to do."""
    left: list[Task] = []
    for task in tasks:
        if arguments.at_most is not None and len(left) == arguments.at_most:
            break
        if arguments.overwrite or task.error or not is_done(task, rows.get(task.name)):
            left.append(task)
    return left


def without_foreign(
    task: Task, rows: Mapping[str, dict[str, Any]], begun: set[str], arguments: argparse.Namespace
) -> Task:
    """Return the task, with an error if a file is at its place that no batch wrote."""
    is_ours = task.name in begun or not rows.get(task.name, {"is_foreign": True}).get("is_foreign")
    if task.error or arguments.overwrite or is_ours or not os.path.lexists(task.target):
        return task
    sentence = (
        f"{task.target} exists, and no report says that a batch wrote it; add --overwrite to replace it."
    )
    return Task(task.source, task.target, task.name, error=sentence)
