# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Write the outcome of a run to the properties that the sidebar shows."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..core import Comparison
    from .band_values import BandChoice, ColorRange
    from .denoise_object import MeasuredReport
    from .report import FrameletBandRange, FrameletComparison, FrameletReport

SUMMED = (
    "n_vertices",
    "n_moved",
    "flipped_faces",
    "irregular_vertices",
    "boundary_vertices",
    "non_manifold_vertices",
    "loose_vertices",
    "seconds",
)


def fill_report(properties: FrameletReport, measured: Mapping[str, MeasuredReport]) -> None:
    """Take over the reports of a run, by object name: counts are summed, squares averaged over vertices."""
    reports = [item.report for item in measured.values()]
    counts = [report.n_vertices for report in reports]
    properties.names = ", ".join(measured)
    properties.n_objects = len(reports)
    for name in SUMMED:
        setattr(properties, name, sum(getattr(report, name) for report in reports))
    properties.iterations = max(report.iterations for report in reports)
    properties.displacement_rms = _rms([item.scene_rms for item in measured.values()], counts)
    properties.displacement_max = max(item.scene_max for item in measured.values())
    in_edges = [report.displacement_rms / report.mean_edge_length for report in reports]
    properties.displacement_rms_edges = _rms(in_edges, counts)
    farthest = [report.displacement_max / report.mean_edge_length for report in reports]
    properties.displacement_max_edges = max(farthest)
    volumes = [report.volume_change for report in reports if report.volume_change is not None]
    properties.is_closed = len(volumes) == len(reports)
    properties.volume_change = 100.0 * max(volumes, key=abs, default=0.0)


def fill_comparison(properties: FrameletComparison, name: str, other: str, comparison: Comparison) -> None:
    """Take over a comparison whose lengths are in scene units."""
    properties.object_name, properties.other_name = name, other
    for item in ("mean_angle", "max_angle", "rms_distance", "max_distance", "flipped_faces"):
        setattr(properties, item, getattr(comparison, item))
    properties.rms_distance_edges = comparison.rms_distance / comparison.mean_edge_length
    properties.max_distance_edges = comparison.max_distance / comparison.mean_edge_length


def fill_band_range(
    properties: FrameletBandRange, names: list[str], choice: BandChoice, found: ColorRange
) -> None:
    """Take over which values the colors of a band cover."""
    properties.names, properties.title, properties.is_signed = (
        ", ".join(names),
        choice.title,
        choice.is_signed,
    )
    properties.minimum = -found.limit if choice.is_signed else 0.0
    properties.maximum, properties.largest = found.limit, found.largest
    properties.share = 100.0 * found.share


def _rms(values: list[float], counts: list[int]) -> float:
    """Return the root mean square of values that stand for several vertices each."""
    total = sum(count * value**2 for value, count in zip(values, counts, strict=True))
    return (total / sum(counts)) ** 0.5
