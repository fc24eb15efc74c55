# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The subcommand `report`: what the rows of a batch say together."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..batch.inputs import PlanError
from ..batch.rows import read_rows
from ..batch.summary import as_csv, by_need, summary_lines
from ..batch.task import hash_of
from ..files.safe_write import Outputs, check_target
from .arguments import HelpFormatter
from .batch_plan import reports_in
from .messages import USAGE_ERROR, CommandError, Messages

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


def add_command(subparsers: argparse._SubParsersAction[Any]) -> None:
    """Add the subcommand to the parser of the program."""
    parser = subparsers.add_parser(
        "report",
        help="sum up the reports of a batch",
        description="Say what a batch did, and which results need a look.",
        usage="%(prog)s FILE... [options]",
        epilog="example: %(prog)s clean --html look.html",
        formatter_class=HelpFormatter,
        allow_abbrev=False,
    )
    parser.add_argument(
        "reports", metavar="FILE", nargs="+", type=Path, help="a report, or the folder of a batch"
    )
    parser.add_argument(
        "--csv", metavar="FILE.csv", type=Path, help="write a table with a line a result here"
    )
    parser.add_argument("--html", metavar="FILE.html", type=Path, help="write a page with pictures here")
    parser.add_argument(
        "--pictures",
        metavar="N",
        type=int,
        default=50,
        help="results with pictures on the page (default: 50)",
    )
    parser.add_argument(
        "--worst", metavar="N", type=int, default=10, help="results that are named (default: 10)"
    )
    parser.add_argument("--quiet", action="store_true", help="print nothing but errors")
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> None:
    """Carry out the subcommand.

    Parameters
    ----------
    arguments : argparse.Namespace
        From the parser.

    Raises
    ------
    CommandError or FileError
        If a report cannot be read, or a file cannot be written.
    """
    paths: list[Path] = []
    for path in arguments.reports:
        found = reports_in(path) if path.is_dir() else [path]
        if not found:
            raise CommandError(
                f"The folder {path} holds no report of a batch; name one that does.", USAGE_ERROR
            )
        paths += found
    for target, suffix in ((arguments.csv, ".csv"), (arguments.html, ".html")):
        if target is not None:
            if target.suffix.lower() != suffix:
                raise CommandError(f"{target} cannot be written; its name must end in {suffix}.", USAGE_ERROR)
            check_target(target)
    try:
        rows = list(read_rows(paths).values())
    except PlanError as error:
        raise CommandError(str(error)) from error
    # A line that a kill cut off is what a batch may leave; whole lines without a row are something else.
    if not rows and any(b"\n" in path.read_bytes() for path in paths):
        names = ", ".join(map(str, paths))
        raise CommandError(f"{names} holds no row of a batch; name the report of one.", USAGE_ERROR)
    messages = Messages(arguments.quiet)
    for line in summary_lines(rows, arguments.worst):
        messages.say(line)
    with Outputs() as outputs:
        if arguments.csv is not None:
            table = as_csv(row for row, _look in by_need(rows))
            outputs.write(arguments.csv, table.encode("utf-8", "backslashreplace"))
        if arguments.html is not None:
            from ..batch.page import page

            outputs.write(arguments.html, page(rows, pictures_of, arguments.pictures).encode("utf-8"))
        outputs.publish()


def pictures_of(row: dict[str, Any]) -> tuple[bytes, bytes] | None:
    """Return pictures of the input and the result of a row, as PNG files, seen from one place.

    None if a file is not there any more, or not the one that the row speaks of, or needs Blender.
    """
    from ..batch.pictures import as_png, picture, view_of

    before, after = (
        _shape(Path(row.get(name) or ""), row.get(hash_name))
        for name, hash_name in (("input", "input_sha256"), ("target", "output_sha256"))
    )
    if before is None or after is None:
        return None
    view = view_of(before[0])
    return as_png(picture(*before, view)), as_png(picture(*after, view))


def _shape(
    path: Path, known_hash: str | None
) -> tuple[NDArray[np.floating], NDArray[np.int64], NDArray[np.int64]] | None:
    """Return what a file shows, if it is the one with this hash."""
    from ..files import PATCHED_TYPES, FileError, open_file

    if path.suffix.lower() not in PATCHED_TYPES or known_hash is None or hash_of(path) != known_hash:
        return None
    try:
        file = open_file(path)
        return file.scene(file.positions)
    except FileError:
        return None
