# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows put together by case, and the ratios that the targets are about."""

import math
from collections.abc import Callable, Iterable

import sources  # noqa: F401
from cases import DEVELOPMENT, CaseName
from measuring import NOISY, Row
from methods import BASELINES
from noise import NOISES

AUTO = "AUTO"


def geometric_mean(values: Iterable[float]) -> float:
    """Return the geometric mean of positive numbers; NaN without any."""
    logs = [math.log(value) for value in values]
    return math.exp(sum(logs) / len(logs)) if logs else math.nan


class Results:
    """Rows that can be asked for.

    Attributes
    ----------
    cases : list of CaseName
        Those with a result of AUTO and the tuned and default ones of both filters of normals, in the order of
        models, noises and seeds.
    """

    def __init__(self, rows: Iterable[Row]) -> None:
        self._by_key = {row.key: row for row in rows}
        needed = [(NOISY, "default"), (AUTO, "default")]
        needed += [(name, choice) for name in ("LBNF", "GNF") for choice in ("default", "best")]
        cases = {row.case for row in self._by_key.values()}
        complete = [case for case in cases if all((case, *key) in self._by_key for key in needed)]
        noises = list(NOISES)
        self.cases = sorted(complete, key=lambda case: (case.model, noises.index(case.noise), case.seed))

    @property
    def models(self) -> list[str]:
        """Names of the models, those of the development set first."""
        return sorted({case.model for case in self.cases}, key=lambda name: (name not in DEVELOPMENT, name))

    def find(self, case: CaseName, method: str, choice: str = "default") -> Row | None:
        """Return a row, None if there is none."""
        return self._by_key.get((case, method, choice))

    def get(self, case: CaseName, method: str, choice: str = "default") -> Row:
        """Return a row that there is."""
        return self._by_key[case, method, choice]

    def best_baseline(self, case: CaseName, choice: str) -> Row:
        """Return the baseline with the smallest angle, among the tuned ones or among the defaults."""
        rows = [row for name in BASELINES if (row := self.find(case, name, choice))]
        return min(rows, key=lambda row: row.angle)

    def ratio(self, case: CaseName, choice: str) -> float:
        """Return AUTO's angle over that of the best baseline, tuned ("best") or at its default."""
        return self.get(case, AUTO).angle / self.best_baseline(case, choice).angle

    def keeps_rms(self, case: CaseName) -> bool:
        """Tell whether AUTO's vertices are closer to the clean ones than the noisy ones are."""
        return self.get(case, AUTO).rms < self.get(case, NOISY).rms

    def keeps_flips(self, case: CaseName) -> bool:
        """Tell whether AUTO has no more flipped faces than the noisy mesh."""
        return self.get(case, AUTO).flips <= self.get(case, NOISY).flips

    def beats(self, case: CaseName, method: str, choice: str = "default") -> bool:
        """Tell whether AUTO's angle is below that of a method, or the method did not run."""
        row = self.find(case, method, choice)
        return row is None or self.get(case, AUTO).angle < row.angle


GROUPS: dict[str, Callable[[CaseName], bool]] = {
    "development": lambda case: case.model in DEVELOPMENT,
    "others": lambda case: case.model not in DEVELOPMENT,
    "all": lambda case: True,
}
"""The models on which tuning began; the others, some of which were looked at later; both."""
