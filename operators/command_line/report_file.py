# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The report of a run as a JSON file."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from ...core.learned.noise_field import NoiseBelief
from ...core.report import DenoiseReport
from ...core.settings import DenoiseSettings
from ..properties.region_options import RegionOptions
from .version import blender_version, framelet_version


def write_report(
    path: Path,
    *,
    source: Path,
    target: Path,
    preset: str,
    settings: DenoiseSettings,
    options: RegionOptions,
    reports: Sequence[tuple[str, DenoiseReport]],
    skipped: Sequence[tuple[str, str]],
) -> None:
    """Write what was done.

    Parameters
    ----------
    path : Path
        The JSON file.
    source, target : Path
        What was read and written, as it was typed.
    preset : str
        Key of the preset that the settings started from.
    settings : DenoiseSettings
        The settings asked for; their names in the file are those of the fields, so that
        ``DenoiseSettings(**report["settings"])`` gives them back.
    options : RegionOptions
        Where vertices could move and how far; under "region" in the file.
    reports : sequence of (str, DenoiseReport)
        For each object its name and report, with the settings used and the noise, as it was measured or taken
        away.
    skipped : sequence of (str, str)
        For each object that was left as it is its name and the reason.
    """
    content = {
        "framelet": framelet_version(),
        "blender": blender_version(),
        "input": str(source),
        "output": str(target),
        "preset": preset,
        "settings": asdict(settings),
        "region": asdict(options),
        "objects": [{"name": name, **_entry(report)} for name, report in reports],
        "skipped": [{"name": name, "reason": reason} for name, reason in skipped],
    }
    text = json.dumps(_plain(content), indent=2, ensure_ascii=False, allow_nan=False)
    path.write_text(text + "\n", encoding="utf-8")


def _entry(report: DenoiseReport) -> dict[str, Any]:
    """Return a report, with its noise in edge lengths, too, and whether the mesh was clean."""
    entry, noise = asdict(report), report.noise
    if isinstance(noise, NoiseBelief):
        for name in ("sigma_low", "sigma_high"):
            entry["noise"][f"{name}_edges"] = getattr(noise, name) / report.mean_edge_length
        entry["noise"]["is_clean"] = noise.is_clean
    return entry


def _plain(value: Any) -> Any:
    """Return a value with NumPy's scalars as Python's, and numbers that JSON has no word for as None."""
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if hasattr(value, "item"):
        value = value.item()
    return None if isinstance(value, float) and not math.isfinite(value) else value
