# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The subcommand `equalize`: read a file, turn the scales of its meshes up and down, write a file."""

from __future__ import annotations

import argparse
from dataclasses import fields
from typing import TYPE_CHECKING, Any

from ...core.settings import DenoiseSettings
from ..files.safe_write import Outputs
from .arguments import HelpFormatter, add_frame_options
from .file_work import move, open_source, weld_of, write_target
from .mesh_work import work_on_each
from .messages import Messages
from .targets import add_target_arguments, check_files, publish, target_of

if TYPE_CHECKING:
    from pathlib import Path

    import numpy as np
    from numpy.typing import NDArray

    from ...core import SurfaceMesh
    from ..files import Part

FRAME_OPTIONS = ("frame", "stencil", "boundary")
MOST_GAINS = next(
    int(item.metadata["info"].maximum) for item in fields(DenoiseSettings) if item.name == "levels"
)


def add_command(subparsers: argparse._SubParsersAction[Any]) -> None:
    """Add the subcommand to the parser of the program."""
    parser = subparsers.add_parser(
        "equalize",
        help="smooth or exaggerate the details of the meshes of a file, scale by scale",
        description="Multiply the details of each scale by a gain, in a PLY, OBJ, STL, GLB or glTF file: OUT "
        "is a copy of IN in which only coordinates differ. With Blender, .blend, .fbx, .usd and .abc files "
        "can be worked on, too: all mesh objects in their scene.",
        usage="%(prog)s IN OUT --gains G1,G2,... [options]",
        epilog="example: %(prog)s scan.ply bold.ply --gains 0.2,1,1.5",
        formatter_class=HelpFormatter,
        allow_abbrev=False,
    )
    add_target_arguments(parser.add_argument_group("files"))
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
    CommandError or FileError
        If it cannot be carried out; no file is then written or changed.
    """
    target = target_of(arguments)
    options = {name: getattr(arguments, name) for name in FRAME_OPTIONS}
    is_for_blender = check_files(arguments, target)
    messages = Messages(arguments.quiet)
    with Outputs() as outputs:
        if is_for_blender:
            from .blender_process import run_in_blender

            run_in_blender(
                "equalize", arguments.source, target, outputs, messages, gains=arguments.gains, frame=options
            )
        else:
            _equalize(arguments, target, options, outputs, messages)
        publish(outputs, outputs.keep_backups() if arguments.backup else [], messages)


def _equalize(
    arguments: argparse.Namespace, target: Path, options: dict[str, str], outputs: Outputs, messages: Messages
) -> None:
    """Equalize each surface of a file that Blender is not needed for, and write the result."""
    opened = open_source(arguments.source, messages)

    def work(part: Part) -> None:
        from ...core import equalize

        moved: list[tuple[float, float]] = []

        def solve(surface: SurfaceMesh) -> NDArray[np.floating]:
            frame, stencil, boundary = (options[name] for name in FRAME_OPTIONS)
            weld = weld_of(opened, surface)
            worked = surface if weld is None else weld.surface
            vertices = equalize(worked, arguments.gains, frame=frame, stencil=stencil, boundary=boundary)
            if weld is not None:
                vertices = vertices[weld.vertex]
            moved.append(displacement(surface.vertices, vertices))
            return vertices

        move(opened, part, messages, solve)
        messages.say(describe_result(part.name, *moved[0]))

    work_on_each(arguments.source, opened.parts(), messages, work)
    write_target(opened, target, outputs, messages)


def describe_result(name: str, rms: float, maximum: float) -> str:
    """Say what was done to a surface."""
    return f"Equalized {name}: vertices moved by {rms:.4g} rms and {maximum:.4g} at most."


def displacement(before: NDArray[np.floating], after: NDArray[np.floating]) -> tuple[float, float]:
    """Return how far vertices, shape (N, 3), moved: the root of the mean square, and the largest distance."""
    import numpy as np

    from ..properties.scene_units import displacement_by

    return displacement_by(np.eye(3), before, after)


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
