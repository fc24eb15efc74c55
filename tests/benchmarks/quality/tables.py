# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Results as Markdown tables."""

from collections.abc import Callable, Iterable, Sequence

import sources  # noqa: F401
from noise import NOISES, is_white
from results import GROUPS, Line, geometric_mean

GOAL_TUNED, LIMIT_TUNED, GOAL_DEFAULT, GOAL_CORRELATED = 0.85, 1.10, 0.75, 1.0
"""Targets: mean and largest ratio to the best tuned baseline, mean ratio to the best default, all for white
noise; mean ratio to the best tuned baseline for correlated noise."""


def markdown(head: Sequence[str], body: Iterable[Sequence[str]]) -> str:
    """Return a table whose first column is text and whose others are numbers."""
    lines = ["| " + " | ".join(head) + " |", "|---|" + "--:|" * (len(head) - 1)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in body]) + "\n"


def summary(lines: Sequence[Line]) -> str:
    """Return the one figure that counts, in a sentence."""
    means = {name: _mean(filter(is_in, lines), "over_tuned") for name, is_in in GROUPS.items()}
    return (
        f"Angle of AUTO over the best tuned baseline, geometric mean over {len(lines)} cases: "
        f"{means['all']} (development {means['development']}, others {means['others']})."
    )


def noise_table(lines: Sequence[Line]) -> str:
    """Return geometric means of the angle by noise."""
    head = ["Noise", "Cases", "Noisy", "Default", "Tuned", "AUTO", "AUTO / default", "AUTO / tuned"]
    names = ("noisy_angle", "default_angle", "tuned_angle", "auto_angle", "over_default", "over_tuned")
    body = []
    kinds = {"All white": True, "All like scanners'": False}
    for noise in (*filter(is_white, NOISES), "All white", *_others(), "All like scanners'"):
        own = [line for line in lines if line.noise == noise or kinds.get(noise) is is_white(line.noise)]
        if own:
            body.append([noise, str(len(own)), *(_mean(own, name) for name in names)])
    return markdown(head, body)


def _others() -> list[str]:
    return [noise for noise in NOISES if not is_white(noise)]


def target_table(lines: Sequence[Line]) -> str:
    """Return the figures to check, for both sets of models and for all."""

    def row(
        what: str,
        target: str,
        figure: Callable[[list[Line]], str],
        is_meant: Callable[[str], bool] = is_white,
    ) -> list[str]:
        meant = [line for line in lines if is_meant(line.noise)]
        groups = [[line for line in meant if is_in(line)] for is_in in GROUPS.values()]
        return [what, target, *(figure(own) if own else "-" for own in groups)]

    def count(is_wrong: Callable[[Line], bool]) -> Callable[[list[Line]], str]:
        return lambda own: str(sum(map(is_wrong, own)))

    body = [
        row("Cases of white noise", "", lambda own: str(len(own))),
        row("AUTO / tuned, mean", f"<= {GOAL_TUNED:.2f}", lambda own: _mean(own, "over_tuned")),
        row(
            "AUTO / tuned, largest",
            f"<= {LIMIT_TUNED:.2f}",
            lambda own: f"{max(line.over_tuned for line in own):.2f}",
        ),
        row("Cases above that", "0", count(lambda line: line.over_tuned > LIMIT_TUNED)),
        row("AUTO / default, mean", f"<= {GOAL_DEFAULT:.2f}", lambda own: _mean(own, "over_default")),
        row(
            "Correlated: AUTO / tuned, mean",
            f"<= {GOAL_CORRELATED:.2f}",
            lambda own: _mean(own, "over_tuned"),
            lambda noise: noise in ("correlated 1", "correlated 2", "correlated 4"),
        ),
        row(
            "Cases with rms not below the noisy",
            "0",
            count(lambda line: line.auto_rms >= line.noisy_rms),
            lambda _: True,
        ),
    ]
    return markdown(["Figure", "Target", *(name.capitalize() for name in GROUPS)], body)


def model_table(lines: Sequence[Line]) -> str:
    """Return the ratio to the best tuned baseline by model, and the noise where it is largest."""
    body = []
    for model in dict.fromkeys(line.model for line in lines):
        own = [line for line in lines if line.model == model]
        worst = max(own, key=lambda line: line.over_tuned)
        cells = [str(len(own)), _mean(own, "over_tuned"), f"{worst.over_tuned:.2f}"]
        body.append([model, *cells, f"{worst.noise}, seed {worst.seed}: {worst.tuned}"])
    return markdown(["Model", "Cases", "AUTO / tuned", "Largest", "There"], body)


def _mean(lines: Iterable[Line], name: str) -> str:
    """Return the geometric mean of a figure; a dash without any."""
    values = [getattr(line, name) for line in lines]
    return f"{geometric_mean(values):.3f}" if values else "-"
