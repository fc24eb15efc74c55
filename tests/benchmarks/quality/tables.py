# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Results as Markdown tables, and the one table as a CSV file."""

import csv
import math
from collections.abc import Iterable, Sequence
from pathlib import Path

import sources  # noqa: F401
from cases import DEVELOPMENT, CaseName
from measuring import NOISY
from methods import BASELINES, FRAMELET
from noise import NOISES
from results import AUTO, GROUPS, Results, geometric_mean

GOAL_TUNED, LIMIT_TUNED, GOAL_DEFAULT = 0.85, 1.10, 0.75
"""Targets: mean and largest ratio to the best tuned baseline, mean ratio to the best default."""


def markdown(head: Sequence[str], body: Iterable[Sequence[str]]) -> str:
    """Return a table whose first column is text and whose others are numbers."""
    lines = ["| " + " | ".join(head) + " |", "|---|" + "--:|" * (len(head) - 1)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in body]) + "\n"


def columns() -> list[tuple[str, str]]:
    """Return the methods and choices that get a column: presets, then baselines at default and tuned."""
    return [(key, "default") for key in FRAMELET] + [
        (name, choice) for name in BASELINES for choice in ("default", "best")
    ]


def write_wide(results: Results, path: Path) -> None:
    """Write one line for each case: the noisy mesh, AUTO, the best baselines, ratios, and all angles."""
    head = ["model", "set", "noise", "seed", "noisy_angle", "noisy_rms", "noisy_flips"]
    head += ["auto_angle", "auto_rms", "auto_flips", "auto_seconds"]
    head += ["best_tuned", "best_tuned_angle", "ratio_to_tuned"]
    head += ["best_default", "best_default_angle", "ratio_to_default"]
    head += [f"{name}_{choice}" for name, choice in columns()]
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(head)
        for case in results.cases:
            noisy, auto = results.get(case, NOISY), results.get(case, AUTO)
            line = [
                case.model,
                "development" if case.model in DEVELOPMENT else "others",
                case.noise,
                case.seed,
            ]
            line += [noisy.angle, noisy.rms, noisy.flips, auto.angle, auto.rms, auto.flips, auto.seconds]
            for choice in ("best", "default"):
                row = results.best_baseline(case, choice)
                line += [row.method, row.angle, round(results.ratio(case, choice), 4)]
            found = [results.find(case, name, choice) for name, choice in columns()]
            writer.writerow([*line, *(row.angle if row else "" for row in found)])


def target_table(results: Results) -> str:
    """Return the figures to check, for both sets of models and for all."""
    groups = {name: [case for case in results.cases if is_in(case)] for name, is_in in GROUPS.items()}

    def line(what: str, target: str, figure) -> list[str]:
        return [what, target, *(figure(cases) if cases else "-" for cases in groups.values())]

    def mean(choice):
        return lambda cases: f"{geometric_mean(results.ratio(case, choice) for case in cases):.3f}"

    def count(is_wrong):
        return lambda cases: str(sum(map(is_wrong, cases)))

    def quads(method, choice):
        return count(lambda case: case.model.startswith("quad/") and not results.beats(case, method, choice))

    body = [
        line("Cases", "", lambda cases: str(len(cases))),
        line("Angle of AUTO over the best tuned baseline, mean", f"<= {GOAL_TUNED:.2f}", mean("best")),
        line(
            "The same, largest",
            f"<= {LIMIT_TUNED:.2f}",
            lambda cases: f"{max(results.ratio(case, 'best') for case in cases):.2f}",
        ),
        line("Cases above that", "0", count(lambda case: results.ratio(case, "best") > LIMIT_TUNED)),
        line("Angle of AUTO over the best default, mean", f"<= {GOAL_DEFAULT:.2f}", mean("default")),
        line("Cases with rms not below the noisy", "0", count(lambda case: not results.keeps_rms(case))),
        line("Cases with more flips than the noisy", "0", count(lambda case: not results.keeps_flips(case))),
        line("Quads, cases not better than QUAD_2", "0", quads("QUAD_2", "default")),
        line("Quads, cases not better than BILATERAL, default", "0", quads("BILATERAL", "default")),
        line("Quads, cases not better than BILATERAL, tuned", "", quads("BILATERAL", "best")),
    ]
    return markdown(["Figure", "Target", *(name.capitalize() for name in groups)], body)


def method_table(results: Results) -> str:
    """Return the geometric mean of each method's angle by noise, and its seconds."""
    head = ["Method", *NOISES, "All", "Seconds"]
    body = []
    for name, choice in [(NOISY, "default"), *columns()]:
        # Presets for one kind of faces have no mean that can be compared; they are in the list.
        if not all(results.find(case, name, choice) for case in results.cases):
            continue
        rows = [results.get(case, name, choice) for case in results.cases]
        cells = [_angle(geometric_mean(row.angle for row in rows if row.noise == noise)) for noise in NOISES]
        cells += [_angle(geometric_mean(row.angle for row in rows))]
        cells += [f"{sum(row.seconds for row in rows):.0f}" if name != NOISY else ""]
        body.append([f"{name}, {_word(choice)}" if name in BASELINES else name, *cells])
    return markdown(head, body)


def model_table(results: Results) -> str:
    """Return the mean ratio to the best tuned baseline by model and noise, over the seeds."""
    body = []
    for model in results.models:
        cases = [case for case in results.cases if case.model == model]
        ratios = [
            geometric_mean(results.ratio(case, "best") for case in cases if case.noise == noise)
            for noise in NOISES
        ]
        name = rf"{model} \*" if model in DEVELOPMENT else model
        total = geometric_mean(results.ratio(case, "best") for case in cases)
        body.append([name, *(_ratio(value) for value in (*ratios, total))])
    return markdown(["Model", *NOISES, "All"], body)


def problem_table(results: Results) -> str:
    """Return the cases that miss a target, the largest ratio first."""
    body = []
    for case in sorted(results.cases, key=lambda case: -results.ratio(case, "best")):
        noisy, auto = results.get(case, NOISY), results.get(case, AUTO)
        tuned = results.best_baseline(case, "best")
        ratio = results.ratio(case, "best")
        misses = ["ratio"] * (ratio > LIMIT_TUNED) + ["rms"] * (not results.keeps_rms(case))
        misses += ["flips"] * (not results.keeps_flips(case))
        if case.model.startswith("quad/"):
            misses += [name for name in ("QUAD_2", "BILATERAL") if not results.beats(case, name)]
        if misses:
            cells = [f"{auto.angle:.2f}", f"{tuned.angle:.2f} {tuned.method}", f"{ratio:.2f}"]
            cells += [f"{auto.rms:.3f} / {noisy.rms:.3f}", f"{auto.flips} / {noisy.flips}", ", ".join(misses)]
            body.append([_case(case), *cells])
    if not body:
        return "None.\n"
    head = ["Case", "AUTO", "Best tuned", "Ratio", "rms, noisy", "Flips, noisy", "Misses"]
    return markdown(head, body)


def full_table(results: Results) -> str:
    """Return every model and noise, angles as means over the seeds."""
    head = ["Model, noise", "Noisy", *FRAMELET, *(f"{name}, default / tuned" for name in BASELINES)]
    body = []
    for model, noise in dict.fromkeys((case.model, case.noise) for case in results.cases):
        cases = [case for case in results.cases if (case.model, case.noise) == (model, noise)]
        cells = [_mean(results, cases, NOISY, "default")]
        cells += [_mean(results, cases, key, "default") for key in FRAMELET]
        cells += [
            f"{_mean(results, cases, name, 'default')} / {_mean(results, cases, name, 'best')}"
            for name in BASELINES
        ]
        body.append([f"{model}, {noise}", *cells])
    return markdown(head, body)


def _mean(results: Results, cases: list[CaseName], method: str, choice: str) -> str:
    rows = [row for case in cases if (row := results.find(case, method, choice))]
    return f"{sum(row.angle for row in rows) / len(rows):.2f}" if rows else "-"


def _angle(value: float) -> str:
    return "-" if math.isnan(value) else f"{value:.2f}"


def _ratio(value: float) -> str:
    text = _angle(value)
    return f"**{text}**" if value > LIMIT_TUNED else text


def _word(choice: str) -> str:
    return "tuned" if choice == "best" else "default"


def _case(case: CaseName) -> str:
    return f"{case.model}, {case.noise}, seed {case.seed}"
