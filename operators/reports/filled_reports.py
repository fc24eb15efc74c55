# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Write the outcome of a run to the properties that the sidebar shows."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from typing import TYPE_CHECKING, NamedTuple

from .report import BeliefMixin

if TYPE_CHECKING:
    from ...core import Comparison, NoiseEstimate
    from ...core.report import DenoiseReport
    from ..bands.band_values import ColorRange
    from ..run.denoise_job import MeasuredReport
    from .report import FrameletBandRange, FrameletComparison, FrameletEstimate, FrameletNoise, FrameletReport

SUMMED = (
    "n_vertices",
    "n_moved",
    "flipped_faces",
    "folded_faces",
    "folded_faces_before",
    "degenerate_faces",
    "degenerate_faces_before",
    "damped_vertices",
    "line_vertices",
    "welded_vertices",
    "irregular_vertices",
    "boundary_vertices",
    "non_manifold_vertices",
    "loose_vertices",
    "seconds",
)


class MeasuredNoise(NamedTuple):
    """The noise of an object, whose lengths are in object space, and the scale that makes scene units."""

    noise: NoiseEstimate
    scale: float
    is_part: bool = False
    """Whether it is that of a part of the mesh."""


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
    _fill_belief(properties, measured.values())
    texts = {_parameters_text(report) for report in reports}
    properties.parameters = texts.pop() if len(texts) == 1 else "Different for each"
    frames = {report.frame for report in reports}
    properties.frame = frames.pop() if len(frames) == 1 else ""
    noises = [report.noise for report in reports if report.noise is not None]
    properties.has_noise = len(noises) == len(reports)
    if not properties.has_noise:
        properties.noise_sigma = properties.noise_sigma_edges = 0.0
        properties.is_impulsive = False
        return
    sigmas = [item.scale * noise.sigma for item, noise in zip(measured.values(), noises, strict=True)]
    properties.noise_sigma = _rms(sigmas, counts)
    properties.noise_sigma_edges = _rms([noise.sigma_edges for noise in noises], counts)
    properties.is_impulsive = any(noise.is_impulsive for noise in noises)


def fill_estimate(properties: FrameletEstimate, measured: Mapping[str, MeasuredNoise]) -> None:
    """Take over the noise of objects, by name; what was known before is dropped."""
    properties.objects.clear()
    for name, item in measured.items():
        _add_noise(properties, name, item.noise, item.scale)


def fill_estimate_of_run(properties: FrameletEstimate, measured: Mapping[str, MeasuredReport]) -> None:
    """Take over the noise that a denoising run measured; forget that of objects where it did not."""
    forget_estimate(properties, measured)
    if any(item.report.noise is not None for item in measured.values()):
        properties.objects.clear()
    for name, item in measured.items():
        noise = item.report.noise
        if noise is not None:
            entry = _add_noise(properties, name, noise, item.scale)
            entry.is_denoised = True
            _fill_belief(entry, [item])
            if _takes_parameters(item.report):
                settings = item.report.settings
                entry.chosen_lambda, entry.chosen_mu = f"{settings.lambda_:.3g}", f"{settings.mu:.3g}"


def forget_estimate(properties: FrameletEstimate, names: Iterable[str]) -> None:
    """Drop the noise of objects whose meshes changed."""
    for name in names:
        index = properties.objects.find(name)
        if index >= 0:
            properties.objects.remove(index)


def fill_comparison(properties: FrameletComparison, name: str, other: str, comparison: Comparison) -> None:
    """Take over a comparison whose lengths are in scene units."""
    properties.object_name, properties.other_name = name, other
    for item in ("mean_angle", "max_angle", "rms_distance", "max_distance", "flipped_faces"):
        setattr(properties, item, getattr(comparison, item))
    properties.rms_distance_edges = comparison.rms_distance / comparison.mean_edge_length
    properties.max_distance_edges = comparison.max_distance / comparison.mean_edge_length


def fill_band_range(
    properties: FrameletBandRange,
    names: list[str],
    title: str,
    found: ColorRange,
    *,
    is_signed: bool,
    quantity: str = "",
    unit: str = "LENGTH",
) -> None:
    """Take over what colors mean; `quantity` is that of a heat map."""
    properties.objects.clear()
    for name in names:
        properties.objects.add().name = name
    properties.title, properties.is_signed = title, is_signed
    properties.quantity, properties.unit = quantity, unit
    properties.minimum = -found.limit if is_signed else 0.0
    properties.maximum, properties.largest = found.limit, found.largest
    properties.share = 100.0 * found.share
    properties.tolerance, properties.green = found.tolerance, 100.0 * found.green


def _fill_belief(properties: BeliefMixin, measured: Collection[MeasuredReport]) -> None:
    """Take over what runs took for noise; empty it if they were none of automatic denoising."""
    from ...core import NoiseBelief

    for name in BeliefMixin.__annotations__:
        properties.property_unset(name)  # type: ignore[attr-defined]  # of Blender's base class
    reports = [item.report for item in measured]
    beliefs = [report.noise for report in reports if isinstance(report.noise, NoiseBelief)]
    if len(beliefs) != len(reports):
        return
    properties.has_belief = True
    properties.is_off = all(report.settings.strength == 0.0 for report in reports)
    properties.is_clean = all(belief.is_clean for belief in beliefs) and not properties.is_off
    counts = [report.n_vertices for report in reports]
    for name in ("spikes", "clean", "wide"):
        shares = [count * getattr(belief, name) for count, belief in zip(counts, beliefs, strict=True)]
        setattr(properties, name, 100.0 * sum(shares) / sum(counts))
    pairs = zip(beliefs, measured, strict=True)
    noisy = [(belief, item) for belief, item in pairs if belief.sigma_high > 0.0]
    for name, extreme in (("sigma_low", min), ("sigma_high", max)):
        found = [(getattr(belief, name), item) for belief, item in noisy]
        lengths = [item.scale * sigma for sigma, item in found]
        edges = [sigma / item.report.mean_edge_length for sigma, item in found]
        setattr(properties, name, extreme(lengths, default=0.0))
        setattr(properties, f"{name}_edges", extreme(edges, default=0.0))
    properties.width = max(belief.width for belief in beliefs)
    properties.along_edges = max(belief.along for belief in beliefs)


def _add_noise(properties: FrameletEstimate, name: str, noise: NoiseEstimate, scale: float) -> FrameletNoise:
    """Add the noise of an object; `scale` is that of lengths in scene units."""
    entry = properties.objects.add()
    entry.name, entry.sigma, entry.sigma_edges = name, scale * noise.sigma, noise.sigma_edges
    entry.is_impulsive = noise.is_impulsive
    return entry


def _takes_parameters(report: DenoiseReport) -> bool:
    """Tell whether a run took λ and μ from the noise."""
    return report.noise is not None and report.settings.method == "POSITIONS"


def _parameters_text(report: DenoiseReport) -> str:
    """Return the parameters that a run took from the noise, besides its iterations; empty if it took none."""
    settings = report.settings
    if not _takes_parameters(report):
        return ""
    return f"λ {settings.lambda_:.3g}, μ {settings.mu:.3g}"


def _rms(values: list[float], counts: list[int]) -> float:
    """Return the root mean square of values that stand for several vertices each."""
    total = sum(count * value**2 for value, count in zip(values, counts, strict=True))
    return (total / sum(counts)) ** 0.5
