# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Results of the noise benchmark as tables of Markdown."""

from collections.abc import Iterable
from typing import NamedTuple

LIMIT = 0.15


class Row(NamedTuple):
    """One estimate; its fields are the columns of the CSV file."""

    mesh: str
    vertices: int
    kind: str
    """clean, normals, directions or impulsive."""
    level: float
    seed: int
    truth: float
    """Clean mean edge lengths, as are the estimates."""
    estimate: float
    ratio: float
    sigma_clean_edges: float
    is_impulsive: bool
    seconds: float


def level_table(rows: list[Row]) -> str:
    """Return how far estimates are from the truth, a line for each strength of the noise."""
    head = ["Noise, edge lengths", "Estimates", "Estimate / truth, median", "Worst", "Within 15 %"]
    lines = ["| " + " | ".join(head) + " |", "|---|" + "--:|" * (len(head) - 1)]
    for kind, name in (("normals", "normals"), ("directions", "all directions"), ("impulsive", "impulsive")):
        own = [row for row in rows if row.kind == kind]
        for levels in ((0.1, 0.2, 0.3), (0.5, 0.7)):
            ratios = sorted(row.ratio for row in own if row.level in levels)
            if ratios:
                worst = max(ratios, key=lambda ratio: abs(ratio - 1.0))
                within = sum(abs(ratio - 1.0) <= LIMIT for ratio in ratios)
                chosen = sorted({row.level for row in own} & set(levels))
                cells = [f"{name}, {chosen[0]:g} to {chosen[-1]:g}" if len(chosen) > 1 else name]
                cells += [str(len(ratios)), f"{ratios[len(ratios) // 2]:.2f}", f"{worst:.2f}", str(within)]
                lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def summary(rows: list[Row]) -> str:
    """Return how often impulsive noise is seen, and how long an estimate takes."""
    alarms = sum(row.is_impulsive for row in rows if row.kind != "impulsive")
    impulsive = [row for row in rows if row.kind == "impulsive"]
    recognized = sum(row.is_impulsive for row in impulsive)
    seconds = sum(row.seconds for row in rows) / len(rows)
    return (
        f"Impulsive noise was recognized in {recognized} of {len(impulsive)} draws, and seen where there was "
        f"none in {alarms} of {len(rows) - len(impulsive)}. An estimate took {seconds:.2f} s.\n"
    )


def mesh_tables(rows: list[Row]) -> str:
    """Return estimates by mesh: means over the draws, and in brackets the worst draw if it is far off."""
    titles = {"normals": "Along the normals", "directions": "In all directions"}
    return "\n".join(f"## {title}\n\n{_table(rows, kind)}" for kind, title in titles.items())


def _table(rows: list[Row], kind: str) -> str:
    """Return a line for each mesh."""
    levels = sorted({row.level for row in rows if row.kind == kind})
    head = ["Mesh", *(f"{level:g}" for level in levels)]
    if kind == "normals":
        head += ["Clean", "Impulsive"]
    lines = ["| " + " | ".join(head) + " |", "|---|" + "--:|" * (len(head) - 1)]
    for mesh in dict.fromkeys(row.mesh for row in rows):
        own = [row for row in rows if row.mesh == mesh]
        cells = [f"{mesh} ({own[0].vertices:,})"]
        cells += [
            _ratios(row.ratio for row in own if (row.kind, row.level) == (kind, level)) for level in levels
        ]
        if kind == "normals":
            impulsive = [row for row in own if row.kind == "impulsive"]
            mean = sum(row.ratio for row in impulsive) / len(impulsive)
            seen = sum(row.is_impulsive for row in impulsive)
            cells += [f"{row.estimate:.3f}" for row in own if row.kind == "clean"]
            cells.append(f"{mean:.2f} ({seen} of {len(impulsive)})")
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def _ratios(ratios: Iterable[float]) -> str:
    """Return the mean, and the worst if it is off."""
    ratios = list(ratios)
    worst = max(ratios, key=lambda ratio: abs(ratio - 1.0))
    mean = f"{sum(ratios) / len(ratios):.2f}"
    return f"{mean} ({worst:.2f})" if abs(worst - 1.0) > LIMIT else mean
