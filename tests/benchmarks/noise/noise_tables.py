# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Results of the noise benchmark as a page of Markdown."""

from collections.abc import Iterable
from typing import NamedTuple

INTRODUCTION = """\
# Noise estimate

How well `estimate_noise` finds noise that was added to clean meshes. Written by

```
python3 .ci/environment.py run core -- tests/benchmarks/noise/run.py --update
```

which needs Python and NumPy only; every number is in `tests/benchmarks/noise/noise.csv`.

Noise is Gaussian, along the normals or with the same standard deviation in each coordinate; levels are
in mean edge lengths of the clean mesh. Numbers are estimate by truth, both in scene units: the mean
over {seeds} draws, and behind it the worst draw where that is off by more than 15 %. *Clean* is the
estimate on the clean mesh in edge lengths: grain, or detail too fine for the mesh. *Impulsive* noise
moves half of the vertices by 0.5 edge lengths along the normals: the ratio is that of `rms`, and behind
it in how many draws `is_impulsive` was true.

Off are the smallest meshes on which most patches touch a crease, `quad/bamboopen1146`,
`quad/fandisk766` and `mixed/suzanne507`: a few dozen patches without one remain, which scatter, or
none. At 0.1 the fine relief of `tri/armadillo43k` counts as noise, for it is as fine as the mesh.
Strong noise is underestimated by a few percent, because a fit to noise turns its plane into it.

The method was developed on the models of `tri` and `quad`, so that their figures are not of unseen
meshes; those of `mixed` were not used.

"""

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


def page(rows: list[Row]) -> str:
    """Return the page."""
    seeds = len({row.seed for row in rows})
    gaussian = [row for row in rows if row.kind in ("normals", "directions")]
    within = sum(abs(row.ratio - 1.0) <= LIMIT for row in gaussian)
    alarms = sum(row.is_impulsive for row in rows if row.kind != "impulsive")
    impulsive = [row for row in rows if row.kind == "impulsive"]
    recognized = sum(row.is_impulsive for row in impulsive)
    seconds = sum(row.seconds for row in rows) / len(rows)
    summary = (
        f"Of {len(gaussian)} estimates of Gaussian noise {within} are within 15 % of the truth.\n"
        f"Impulsive noise was recognized in {recognized} of {len(impulsive)} draws, and seen where there\n"
        f"was none in {alarms} of {len(rows) - len(impulsive)}. An estimate took {seconds:.2f} s on\n"
        "average, neighborhoods not counted.\n\n"
    )
    text = INTRODUCTION.format(seeds=seeds) + summary
    for kind, title in (("normals", "Along the normals"), ("directions", "In all directions")):
        text += f"## {title}\n\n{_table(rows, kind)}\n"
    return text.rstrip("\n") + "\n"


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
