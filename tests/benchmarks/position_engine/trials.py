# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs every variant on every case with every λ of one grid, and chooses among the λ."""

from collections.abc import Iterable, Iterator
from math import exp, log
from typing import NamedTuple

import position_sources  # noqa: F401
from cases import CaseName, has_quads, load_case
from framelet.core import estimate_noise
from framelet.core.denoising.tuning import tuned
from framelet.core.transform import choose_frame
from rounds import Problem, denoised
from variants import BY_NAME, VARIANTS, Variant

FACTORS = tuple(round(0.25 * 2 ** (step / 2), 3) for step in range(12))
"""λ in units of the noise that is measured on the noisy mesh: the same for all variants."""

QUICK_FACTORS = (0.5, 1.0, 2.0)


class Trial(NamedTuple):
    """One result; its fields are the columns of the CSV file."""

    model: str
    is_quad: bool
    noise: str
    variant: str
    factor: float
    """λ in units of the measured noise."""
    angle: float
    """Mean angle between face normals of result and clean model, in degrees."""
    rms: float
    """Distance of vertices from the clean ones, rms, in clean mean edge lengths."""


def run_case(name: CaseName, factors: Iterable[float]) -> Iterator[Trial]:
    """Yield the results of all variants on a case."""
    case, is_quad = load_case(name), has_quads(name.model)
    problem = Problem(case.noisy, case.model.connectivity)
    noise = estimate_noise(case.noisy, problem.connectivity)
    for variant in VARIANTS:
        settings = variant.settings(is_quad)
        grid = [settings.with_changes(lambda_=factor * noise.sigma_edges) for factor in factors]
        if settings.tuning == "NOISE":
            grid = [tuned(settings, choose_frame(settings.frame, problem.connectivity), noise)]
        for given in grid:
            found = case.measure(denoised(problem, variant, given))
            yield Trial(
                model=name.model,
                is_quad=is_quad,
                noise=name.noise,
                variant=variant.name,
                factor=round(given.lambda_ / noise.sigma_edges, 3),
                angle=round(found.angle, 3),
                rms=round(found.rms, 4),
            )


class Trials:
    """The results for models of one kind of faces.

    A variant has two results on a case. The *best* is the one with the smallest angle over the grid, which no
    user could choose. The *common* one has the λ that is best for the *other* models, with all their noises:
    the geometric mean of their angles is the smallest. So it is a λ that needs no tuning, and no model has a
    say in its own.
    """

    def __init__(self, trials: Iterable[Trial]) -> None:
        self._cells: dict[tuple[str, str, str], dict[float, Trial]] = {}
        for trial in trials:
            cell = self._cells.setdefault((trial.variant, trial.model, trial.noise), {})
            cell[trial.factor] = trial
        self.models = sorted({model for _, model, _ in self._cells})
        self.noises = sorted({noise for _, _, noise in self._cells})
        names = {name for name, _, _ in self._cells}
        self.variants: list[Variant] = [variant for variant in VARIANTS if variant.name in names]

    def best(self, variant: str, model: str, noise: str) -> Trial:
        """Return the result with the smallest angle."""
        return min(self._cells[variant, model, noise].values(), key=lambda trial: trial.angle)

    def is_tried(self, variant: str) -> bool:
        """Tell whether a variant has more than one λ, so that there is a best one."""
        return BY_NAME[variant].changes.get("tuning") != "NOISE"

    def common(self, variant: str, model: str, noise: str) -> Trial:
        """Return the result with the λ of the other models."""
        cell = self._cells[variant, model, noise]
        if not self.is_tried(variant):
            (trial,) = cell.values()
            return trial
        # With one model there are no others.
        others = [name for name in self.models if name != model] or [model]
        return cell[self.common_factor(variant, others)]

    def common_factor(self, variant: str, models: Iterable[str]) -> float:
        """Return the factor with the smallest geometric mean of angles over models and all noises."""
        cells = [self._cells[variant, model, noise] for model in models for noise in self.noises]
        return min(cells[0], key=lambda factor: sum(log(cell[factor].angle) for cell in cells))


def geometric_mean(values: Iterable[float]) -> float:
    """Return the geometric mean of positive numbers."""
    logs = [log(value) for value in values]
    return exp(sum(logs) / len(logs))
