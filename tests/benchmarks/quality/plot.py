# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The results as a picture; needs matplotlib."""

from pathlib import Path

import matplotlib
import sources  # noqa: F401
from cases import DEVELOPMENT
from measuring import NOISY
from methods import BASELINES
from noise import NOISES
from results import AUTO, Results, geometric_mean
from tables import GOAL_TUNED, LIMIT_TUNED

matplotlib.use("Agg")
from matplotlib import pyplot as plt
from matplotlib.ticker import NullFormatter, ScalarFormatter

NOISE_STYLES = dict(
    zip(
        NOISES,
        (
            *((blue, "o") for blue in ("#c6dbef", "#9ecae1", "#6baed6", "#3182bd", "#08519c")),
            ("#e6842a", "s"),
            ("#3a9a4b", "^"),
            *((purple, "v") for purple in ("#cbc9e2", "#9e9ac8", "#6a51a3")),
            ("#a65628", "D"),
            ("#e7298a", "P"),
            ("#666666", "X"),
        ),
        strict=True,
    )
)
METHOD_STYLES = {
    NOISY: "#999999",
    "TAUBIN": "#b8a9c9",
    "BILATERAL": "#e0b36a",
    "LBNF": "#6baed6",
    "GNF": "#74b88a",
    AUTO: "#c0392b",
}


def draw(results: Results, path: Path) -> None:
    """Draw ratios by model, and mean angles by noise, into a PNG file."""
    figure, (above, below) = plt.subplots(2, 1, figsize=(11, 9), height_ratios=(1.2, 1), layout="constrained")
    _draw_ratios(above, results)
    _draw_angles(below, results)
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def _draw_ratios(axes, results: Results) -> None:
    """Draw AUTO's angle over that of the best tuned baseline, a mark for each model and noise."""
    models = results.models
    n_development = sum(model in DEVELOPMENT for model in models)
    for number, (noise, (color, marker)) in enumerate(NOISE_STYLES.items()):
        places, ratios = [], []
        for place, model in enumerate(models):
            cases = [case for case in results.cases if (case.model, case.noise) == (model, noise)]
            if cases:
                places.append(place + 0.1 * (number - 3))
                ratios.append(geometric_mean(results.ratio(case, "best") for case in cases))
        axes.scatter(
            places, ratios, s=28, c=color, marker=marker, edgecolors="#333", linewidths=0.4, label=noise
        )
    axes.axhline(1.0, color="#333", linewidth=0.8)
    for level in (GOAL_TUNED, LIMIT_TUNED):
        axes.axhline(level, color="#c0392b", linewidth=0.8, linestyle="--")
    if 0 < n_development < len(models):
        axes.axvline(n_development - 0.5, color="#999", linewidth=0.8)
    labels = [f"{model} *" if model in DEVELOPMENT else model for model in models]
    axes.set_xticks(range(len(models)), labels, rotation=45, ha="right", fontsize=8)
    axes.set_yscale("log")
    axes.yaxis.set_major_formatter(ScalarFormatter())
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.set_yticks([0.5, 0.7, 0.9, 1.0, 1.1, 1.4, 2.0, 3.0])
    axes.set_ylabel("angle of AUTO / best tuned baseline")
    axes.set_title("Below 1: better than every baseline tuned with the clean model (* development set)")
    axes.grid(axis="y", alpha=0.3)
    axes.legend(ncols=7, fontsize=8, loc="lower right")
    low, high = axes.get_ylim()
    axes.set_ylim(0.8 * low, 1.1 * high)  # room for the legend
    axes.set_xlim(-0.6, len(models) - 0.4)
    axes.set_axisbelow(True)


def _draw_angles(axes, results: Results) -> None:
    """Draw the geometric mean of the angle by noise: baselines pale at their default, full when tuned."""
    width = 0.8 / len(METHOD_STYLES)
    for number, (method, color) in enumerate(METHOD_STYLES.items()):
        for choice in ("default", "best") if method in BASELINES else ("default",):
            heights = []
            for noise in NOISES:
                rows = [results.find(case, method, choice) for case in results.cases if case.noise == noise]
                heights.append(geometric_mean(row.angle for row in rows if row))
            places = [place + (number - 2.5) * width for place in range(len(NOISES))]
            is_pale = choice == "default" and method in BASELINES
            label = f"{method}, {'default' if is_pale else 'tuned'}" if method in BASELINES else method
            axes.bar(places, heights, 0.9 * width, color=color, alpha=0.35 if is_pale else 1.0, label=label)
    axes.set_xticks(range(len(NOISES)), list(NOISES))
    axes.set_ylabel("angle in degrees, geometric mean")
    axes.legend(ncols=1, fontsize=8, loc="center left", bbox_to_anchor=(1.0, 0.5))
    axes.grid(axis="y", alpha=0.3)
    axes.set_axisbelow(True)
