# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The arguments IN and OUT of subcommands that write a mesh file, and how the result gets to its place."""

from __future__ import annotations

import argparse
from pathlib import Path

from ..files.safe_write import Outputs
from ..files.signals import Interrupted
from .file_types import BLENDER_TYPES, WORDS, check_output, check_source, file_type, needs_blender
from .messages import INTERRUPTED, USAGE_ERROR, CommandError, Messages


def add_target_arguments(group: argparse._ArgumentGroup) -> None:
    """Add IN, OUT and what replaces IN to the arguments of a subcommand."""
    group.add_argument("source", metavar="IN", type=Path, help=f"the file to read: {WORDS}")
    group.add_argument(
        "target",
        metavar="OUT",
        type=Path,
        nargs="?",
        help="the file to write, of any of these types; one that exists is replaced once all went well. With "
        "the type of IN it is a copy in which only coordinates differ; other types hold positions and faces",
    )
    group.add_argument("--in-place", action="store_true", help="write the result to IN; OUT can be left out")
    group.add_argument(
        "--backup", action="store_true", help="keep what --in-place replaces, with .bak behind its name"
    )


def target_of(arguments: argparse.Namespace) -> Path:
    """Return the file to write.

    Raises
    ------
    CommandError
        If the arguments do not name it, or contradict each other.
    """
    source, target = arguments.source, arguments.target
    if arguments.backup and not arguments.in_place:
        raise CommandError("--backup has no effect without --in-place; add it.", USAGE_ERROR)
    if target is None:
        if not arguments.in_place:
            raise CommandError(
                "There is no OUT; name the file to write, or add --in-place (see --help).", USAGE_ERROR
            )
        return source
    if arguments.in_place and str(target) != str(source):
        raise CommandError("--in-place replaces IN; leave OUT out.", USAGE_ERROR)
    return target


def check_files(arguments: argparse.Namespace, target: Path) -> bool:
    """Check everything that can be wrong about the files before they are read.

    Returns
    -------
    bool
        Whether Blender is needed.

    Raises
    ------
    CommandError or FileError
        In one sentence.
    """
    source = arguments.source
    file_type(source)
    file_type(target)
    if file_type(target) == ".gltf" and file_type(source) not in (".gltf", *BLENDER_TYPES):
        raise CommandError(
            f"{target} cannot be made of another format; write .glb, .ply, .obj or .stl instead.", USAGE_ERROR
        )
    check_source(source)
    check_output(source, target, may_replace=arguments.in_place)
    return needs_blender(source, target)


def publish(outputs: Outputs, kept: list[Path], messages: Messages) -> None:
    """Move all that was written to its place, and say so; `kept` are the backups of what was there."""
    written = outputs.publish()
    try:
        messages.say(f"Wrote {listed(written)}." + (f" What was there is in {listed(kept)}." if kept else ""))
    except KeyboardInterrupt as error:
        raise Interrupted(written, getattr(error, "exit_code", INTERRUPTED)) from error


def listed(paths: list[Path]) -> str:
    """Return names as a list in a sentence."""
    *others, last = map(str, paths)
    return f"{', '.join(others)} and {last}" if others else last
