# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Results of the position engine as Markdown tables."""

from collections.abc import Callable, Iterable

import position_sources  # noqa: F401
from tables import markdown
from trials import Trial, Trials, geometric_mean
from variants import PLAIN, Variant

Choose = Callable[[str, str, str], Trial]


def make_sections(trials: Iterable[Trial]) -> dict[str, str]:
    """Return the tables by the names that they have in the page."""
    trials = list(trials)
    kinds = {"triangles": False, "quads": True}
    of_kind = {
        kind: Trials(trial for trial in trials if trial.is_quad == is_quad) for kind, is_quad in kinds.items()
    }
    return {
        **{f"variants on {kind}": variant_table(own) for kind, own in of_kind.items()},
        **{f"models of {kind}": model_table(own) for kind, own in of_kind.items()},
    }


def variant_table(trials: Trials) -> str:
    """Return angle and rms of each variant, as means over models and noises."""
    head = ["Variant", "Iterations", "λ / noise", "Angle", "ratio", "rms", "ratio"]
    head += ["Best: angle", "ratio", "rms", "ratio"]
    body = []
    for variant in trials.variants:
        name = variant.name
        factor = "from the noise"
        if trials.is_tried(name):
            factor = f"{trials.common_factor(name, trials.models):.2f}"
        cells = [name, _iterations(variant), factor, *_figures(trials, trials.common, name)]
        cells += _figures(trials, trials.best, name) if trials.is_tried(name) else ["-"] * 4
        body.append(cells)
    return markdown(head, body)


def model_table(trials: Trials) -> str:
    """Return the angle of each variant over that of the engine as it is, by model and by noise."""
    head = ["Variant", *(model.split("/")[1] for model in trials.models), *trials.noises]
    body = []
    for variant in trials.variants:
        groups = [[(model, noise) for noise in trials.noises] for model in trials.models]
        groups += [[(model, noise) for model in trials.models] for noise in trials.noises]
        if variant != PLAIN:
            body.append([variant.name, *(_ratio(trials, variant.name, group) for group in groups)])
    return markdown(head, body)


def _iterations(variant: Variant) -> str:
    """Return how many iterations all rounds have."""
    return str(variant.rounds * variant.settings(is_quad=False).iterations)


def _figures(trials: Trials, choose: Choose, name: str) -> list[str]:
    """Return means of angle and rms, each with its ratio to that of the engine as it is."""
    cases = [(model, noise) for model in trials.models for noise in trials.noises]
    cells = []
    for digits, field in ((2, "angle"), (3, "rms")):
        own, plain = (
            geometric_mean(getattr(choose(key, *case), field) for case in cases) for key in (name, PLAIN.name)
        )
        cells += [f"{own:.{digits}f}", f"{own / plain:.3f}"]
    return cells


def _ratio(trials: Trials, name: str, cases: list[tuple[str, str]]) -> str:
    ratios = (trials.common(name, *case).angle / trials.common(PLAIN.name, *case).angle for case in cases)
    return f"{geometric_mean(ratios):.2f}"
