# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The arguments of the subcommand `batch`, and how their values are read."""

from __future__ import annotations

import argparse
import re
from pathlib import Path

from ..batch.places import DEFAULT_TEMPLATE
from ..files.formats import PATCHED_TYPES
from ..properties.output_choices import IN_PLACE, OUTPUTS
from .arguments import add_setting_options, choice_list, choice_type
from .file_types import BLENDER_TYPES
from .region_arguments import add_region_options

TYPES = (*PATCHED_TYPES, *BLENDER_TYPES)
_SIZE = re.compile(r"(\d+(?:\.\d+)?)\s*([KMGT]?)B?", re.IGNORECASE)


def add_batch_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments to the parser of the subcommand."""
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
        type=mesh_type,
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
    workers = work.add_mutually_exclusive_group()
    workers.add_argument(
        "--jobs",
        metavar="N",
        type=_count,
        help="work on N files at a time, each in a process of its own, by Dask",
    )
    workers.add_argument(
        "--scheduler",
        metavar="tcp://HOST:PORT",
        help="work on the machines of a Dask scheduler",
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


def add_denoise_options(parser: argparse.ArgumentParser) -> None:
    """Add what can differ from file to file."""
    identifiers = [choice.identifier for choice in OUTPUTS]
    parser.add_argument(
        "--output", type=choice_type(identifiers), metavar=choice_list(identifiers), default=IN_PLACE,
        help="where the denoised surface goes in a .blend file (default: in-place)",
    )  # fmt: skip
    add_setting_options(parser)
    add_region_options(parser)


def mesh_type(text: str) -> str:
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
