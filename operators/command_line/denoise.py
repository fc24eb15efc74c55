# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The subcommand `denoise`: read a file, denoise its meshes, write a file."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from ...core.settings import DenoiseSettings
from ..properties.output_choices import IN_PLACE, OUTPUTS
from ..properties.region_options import RegionOptions
from ..properties.scene_units import LEAST_WIDTH
from .arguments import (
    HelpFormatter,
    add_setting_options,
    as_word,
    choice_list,
    choice_type,
    describe_choices,
    settings_from,
)
from .file_types import BLEND, check_source, file_type
from .mesh_work import Outcome, check_blender, count, describe_input, work_on_meshes
from .messages import USAGE_ERROR, CommandError, Messages
from .region_arguments import add_region_options, region_options_from
from .staging import Staging, check_folder

if TYPE_CHECKING:
    import bpy

    from ...core import NoiseBelief, NoiseEstimate
    from ...core.report import DenoiseReport
    from .importing import Surfaces


def add_command(subparsers: argparse._SubParsersAction) -> None:
    """Add the subcommand to the parser of the program."""
    parser = subparsers.add_parser(
        "denoise",
        help="denoise the meshes of a file",
        description="Denoise the surface in a PLY, OBJ or STL file, or all mesh objects in the scene of a "
        ".blend file. Vertices move; their number and order, faces, UVs and colors stay.",
        usage="%(prog)s IN OUT [options]",
        epilog="example: %(prog)s scan.ply clean.ply --report clean.json\n"
        "example: %(prog)s scan.ply clean.ply --preset tri-1 --lambda 0.4",
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
    CommandError
        If it cannot be carried out; no file is then written or changed.
    """
    source, target, report = arguments.source, arguments.target, arguments.report
    settings, options = settings_from(arguments), region_options_from(arguments)
    _check_files(source, target, report)
    output = arguments.output
    if output != IN_PLACE and file_type(target) != BLEND:
        raise CommandError(
            f"--output {as_word(output)} needs a .blend file as OUT, but {target} is none.", USAGE_ERROR
        )
    check_blender()
    from .exporting import export
    from .importing import opened
    from .report_file import write_report

    messages = Messages(arguments.quiet)
    with Staging() as staging, opened(source, messages) as surfaces:
        messages.say(describe_input(source, surfaces))
        outcome = _denoise(source, surfaces, settings, options, output, messages)
        export(surfaces.without(outcome.refused_objects), target, staging, messages)
        if report is not None:
            write_report(
                staging.path_for(report),
                source=source,
                target=target,
                preset=arguments.preset,
                settings=settings,
                options=options,
                reports=[(obj.name, found) for obj, found in outcome.done],
                skipped=[(obj.name, reason) for obj, reason in outcome.refusals],
            )
        staging.publish()
    messages.say(f"Wrote {target}" + (f" and {report}." if report is not None else "."))


def _check_files(source: Path, target: Path, report: Path | None) -> None:
    """Raise CommandError for everything that can be wrong about the files before they are opened."""
    file_type(source)
    file_type(target)
    if report is not None and report.resolve() in (source.resolve(), target.resolve()):
        raise CommandError(f"The report cannot be {report}, which is a mesh file here.", USAGE_ERROR)
    if report is not None and report.suffix.lower() != ".json":
        raise CommandError(f"The report cannot be {report}; its name must end in .json.", USAGE_ERROR)
    check_source(source)
    check_folder(target)
    if report is not None:
        check_folder(report)


def _denoise(
    source: Path,
    surfaces: Surfaces,
    settings: DenoiseSettings,
    options: RegionOptions,
    output: str,
    messages: Messages,
) -> Outcome:
    """Denoise each mesh and say what was done."""
    from ..run.denoise_object import denoise_object

    if options.together:
        return _denoise_together(source, surfaces, settings, options, output, messages)

    def work(obj: bpy.types.Object) -> DenoiseReport:
        with messages.progress(f"Denoising {obj.name}") as callback:
            report = denoise_object(obj, settings, callback, output, options)
        for line in _describe_result(obj.name, report):
            messages.say(line)
        return report

    return work_on_meshes(source, surfaces, messages, work)


def _denoise_together(
    source: Path,
    surfaces: Surfaces,
    settings: DenoiseSettings,
    options: RegionOptions,
    output: str,
    messages: Messages,
) -> Outcome:
    """Denoise all meshes as one surface, and say what was done."""
    from ..run.denoise_run import State, begin_run

    objects = list({obj.data: obj for obj in reversed(surfaces.objects)}.values())[::-1]
    try:
        run = begin_run(objects, settings, output, options)
    except ValueError as error:
        raise CommandError(f"{source}: {error}") from error
    with messages.progress(run.text) as callback:

        def show(fraction: float) -> None:
            callback(fraction, 0.0)

        run.run_here(show)
    if run.state is not State.READY:
        raise CommandError(f"{source}: {run.reason}")
    done = [(item.original, item.measured.report) for item in run.finish()]
    for obj, report in done:
        for line in _describe_result(obj.name, report):
            messages.say(line)
    left = [obj for obj in objects if obj not in [each for each, _ in done]]
    for reason in run.failures:
        messages.warn(f"{reason} It was skipped.")
    return Outcome(done, list(zip(left, run.failures, strict=True)))


def _describe_result(name: str, report: DenoiseReport) -> list[str]:
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
    if noise.is_clean:
        return "clean already"
    edge = report.mean_edge_length
    text = (
        f"noise of {noise.sigma_low:.3g} to {noise.sigma_high:.3g} "
        f"({noise.sigma_low / edge:.3g} to {noise.sigma_high / edge:.3g} mean edge lengths)"
    )
    if noise.width > LEAST_WIDTH:
        text += f", about {noise.width:.1f} edges wide"
    if noise.spikes:
        text += f", {100.0 * noise.spikes:.2g} % spikes"
    return text + (f"; {100.0 * noise.clean:.3g} % was clean and stayed" if noise.clean else "")
