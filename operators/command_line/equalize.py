# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The subcommand `equalize`: read a file, turn the scales of its meshes up and down, write a file."""

from __future__ import annotations

import argparse
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING

from ...core.settings import DenoiseSettings
from .arguments import HelpFormatter, add_frame_options
from .file_types import check_source, file_type
from .mesh_work import check_blender, describe_input, work_on_meshes
from .messages import Messages
from .staging import Staging, check_folder

if TYPE_CHECKING:
    import bpy

FRAME_OPTIONS = ("frame", "stencil", "boundary")
MOST_GAINS = next(
    int(item.metadata["info"].maximum) for item in fields(DenoiseSettings) if item.name == "levels"
)


def add_command(subparsers: argparse._SubParsersAction) -> None:
    """Add the subcommand to the parser of the program."""
    parser = subparsers.add_parser(
        "equalize",
        help="smooth or exaggerate the details of the meshes of a file, scale by scale",
        description="Multiply the details of each scale by a gain, in a PLY, OBJ or STL file or in all mesh "
        "objects in the scene of a .blend file. Vertices move; their number and order, faces, UVs and colors "
        "stay.",
        usage="%(prog)s IN OUT --gains G1,G2,... [options]",
        epilog="example: %(prog)s scan.ply bold.ply --gains 0.2,1,1.5",
        formatter_class=HelpFormatter,
        allow_abbrev=False,
    )
    files = parser.add_argument_group("files")
    files.add_argument("source", metavar="IN", type=Path, help="the file to read: .ply, .obj, .stl or .blend")
    files.add_argument(
        "target",
        metavar="OUT",
        type=Path,
        help="the file to write, of any of these types; one that exists is replaced once all went well",
    )
    parser.add_argument(
        "--gains",
        metavar="G1,G2,...",
        type=_gains,
        required=True,
        help=f"one gain for each level, 1 to {MOST_GAINS} of them, finest first: below 1 smooths that scale, "
        "1 keeps it, above 1 exaggerates it",
    )
    add_frame_options(parser, FRAME_OPTIONS)
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
    CommandError
        If it cannot be carried out; no file is then written or changed.
    """
    source, target = arguments.source, arguments.target
    options = {name: getattr(arguments, name) for name in FRAME_OPTIONS}
    file_type(source)
    file_type(target)
    check_source(source)
    check_folder(target)
    check_blender()
    from ..equalize import equalize_object
    from .exporting import export
    from .importing import opened

    messages = Messages(arguments.quiet)

    def work(obj: bpy.types.Object) -> None:
        rms, maximum = equalize_object(obj, arguments.gains, **options)
        messages.say(f"Equalized {obj.name}: vertices moved by {rms:.4g} rms and {maximum:.4g} at most.")

    with Staging() as staging, opened(source, messages) as surfaces:
        messages.say(describe_input(source, surfaces))
        outcome = work_on_meshes(source, surfaces, messages, work)
        export(surfaces.without(outcome.refused_objects), target, staging, messages)
        staging.publish()
    messages.say(f"Wrote {target}.")


def _gains(text: str) -> list[float]:
    """Read a list of gains."""
    from ...core.equalizer import HIGHEST_GAIN

    words = [word.strip() for word in text.split(",")]
    if not text.strip():
        raise argparse.ArgumentTypeError("there are no gains; give one for each level, finest first")
    try:
        gains = [float(word) for word in words]
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not a list of numbers such as 0.2,1,1.5") from None
    if len(gains) > MOST_GAINS:
        raise argparse.ArgumentTypeError(f"there are {len(gains)} gains, but at most {MOST_GAINS} levels")
    for level, gain in enumerate(gains, 1):
        if not 0.0 <= gain <= HIGHEST_GAIN:  # also refuses NaN
            raise argparse.ArgumentTypeError(
                f"the gain of level {level} is {gain:g}; it must be from 0 to {HIGHEST_GAIN:g}"
            )
    return gains
