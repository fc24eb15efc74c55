# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The subcommand `denoise`: read a file, denoise its meshes, write a file."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from ...core.settings import DenoiseSettings
from .arguments import HelpFormatter, add_setting_options, settings_from
from .file_types import check_source, file_type
from .messages import FAILURE, USAGE_ERROR, CommandError, Messages
from .staging import Staging, check_folder

if TYPE_CHECKING:
    import bpy

    from ...core.denoising.report import DenoiseReport
    from .importing import Surfaces

Reports = list[tuple[str, "DenoiseReport"]]
Refusals = list[tuple["bpy.types.Object", str]]


def add_command(subparsers: argparse._SubParsersAction) -> None:
    """Add the subcommand to the parser of the program."""
    parser = subparsers.add_parser(
        "denoise",
        help="denoise the meshes of a file",
        description="Denoise the surface in a PLY, OBJ or STL file, or all mesh objects in the scene of a "
        ".blend file. Vertices move; their number and order, faces, UVs and colors stay.",
        usage="%(prog)s IN OUT [options]",
        epilog="example: %(prog)s scan.ply clean.ply --preset tri-1 --lambda 0.4 --report clean.json",
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
    files.add_argument(
        "--report", metavar="FILE.json", type=Path, help="write settings and measurements here"
    )
    add_setting_options(parser)
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
    source, target, report = arguments.source, arguments.target, arguments.report
    settings = settings_from(arguments)
    _check_files(source, target, report)
    _check_blender()
    from .exporting import export
    from .importing import opened
    from .report_file import write_report

    messages = Messages(arguments.quiet)
    with Staging() as staging, opened(source, messages) as surfaces:
        messages.say(_describe_input(source, surfaces))
        reports, refusals = _denoise(surfaces, settings, messages)
        if not reports:
            raise CommandError(f"{source}: {refusals[0][1]}")
        export(surfaces.without([obj for obj, _reason in refusals]), target, staging, messages)
        if report is not None:
            write_report(
                staging.path_for(report),
                source=source,
                target=target,
                preset=arguments.preset,
                settings=settings,
                reports=reports,
                skipped=[(obj.name, reason) for obj, reason in refusals],
            )
        staging.publish()
    messages.say(f"Wrote {target}" + (f" and {report}." if report is not None else "."))


def _check_files(source: Path, target: Path, report: Path | None) -> None:
    """Raise CommandError for everything that can be wrong about the files before they are opened."""
    file_type(source)
    file_type(target)
    if report is not None and report.resolve() in (source.resolve(), target.resolve()):
        raise CommandError(f"The report cannot be {report}, which is a mesh file here.", USAGE_ERROR)
    check_source(source)
    check_folder(target)
    if report is not None:
        check_folder(report)


def _check_blender() -> None:
    """Raise CommandError where there is no Blender."""
    from .blender_output import captured_output

    try:
        with captured_output():
            import bpy  # noqa: F401
    except ImportError as error:
        raise CommandError(
            f"Blender cannot be used from this Python ({error}); install the module with 'pip install bpy', "
            "or use 'blender -c framelet'.",
            FAILURE,
        ) from error


def _denoise(surfaces: Surfaces, settings: DenoiseSettings, messages: Messages) -> tuple[Reports, Refusals]:
    """Denoise each mesh once; objects that share one share the result."""
    from ..denoise_object import denoise_object

    reports: Reports = []
    refusals: Refusals = []
    done: set[bpy.types.Mesh] = set()
    for obj in surfaces.objects:
        if obj.data in done:
            continue
        done.add(obj.data)
        try:
            with messages.progress(f"Denoising {obj.name}") as callback:
                report = denoise_object(obj, settings, callback)
        except ValueError as error:
            refusals.append((obj, str(error)))
        else:
            reports.append((obj.name, report))
            for line in _describe_result(obj.name, report):
                messages.say(line)
    # Where nothing at all could be done the first reason is the error.
    for _obj, reason in refusals if reports else ():
        messages.warn(f"{reason} It was skipped.")
    return reports, refusals


def _describe_input(source: Path, surfaces: Surfaces) -> str:
    """Say how large the input is."""
    meshes = {obj.data for obj in surfaces.objects}
    n_vertices, n_faces = sum(len(m.vertices) for m in meshes), sum(len(m.polygons) for m in meshes)
    text = f"Read {source}: {n_vertices:,} vertices, {n_faces:,} faces"
    if len(surfaces.objects) > 1:
        return f"{text} in {len(surfaces.objects)} objects."
    size = " x ".join(f"{length:.4g}" for length in surfaces.objects[0].dimensions)
    return f"{text}, size {size}."


def _describe_result(name: str, report: DenoiseReport) -> list[str]:
    """Say what was done to an object."""
    edge = report.mean_edge_length or 1.0
    volume = "" if report.volume_change is None else f"; volume {report.volume_change:+.3%}"
    return [
        f"Denoised {name} in {report.seconds:.2f} s: {_count(report.iterations, 'iteration')}, "
        f"{report.n_moved:,} vertices moved by {report.displacement_rms:.4g} rms and "
        f"{report.displacement_max:.4g} at most ({report.displacement_rms / edge:.3g} and "
        f"{report.displacement_max / edge:.3g} mean edge lengths of {report.mean_edge_length:.4g}).",
        f"  {_count(report.flipped_faces, 'flipped face')}{volume}; vertices: "
        f"{report.irregular_vertices:,} irregular, {report.boundary_vertices:,} boundary, "
        f"{report.non_manifold_vertices:,} non-manifold, {report.loose_vertices:,} loose.",
    ]


def _count(number: int, noun: str) -> str:
    """Return a number with its noun."""
    return f"{number:,} {noun}{'' if number == 1 else 's'}"
