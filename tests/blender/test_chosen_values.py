# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a run chose, in words for the sidebar."""

from itertools import permutations
from types import SimpleNamespace

import pytest
from framelet.core import DenoiseSettings
from framelet.core.automatic.filter import CLEAN
from framelet.core.automatic.finish import FINISHES
from framelet.core.automatic.recipes import RECIPES
from framelet.core.automatic.run_choice import Choice
from framelet.core.normals.pilot import COUPLING
from framelet.operators.chosen_values import chosen_texts
from framelet.ui.translations import german_reports

NAMES = ["chosen_recipe", "chosen_frame", "chosen_levels", "chosen_lambda", "chosen_mu"]


def texts(recipe="", noise="measured", **settings):
    report = SimpleNamespace(settings=DenoiseSettings(**settings), recipe=recipe, noise=noise)
    return chosen_texts(report)


@pytest.mark.parametrize("recipe", RECIPES, ids=lambda recipe: recipe.label)
def test_every_recipe_has_words(recipe):
    found = texts(recipe.label, method="AUTO")
    assert list(found) == NAMES
    steps = [("Low-pass", f"{recipe.n_averages} averages")] if recipe.n_averages else []
    if recipe.range_sigmas:
        steps.append(("Pairwise (normals)", str(recipe.n_bands)))
    if recipe.n_rounds:
        steps.append(("Bilateral (normals)", f"{recipe.n_rounds} averages"))
    if recipe.is_refined:
        steps.append(("Bands (positions)", "7"))
    frames, levels = (found[name].splitlines() for name in ("chosen_frame", "chosen_levels"))
    assert list(zip(frames, levels, strict=True)) == steps and steps
    width = recipe.threshold or recipe.range_units
    assert found["chosen_lambda"] == (f"{width} × noise" if width else "")
    assert found["chosen_mu"] == (f"{COUPLING:g}" if recipe.range_sigmas else "")


@pytest.mark.parametrize(("one", "other"), list(permutations(RECIPES, 2)))
def test_the_mean_of_two_recipes_names_both(one, other):
    found = texts(f"{one.label} and {other.label}", method="AUTO")
    alone = [texts(recipe.label, method="AUTO") for recipe in RECIPES if recipe in (one, other)]
    for name in NAMES:
        values = [each[name] for each in alone if each[name]]
        assert found[name] == "\n".join(dict.fromkeys(values))


@pytest.mark.parametrize("recipes", [RECIPES[:1], RECIPES[-2:]])
@pytest.mark.parametrize("finish", FINISHES, ids=lambda finish: finish.label or "plain")
def test_how_it_is_finished_has_lines_of_its_own(recipes, finish):
    found = texts(Choice(recipes, finish).label, method="AUTO")
    plain = texts(Choice(recipes).label, method="AUTO")
    words = [word for word in finish.label.split(", ") if word]
    assert found == plain | {"chosen_recipe": "\n".join((plain["chosen_recipe"], *words))}
    assert list(found) == NAMES
    assert all(line in german_reports.TEXTS for line in found["chosen_recipe"].splitlines())


def test_clean_meshes_chose_nothing():
    assert texts(CLEAN, method="AUTO") == {"chosen_recipe": CLEAN}


def test_the_noise_gives_two_numbers():
    assert texts(method="POSITIONS", tuning="NOISE", lambda_=0.31234, mu=2.0) == {
        "chosen_lambda": "0.312",
        "chosen_mu": "2",
    }
    for method in ("POSITIONS", "NORMALS", "BILATERAL"):
        assert texts(noise=None, method=method) == {}
