# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The subcommand `bands`: read a file, split its meshes into bands, write these as arrays."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...core.settings import DenoiseSettings
from .arguments import HelpFormatter, add_frame_options, as_word
from .band_arrays import LAYOUT, band_arrays
from .file_types import check_source, file_type
from .mesh_work import check_blender, count, describe_input, work_on_meshes
from .messages import USAGE_ERROR, CommandError, Messages
from .staging import Staging, check_folder
from .version import framelet_version

if TYPE_CHECKING:
    import bpy
    from numpy.typing import NDArray

FRAME_OPTIONS = ("frame", "stencil", "levels", "boundary")
SUFFIX = ".npz"
MAX_MEGABYTES = 4000.0


def add_command(subparsers: argparse._SubParsersAction) -> None:
    """Add the subcommand to the parser of the program."""
    parser = subparsers.add_parser(
        "bands",
        help="write the frame coefficients of the meshes of a file as arrays",
        description="Split the surface in a PLY, OBJ or STL file, or all mesh objects in the scene of a "
        ".blend file, into a low-pass and the bands of a tight wavelet frame; write these as NumPy arrays.",
        usage="%(prog)s IN --out BANDS.npz [options]",
        epilog=f"example: %(prog)s scan.ply --out bands.npz --frame adaptive --levels 3\n\n{LAYOUT}",
        formatter_class=HelpFormatter,
        allow_abbrev=False,
    )
    files = parser.add_argument_group("files")
    files.add_argument("source", metavar="IN", type=Path, help="the file to read: .ply, .obj, .stl or .blend")
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
    CommandError
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
    check_folder(target)
    check_blender()
    from .importing import opened

    messages = Messages(arguments.quiet)
    with Staging() as staging, opened(source, messages) as surfaces:
        messages.say(describe_input(source, surfaces))
        meshes = list(dict.fromkeys(obj.data for obj in surfaces.objects))
        written: list[Path] = []

        def work(obj: bpy.types.Object) -> None:
            arrays = _analyze(obj, settings, arguments.max_size)
            number = meshes.index(obj.data) + 1
            path = target if len(meshes) == 1 else target.with_stem(f"{target.stem}-{number}")
            check_folder(path)
            _write(arrays, staging.path_for(path))
            written.append(path)
            messages.say(_describe(obj.name, arrays))

        work_on_meshes(source, surfaces, messages, work)
        staging.publish()
    messages.say(f"Wrote {', '.join(map(str, written))}.")


def _analyze(obj: bpy.types.Object, settings: DenoiseSettings, max_megabytes: float) -> dict[str, NDArray]:
    """Return the arrays of an object's mesh."""
    import numpy as np

    from ..mesh_io.mesh_bridge import read_surface, refusal

    reason = refusal(obj)
    if reason is not None:
        raise ValueError(reason)
    try:
        arrays = band_arrays(read_surface(obj), settings, max_megabytes)
    except ValueError as error:
        raise ValueError(f"‘{obj.name}’: {error}") from error
    return arrays | {"name": np.array(obj.name), "version": np.array(framelet_version())}


def _write(arrays: dict[str, Any], path: Path) -> None:
    """Write arrays into a file, whatever the case of its suffix."""
    import numpy as np

    try:
        with path.open("wb") as file:
            np.savez(file, **arrays)
    except OSError as error:
        raise CommandError(f"{path.name} could not be written: {error.strerror or error}.") from error


def _describe(name: str, arrays: dict[str, NDArray]) -> str:
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
