# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The subcommand `bands`: read a file, split its meshes into bands, write these as arrays."""

from __future__ import annotations

import argparse
import io
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...core.settings import DenoiseSettings
from ..files.safe_write import Outputs, check_target
from .arguments import HelpFormatter, add_frame_options, as_word
from .band_arrays import LAYOUT, band_arrays
from .file_types import WORDS, check_source, file_type, needs_blender
from .file_work import open_source, surface_to_work_on
from .mesh_work import count, work_on_each
from .messages import USAGE_ERROR, CommandError, Messages
from .targets import publish
from .version import framelet_version

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ...core import SurfaceMesh
    from ..files import Part

FRAME_OPTIONS = ("frame", "stencil", "levels", "boundary")
SUFFIX = ".npz"
MAX_MEGABYTES = 4000.0


def add_command(subparsers: argparse._SubParsersAction[Any]) -> None:
    """Add the subcommand to the parser of the program."""
    parser = subparsers.add_parser(
        "bands",
        help="write the frame coefficients of the meshes of a file as arrays",
        description="Split the surfaces in a PLY, OBJ, STL, GLB or glTF file, or with Blender all mesh "
        "objects in the scene of a .blend, .fbx, .usd or .abc file, into a low-pass and the bands of a tight "
        "wavelet frame; write these as NumPy arrays.",
        usage="%(prog)s IN --out BANDS.npz [options]",
        epilog=f"example: %(prog)s scan.ply --out bands.npz --frame adaptive --levels 3\n\n{LAYOUT}",
        formatter_class=HelpFormatter,
        allow_abbrev=False,
    )
    files = parser.add_argument_group("files")
    files.add_argument("source", metavar="IN", type=Path, help=f"the file to read: {WORDS}")
    files.add_argument(
        "--out",
        dest="target",
        metavar="BANDS.npz",
        type=Path,
        required=True,
        help="the file to write; one that exists is replaced once all went well. With several meshes in IN "
        "there is one file for each: BANDS-1.npz, BANDS-2.npz and so on, in the order of IN",
    )
    files.add_argument(
        "--max-size",
        metavar="MB",
        type=_megabytes,
        default=MAX_MEGABYTES,
        help=f"write no bands of a mesh that take more megabytes than this (default: {MAX_MEGABYTES:g})",
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
    source, target = arguments.source, arguments.target
    settings = DenoiseSettings(
        method="POSITIONS", **{name: getattr(arguments, name) for name in FRAME_OPTIONS}
    )
    file_type(source)
    if target.suffix.lower() != SUFFIX:
        raise CommandError(f"{target} is no {SUFFIX} file; bands are written as NumPy arrays.", USAGE_ERROR)
    check_source(source)
    check_target(target)
    messages = Messages(arguments.quiet)
    with Outputs() as outputs:
        if needs_blender(source):
            from .blender_process import run_in_blender

            run_in_blender(
                "bands",
                source,
                target,
                outputs,
                messages,
                settings={name: getattr(settings, name) for name in FRAME_OPTIONS},
                max_size=arguments.max_size,
            )
        else:
            _analyze_file(arguments, settings, outputs, messages)
        publish(outputs, [], messages)


def _analyze_file(
    arguments: argparse.Namespace, settings: DenoiseSettings, outputs: Outputs, messages: Messages
) -> None:
    """Analyze each surface of a file that Blender is not needed for."""
    opened = open_source(arguments.source, messages)
    parts = opened.parts()

    def work(item: tuple[int, Part]) -> None:
        number, part = item
        surface = surface_to_work_on(opened, part)
        content, sentence = analyzed(part.name, surface, settings, arguments.max_size)
        outputs.write(numbered(arguments.target, number, len(parts)), content)
        messages.say(sentence)

    items = [(name, (number, part)) for number, (name, part) in enumerate(parts, 1)]
    work_on_each(arguments.source, items, messages, work)


def numbered(target: Path, number: int, n_surfaces: int) -> Path:
    """Return the file for one of several surfaces.

    Raises
    ------
    FileError
        If it cannot be written.
    """
    path = target if n_surfaces == 1 else target.with_stem(f"{target.stem}-{number}")
    check_target(path)
    return path


def analyzed(
    name: str, surface: SurfaceMesh, settings: DenoiseSettings, max_megabytes: float
) -> tuple[bytes, str]:
    """Return the arrays of a mesh as a file, and a sentence about them.

    Raises
    ------
    ValueError
        With a sentence that begins with the name, if the mesh cannot be analyzed.
    """
    import numpy as np

    try:
        arrays = band_arrays(surface, settings, max_megabytes)
    except ValueError as error:
        raise ValueError(f"‘{name}’: {error}") from error
    named: dict[str, Any] = arrays | {"name": np.array(name), "version": np.array(framelet_version())}
    file = io.BytesIO()
    np.savez(file, **named)
    return file.getvalue(), _describe(name, arrays)


def _describe(name: str, arrays: dict[str, NDArray[Any]]) -> str:
    """Say what the bands of an object are."""
    parts = []
    for level in range(1, int(arrays["levels"]) + 1):
        n_bands, n_sites, _ = arrays[f"L{level}"].shape
        sites = "cells" if level == 1 and "cell_owner" in arrays else "vertices"
        parts.append(f"level {level} has {count(n_bands, 'band')} on {n_sites:,} {sites}")
    megabytes = sum(array.nbytes for array in arrays.values()) / 1e6
    return f"Analyzed {name} with {as_word(str(arrays['frame']))}: {'; '.join(parts)}; {megabytes:.3g} MB."


def _megabytes(text: str) -> float:
    """Read a size."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not value > 0.0:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number of megabytes above 0")
    return value
