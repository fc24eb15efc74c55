# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tell people what a run did: the properties that the sidebar shows, a sentence, and the selection."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bpy.app.translations import pgettext_rpt as rpt_

from .filled_reports import fill_estimate_of_run, fill_report
from .heat_map import refresh_heat
from .output import select_instead
from .scene_units import length_text, noise_text
from .targets import names_text

if TYPE_CHECKING:
    from collections.abc import Iterable

    import bpy

    from .denoise_run import Written
    from .report import FrameletReport


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
    operator.report(
        {"INFO"},
        rpt_(
            "Denoised {names}: {moved:,} of {total:,} vertices moved, {length} RMS "
            "({edges:.3f} edge lengths), in {seconds:.2f} s"
        ).format(
            names=names_text(list(measured)),
            moved=report.n_moved,
            total=report.n_vertices,
            length=length_text(context.scene, report.displacement_rms),
            edges=report.displacement_rms_edges,
            seconds=report.seconds,
        )
        + _noise_words(context.scene, report),
    )


def _noise_words(scene: bpy.types.Scene, report: FrameletReport) -> str:
    """Say which noise was measured and what was made of it; nothing if it was not measured."""
    if not report.has_noise:
        return ""
    from ..core.automatic.filter import CLEAN  # and NumPy, which enabling the extension must not import

    noise = noise_text(scene, report.noise_sigma, report.noise_sigma_edges, report.is_impulsive)
    taken = report.recipe or report.parameters
    words = rpt_("; noise {noise}").format(noise=noise)
    if taken == CLEAN:
        return words + rpt_("; clean already")
    return words + (rpt_("; used {what}").format(what=taken) if taken else "")
