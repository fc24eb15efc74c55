# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tell people what a run did: the properties that the sidebar shows, a sentence, and the selection."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bpy.app.translations import pgettext_rpt as rpt_

from .heat_map import refresh_heat
from .mesh_io.coarseness import coarse_step
from .mesh_io.hints import hints
from .mesh_io.mesh_bridge import read_positions
from .preview.targets import names_text
from .properties.scene_units import noise_text, range_text
from .reports.filled_reports import fill_estimate_of_run, fill_report
from .run.output import select_instead

if TYPE_CHECKING:
    from collections.abc import Iterable

    import bpy

    from .reports.report import FrameletReport
    from .run.denoise_run import Written


def report_written(
    operator: bpy.types.Operator, context: bpy.types.Context, written: Iterable[Written]
) -> None:
    """Fill the report of the last run, select new objects, and have the operator report a sentence."""
    written = list(written)
    select_instead(context.view_layer, [(item.original, item.obj) for item in written])
    measured = {item.obj.name: item.measured for item in written}
    report = context.window_manager.framelet_report
    fill_report(report, measured)
    fill_estimate_of_run(context.window_manager.framelet_estimate, measured)
    refresh_heat(context, [item.obj for item in written])
    found = [hint for item in written for hint in hints(item.original, item.measured.report.noise)]
    report.hints = "\n".join(dict.fromkeys(found))
    notes = [item.note for item in written] + found
    for item in written:
        edge = item.measured.report.mean_edge_length
        step = (
            coarse_step(read_positions(item.original.data), edge) if item.original.mode == "OBJECT" else 0.0
        )
        if step:
            operator.report(
                {"WARNING"},
                rpt_(
                    "‘{name}’ is far from the origin of its object, where positions come in steps of "
                    "{edges:.2g} edge lengths; move its vertices there first"
                ).format(name=item.original.name, edges=step),
            )
    operator.report(
        {"INFO"},
        rpt_("Denoised {names} in {seconds:.1f} s").format(
            names=names_text(list(measured)), seconds=report.seconds
        )
        + _noise_words(context.scene, report)
        + "".join(f"; {note}" for note in dict.fromkeys(notes) if note),
    )


def _noise_words(scene: bpy.types.Scene, report: FrameletReport) -> str:
    """Say which noise was measured or taken away; nothing if it is not known."""
    if report.has_belief:
        return _belief_words(scene, report)
    if not report.has_noise:
        return ""
    noise = noise_text(scene, report.noise_sigma, report.noise_sigma_edges, report.is_impulsive)
    words = rpt_("; noise {noise}").format(noise=noise)
    return words + (rpt_("; used {what}").format(what=report.parameters) if report.parameters else "")


def _belief_words(scene: bpy.types.Scene, report: FrameletReport) -> str:
    """Say what automatic denoising took for noise."""
    if report.is_off:
        return rpt_("; Strength is 0")
    if report.is_clean:
        return rpt_("; clean already")
    # In one breath: Last Run has the rest.
    lengths = range_text(report.sigma_low, report.sigma_high, scene)
    return rpt_(": noise of {lengths} removed").format(lengths=lengths)
