# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The subcommand `denoise`: read a file, denoise its meshes, write a file."""

from __future__ import annotations

import argparse
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...core.settings import DenoiseSettings
from ..files.safe_write import Outputs
from ..properties.output_choices import IN_PLACE, OUTPUTS
from ..properties.region_options import RegionOptions
from ..properties.scene_units import LEAST_WIDTH
from .arguments import (
    HelpFormatter,
    add_setting_options,
    choice_list,
    choice_type,
    describe_choices,
    settings_from,
)
from .file_work import move, open_source, refuse_blender_options, region_of, write_target
from .mesh_work import count, work_on_each
from .messages import Messages
from .region_arguments import add_region_options, region_options_from
from .report_file import Report
from .targets import add_target_arguments, check_files, publish, target_of

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from ...core import NoiseBelief, NoiseEstimate, SurfaceMesh
    from ...core.report import DenoiseReport
    from ..files import Part
    from .file_work import OpenedFile
    from .mesh_work import Outcome

HINTS = {
    "VOXELS": "; it is made of voxels: --preset marching-cubes rounds the steps",
    "TERRACES": "; its heights are in whole steps: --preset tri-2 takes them away",
}


def add_command(subparsers: argparse._SubParsersAction[Any]) -> None:
    """Add the subcommand to the parser of the program."""
    parser = subparsers.add_parser(
        "denoise",
        help="denoise the meshes of a file",
        description="Denoise the surfaces in a PLY, OBJ, STL, GLB or glTF file: OUT is a copy of IN in which "
        "only coordinates differ. With Blender, .blend, .fbx, .usd and .abc files can be denoised, too: all "
        "mesh objects in their scene.",
        usage="%(prog)s IN OUT [options]",
        epilog="example: %(prog)s scan.ply clean.ply --report clean.json\n"
        "example: %(prog)s scan.ply clean.ply --preset tri-1 --lambda 0.4",
        formatter_class=HelpFormatter,
        allow_abbrev=False,
    )
    files = parser.add_argument_group("files")
    add_target_arguments(files)
    files.add_argument(
        "--report", metavar="FILE.json", type=Path, help="write settings and measurements here"
    )
    identifiers = [choice.identifier for choice in OUTPUTS]
    files.add_argument(
        "--output",
        type=choice_type(identifiers),
        metavar=choice_list(identifiers),
        default=IN_PLACE,
        help="where the denoised surface goes in a .blend file (default: in-place)"
        + describe_choices((choice.identifier, choice.description) for choice in OUTPUTS),
    )
    add_setting_options(parser)
    add_region_options(parser)
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
        If it cannot be carried out; no file is then written or changed but the report, which says why.
    """
    source, target = arguments.source, target_of(arguments)
    settings, options = settings_from(arguments), region_options_from(arguments)
    report = Report(arguments.report, source, target, arguments.preset, settings, options)
    with report.of_failure():
        report.check()
        refuse_blender_options(arguments.output, target)
        is_for_blender = check_files(arguments, target)
        messages = Messages(arguments.quiet)
        with Outputs() as outputs:
            if is_for_blender:
                from .blender_process import run_in_blender

                found = run_in_blender(
                    "denoise",
                    source,
                    target,
                    outputs,
                    messages,
                    settings=asdict(settings),
                    options=asdict(options),
                    output=arguments.output,
                )
                report.add_entries(found["entries"], found["skipped"], found["blender"])
            else:
                opened = open_source(source, messages)
                outcome = denoise_opened(opened, settings, options, messages)
                write_target(opened, target, outputs, messages)
                report.add(outcome)
            kept = outputs.keep_backups() if arguments.backup else []
            report.write(outputs)
            publish(outputs, kept, messages)


def denoise_opened(
    opened: OpenedFile, settings: DenoiseSettings, options: RegionOptions, messages: Messages
) -> Outcome:
    """Denoise each surface of a file that Blender is not needed for.

    Parameters
    ----------
    opened : OpenedFile
        The file; its positions are changed.
    settings, options
        What is done, and where.
    messages : Messages
        Says what was done.

    Raises
    ------
    CommandError
        If nothing at all could be done.
    """
    if options.keep_sharp:
        messages.warn(f"--keep-sharp has no effect: {opened.source} marks no edges as sharp.")

    def work(part: Part) -> DenoiseReport:
        from ...core import denoise

        reports: list[DenoiseReport] = []

        def solve(surface: SurfaceMesh) -> NDArray[np.floating]:
            movable, region = region_of(opened, part, surface, options)
            with messages.progress(f"Denoising {part.name}") as callback:
                result = denoise(surface, settings, movable=movable, region=region, callback=callback)
            reports.append(result.report)
            return result.vertices

        move(opened, part, messages, solve)
        for line in describe_result(part.name, reports[0]):
            messages.say(line)
        return reports[0]

    parts = [opened.whole()] if options.together else opened.parts()
    return work_on_each(opened.source, parts, messages, work)


def describe_result(name: str, report: DenoiseReport) -> list[str]:
    """Say what was done to an object."""
    edge = report.mean_edge_length or 1.0
    lines = [] if report.noise is None else [_describe_noise(report, report.noise)]
    volume = "" if report.volume_change is None else f"; volume {report.volume_change:+.3%}"
    rounds = count(report.iterations, "pass" if report.settings.method == "AUTO" else "iteration")
    return [
        f"Denoised {name} in {report.seconds:.2f} s: {rounds}, "
        f"{report.n_moved:,} vertices moved by {report.displacement_rms:.4g} rms and "
        f"{report.displacement_max:.4g} at most ({report.displacement_rms / edge:.3g} and "
        f"{report.displacement_max / edge:.3g} mean edge lengths of {report.mean_edge_length:.4g}).",
        f"  {count(report.flipped_faces, 'flipped face')}{volume}; vertices: "
        f"{report.irregular_vertices:,} irregular, {report.boundary_vertices:,} boundary, "
        f"{report.non_manifold_vertices:,} non-manifold, {report.loose_vertices:,} loose.",
        *_describe_region(report),
        *lines,
    ]


def _describe_region(report: DenoiseReport) -> list[str]:
    """Say what folded, and what limits of the region did, if anything."""
    parts = [
        f"{count(now, noun)} ({before:,} before)"
        for now, before, noun in (
            (report.folded_faces, report.folded_faces_before, "folded face"),
            (report.degenerate_faces, report.degenerate_faces_before, "degenerate face"),
        )
        if now or before
    ]
    parts += [
        f"{number:,} vertices {what}"
        for number, what in (
            (report.damped_vertices, "damped against folds"),
            (report.line_vertices, "on sharp edges"),
            (report.welded_vertices, "welded"),
        )
        if number
    ]
    return [f"  {'; '.join(parts)}."] if parts else []


def _describe_noise(report: DenoiseReport, noise: NoiseEstimate) -> str:
    """Say how strong the noise was, and what was taken from it."""
    from ...core import NoiseBelief

    if isinstance(noise, NoiseBelief):
        return f"  {_describe_belief(report, noise)}."
    text = f"  noise of {noise.sigma:.4g} ({noise.sigma_edges:.3g} mean edge lengths)"
    if noise.is_impulsive:
        text += ", impulsive"
    used = report.settings
    iterations = count(used.iterations, "iteration")
    return f"{text}; taken from it: λ {used.lambda_:.3g}, μ {used.mu:.3g}, {iterations}."


def _describe_belief(report: DenoiseReport, noise: NoiseBelief) -> str:
    """Say what automatic denoising took for noise."""
    if report.settings.strength == 0.0:
        return "strength is 0, so that nothing moves"
    hint = HINTS.get(noise.steps, "")
    if noise.is_clean:
        if noise.is_doubtful:
            hint = "; if what is left is noise, it is several edges wide: try --noise wide"
        return "clean already" + hint
    edge = report.mean_edge_length
    text = (
        f"noise of {noise.sigma_low:.3g} to {noise.sigma_high:.3g} "
        f"({noise.sigma_low / edge:.3g} to {noise.sigma_high / edge:.3g} mean edge lengths)"
    )
    if noise.width > LEAST_WIDTH:
        text += f", about {noise.width:.1f} edges wide"
    if noise.spikes:
        text += f", {100.0 * noise.spikes:.2g} % spikes"
    if noise.wide:
        text += f", wide in {100.0 * noise.wide:.3g} % of the faces"
    if noise.along:
        text += f", {noise.along:.2g} mean edge lengths of it along the surface"
    return text + (f"; {100.0 * noise.clean:.3g} % was clean and stayed" if noise.clean else "") + hint
