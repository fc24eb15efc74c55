# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""One line for each case: the noisy mesh, the best baselines, and AUTO.

The lines of the development meshes are kept in `cases.csv`, so that AUTO can be measured against the
baselines without running them again.
"""

import math
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import NamedTuple

import sources
from cases import DEVELOPMENT, CaseName
from measuring import NOISY, Row
from methods import BASELINES
from noise import NOISES
from records import read_records

AUTO = "AUTO"
KEPT = sources.FOLDER / "cases.csv"
NEEDED = [(name, choice) for name in ("LBNF", "GNF") for choice in ("default", "best")]
"""Without these baselines the best one of a case is not known."""


class Line(NamedTuple):
    """What is known of a case; its fields are the columns of `cases.csv`."""

    model: str
    noise: str
    seed: int
    noisy_angle: float
    noisy_rms: float
    tuned: str
    """The baseline with the smallest angle among those tuned with the clean mesh in hand."""
    tuned_angle: float
    default: str
    """The same among the baselines at their defaults."""
    default_angle: float
    auto_angle: float = math.nan
    auto_rms: float = math.nan

    @property
    def case(self) -> CaseName:
        """The case."""
        return CaseName(self.model, self.noise, self.seed)

    @property
    def over_tuned(self) -> float:
        """AUTO's angle over that of the best tuned baseline."""
        return self.auto_angle / self.tuned_angle

    @property
    def over_default(self) -> float:
        """AUTO's angle over that of the best baseline at its default."""
        return self.auto_angle / self.default_angle


def read_lines(path: Path = KEPT) -> list[Line]:
    """Return the lines of a file; none if there is no file."""
    return read_records(Line, path) if path.is_file() else []


def combined(rows: Iterable[Row], kept: Iterable[Line]) -> list[Line]:
    """Return a line for each case whose baselines are known; what was run replaces what was kept."""
    by_key = {row.key: row for row in rows}
    lines = {line.case: line for line in kept}
    for case in {row.case for row in by_key.values()}:
        found = {key[1:]: row for key, row in by_key.items() if key[0] == case}
        noisy, auto = found.get((NOISY, "default")), found.get((AUTO, "default"))
        if noisy and all(key in found for key in NEEDED):
            best = {choice: _best(found, choice) for choice in ("best", "default")}
            before = lines.get(case)
            lines[case] = Line(
                *case,
                noisy_angle=noisy.angle,
                noisy_rms=noisy.rms,
                tuned=best["best"].method,
                tuned_angle=best["best"].angle,
                default=best["default"].method,
                default_angle=best["default"].angle,
                auto_angle=before.auto_angle if before else math.nan,
                auto_rms=before.auto_rms if before else math.nan,
            )
        if auto and case in lines:
            lines[case] = lines[case]._replace(auto_angle=auto.angle, auto_rms=auto.rms)
    noises = list(NOISES)
    return sorted(lines.values(), key=lambda line: (line.model, noises.index(line.noise), line.seed))


def _best(found: dict[tuple[str, str], Row], choice: str) -> Row:
    """Return the baseline with the smallest angle, among the tuned ones or among the defaults."""
    rows = [found[name, choice] for name in BASELINES if (name, choice) in found]
    return min(rows, key=lambda row: row.angle)


def geometric_mean(values: Iterable[float]) -> float:
    """Return the geometric mean of positive numbers; NaN without any."""
    logs = [math.log(value) for value in values]
    return math.exp(sum(logs) / len(logs)) if logs else math.nan


GROUPS: dict[str, Callable[[Line], bool]] = {
    "development": lambda line: line.model in DEVELOPMENT,
    "others": lambda line: line.model not in DEVELOPMENT,
    "all": lambda line: True,
}
"""The models on which tuning began; the others, some of which were looked at later; both."""
