# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a run chose by itself, in words that stand beside the names of the settings."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bpy.app.translations import pgettext_n as n_
from bpy.app.translations import pgettext_rpt as rpt_

if TYPE_CHECKING:
    from ..core.automatic.recipes import Recipe
    from ..core.denoising.report import DenoiseReport


BETWEEN_LABELS = "; "
"""Stands between what was chosen for several objects."""


def chosen_texts(report: DenoiseReport) -> dict[str, str]:
    """Return the settings that a run chose, by property of `FrameletNoise`; empty if it chose none.

    Automatic denoising cleans normals with the pairwise frame between faces. Its λ is a multiple of what the
    noise makes of the differences between neighboring faces, its levels are the bands of weighted averages.
    Where it took a low-pass of positions instead, there are no λ and μ. Where it took the mean of two
    recipes, there is a line for each, and lines follow for how the result was finished.
    """
    settings = report.settings
    if settings.method == "POSITIONS" and report.noise is not None:
        return {"chosen_lambda": f"{settings.lambda_:.3g}", "chosen_mu": f"{settings.mu:.3g}"}
    if settings.method != "AUTO":
        return {}
    recipes = _recipes_of(report.recipe)
    texts = [_recipe_texts(recipe) for recipe in recipes]
    names = texts[0] if texts else {}
    lines = {name: "\n".join(dict.fromkeys(each[name] for each in texts if each[name])) for name in names}
    return {"chosen_recipe": "\n".join(chosen_lines(report.recipe)), **lines}


def chosen_lines(label: str) -> list[str]:
    """Return what was chosen for an object as lines that fit into the sidebar, texts to translate."""
    recipes = _recipes_of(label)
    lines = [line for recipe in recipes for line in recipe_lines(recipe.label).splitlines()]
    finish = label.partition(" (")[2].rstrip(")")
    return [*lines, *filter(None, finish.split(", "))] if lines else [label]


def _recipes_of(label: str) -> list[Recipe]:
    """Return the recipes that a label names, without what follows them."""
    from ..core.automatic.recipes import RECIPES

    words = label.partition(" (")[0].split(" and ")
    # "Flat and sharp" has the same word in it that stands between two recipes.
    return [recipe for recipe in RECIPES if _is_named(recipe.label.split(" and "), words)]


def recipe_lines(label: str) -> str:
    """Return the label of a recipe as the lines that fit into the sidebar."""
    return label.replace(" after ", "\nafter ")


def _is_named(words: list[str], labels: list[str]) -> bool:
    """Tell whether words follow one another in a list."""
    return any(labels[start : start + len(words)] == words for start in range(len(labels)))


def _recipe_texts(recipe: Recipe) -> dict[str, str]:
    """Return the words for one recipe."""
    from ..core.automatic.position_bands import NUMBERS
    from ..core.normals.pilot import COUPLING

    # Lines, in the order in which a run takes them.
    frames, levels, units, coupling = [], [], "", ""
    if recipe.n_averages:
        frames.append(n_("Low-pass"))
        levels.append(rpt_("{number} averages").format(number=recipe.n_averages))
    if recipe.range_sigmas:
        frames.append(n_("Pairwise (normals)"))
        levels.append(str(recipe.n_bands))
        units, coupling = f"{recipe.threshold:g}", f"{COUPLING:g}"
    if recipe.n_rounds:
        frames.append(n_("Bilateral (normals)"))
        levels.append(rpt_("{number} averages").format(number=recipe.n_rounds))
        units = f"{recipe.range_units:g}"
    if recipe.is_refined:
        frames.append(n_("Bands (positions)"))
        levels.append(str(len(NUMBERS)))
    return {
        "chosen_frame": "\n".join(frames),
        "chosen_levels": "\n".join(levels),
        "chosen_lambda": rpt_("{number} × noise").format(number=units) if units else "",
        "chosen_mu": coupling,
    }
