# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Run methods on cases and keep what came out as rows."""

from collections.abc import Iterable, Iterator
from typing import NamedTuple

import sources  # noqa: F401
from cases import TUNING_SEED, Case, CaseName, Measurement, load_case
from methods import BASELINES, FRAMELET, METHODS, Reading, Settings
from tuning import tune

NOISY = "NOISY"


class Row(NamedTuple):
    """One line of the results; its fields are the columns of the CSV files."""

    model: str
    noise: str
    seed: int
    method: str
    choice: str
    """default, or best: tuned on seed 0 of this model and noise with the clean model in hand."""
    settings: str
    angle: float
    rms: float
    flips: int
    seconds: float
    n_tried: int
    """Readings among which the best one was chosen; 1 for a default."""

    @property
    def key(self) -> tuple:
        """What the row is about."""
        return (self.case, self.method, self.choice)

    @property
    def case(self) -> CaseName:
        """The case."""
        return CaseName(self.model, self.noise, self.seed)


class Task(NamedTuple):
    """What is missing of a case: methods and choices, and the tuned settings that are known."""

    case: CaseName
    wanted: tuple[tuple[str, str], ...]
    tuned: tuple[tuple[str, str], ...] = ()


def wanted_of(methods: Iterable[str]) -> list[tuple[str, str]]:
    """Return the methods with their choices, and the noisy mesh."""
    wanted = [(NOISY, "default")]
    for name in methods:
        wanted.append((name, "default"))
        if name in BASELINES:
            wanted.append((name, "best"))
    return wanted


def run_task(task: Task) -> list[Row]:
    """Run what is missing of a case."""
    case = load_case(task.case)
    rows = []
    tuned = dict(task.tuned)
    for name, choice in task.wanted:
        rows += _run(case, name, choice, tuned.get(name))
    return rows


def _run(case: Case, name: str, choice: str, tuned: str | None) -> Iterator[Row]:
    if name == NOISY:
        yield _row(case, NOISY, choice, "", case.measure(case.noisy.vertices), 0.0, 1)
        return
    method = METHODS[name]
    if choice == "best" and case.name.seed == TUNING_SEED:
        found = tune(method, case)
        yield _row_of(case, name, choice, found.reading, found.measured, found.n_tried)
        return
    if name in FRAMELET:
        settings = method.settings
    elif choice == "best":
        if tuned is None:
            return
        settings = read_settings(tuned)
    else:
        settings = method.defaults
    reading = method.run(case, settings)
    yield _row_of(case, name, choice, reading, case.measure(reading.positions), 1)


def _row_of(case: Case, name: str, choice: str, reading: Reading, measured: Measurement, n_tried: int) -> Row:
    return _row(case, name, choice, written_settings(reading.settings), measured, reading.seconds, n_tried)


def _row(case, name, choice, settings, measured, seconds, n_tried) -> Row:
    """Put together a row, with as many digits as tell anything."""
    return Row(
        *case.name,
        method=name,
        choice=choice,
        settings=settings,
        angle=round(measured.angle, 4),
        rms=round(measured.rms, 5),
        flips=measured.flips,
        seconds=round(seconds, 3),
        n_tried=n_tried,
    )


def written_settings(settings: Settings) -> str:
    """Return settings as a text without commas."""
    return " ".join(f"{key}={value}" for key, value in settings.items())


def read_settings(text: str) -> Settings:
    """Return the settings of a text."""
    settings = {}
    for word in text.split():
        key, value = word.split("=")
        try:
            settings[key] = int(value)
        except ValueError:
            try:
                settings[key] = float(value)
            except ValueError:
                settings[key] = value
    return settings
