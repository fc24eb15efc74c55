# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the page on AUTO and the changelog quote of recipes and constants is what the code has."""

import re
from pathlib import Path

import pytest
from framelet.core.automatic import (
    choose,
    filter,
    finish,
    hold,
    patches,
    position_bands,
    problem,
    score,
    trial,
)
from framelet.core.automatic.recipes import RECIPES, Recipe

ROOT = Path(__file__).resolve().parents[2]
PAGE = " ".join((ROOT / "docs" / "how_auto_decides.md").read_text(encoding="utf-8").split())
TIMES = {2: "twice"}
WORDS = {10: "ten", 2: "two", 3: "three", 4: "four", 19: "nineteen"}


def table_lines(begin):
    """Yield the lines of the table that begins with some words, as lists of texts."""
    text = (ROOT / "docs" / "how_auto_decides.md").read_text(encoding="utf-8")
    for line in text[text.index(begin) :].split("\n\n")[0].splitlines()[2:]:
        yield [cell.strip() for cell in line.strip("|").split("|")]


def numbers_in(text):
    return [int(number) for number in re.findall(r"\d+", text)]


def listed_recipes():
    """Yield the recipes of the two tables."""
    for label, threshold, widths, caution, bands, steps, after, last in table_lines("| Label | Threshold |"):
        refined = float(last or 0)
        for k in numbers_in(after):
            if not threshold:
                yield Recipe(label.replace(" k", f" {k}"), n_averages=k, position_caution=refined)
                continue
            ranges = tuple(map(float, widths.split(", ")))
            recipe = Recipe(label, float(threshold), ranges, float(caution), int(bands), int(steps))
            yield recipe._replace(label=after_smoothing(label, k), n_averages=k, position_caution=refined)
    for label, width, rounds, steps, after in table_lines("| Label | Width |"):
        for k in numbers_in(after):
            recipe = Recipe(after_smoothing(label, k), n_averages=k, range_units=float(width))
            yield recipe._replace(n_rounds=int(rounds), vertex_steps=int(steps))


def after_smoothing(label, k):
    return f"{label} after smoothing {k}" if k else label


def test_the_tables_have_all_recipes_and_their_parameters():
    listed = list(listed_recipes())
    assert len(listed) == len(set(listed))
    assert sorted(listed) == sorted(RECIPES)
    assert len({recipe.label for recipe in RECIPES}) == len(RECIPES)


def test_the_table_of_further_passes():
    listed = {
        label: finish.Pass(float(width), float(caution), int(bands), int(steps))
        for label, width, caution, bands, steps in table_lines("| Pass | Width |")
    }
    assert listed == {"Broad": finish.BROAD, "Fine": finish.FINE}


def test_the_number_of_recipes():
    number = WORDS[len(RECIPES)]
    assert f"tries {number} recipes" in PAGE and f"**{number.capitalize()} recipes" in PAGE
    assert f"tries {number} recipes" in (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    "words",
    [
        f"Below {filter.LEAST_NOISE} the mesh counts as clean",
        f"takes the place of sigma, up to {filter.LARGEST_RATIO} times it",
        f"another number by more than {choose.WELL_MEASURED:.0%}, all recipes are tried again with it, "
        f"{TIMES[choose.MEASURINGS]} at most".replace("%", " %"),
        f"the whole mesh up to {patches.WHOLE:,} faces, on {WORDS[patches.N_PATCHES]} patches of about "
        f"{patches.FACES_IN_PATCH:,} faces",
        f"the inner {patches.INNER:.0%} of the radius".replace("%", " %"),
        f"moved by {problem.TINY_STEP} sigma",
        f"fitted to the pilot in {problem.PILOT_VERTEX_STEPS} steps",
        f"on small meshes with {WORDS[trial.N_PROBES[0]]} different b",
        f"small meshes get {WORDS[trial.N_DRAWS[0]]} draws",
        f"eps = {trial.PROBE}",
        f"counts with {trial.LARGEST_RESPONSE:.0f} at most",
        f"least risk / sigma²) + {score.UNCERTAINTY}",
        f"The {choose.N_PAIRED} best recipes run on that",
        f"is within {choose.NEARLY_BEST - 1:.0%} of the least one".replace("%", " %"),
        f"Means of two of the {choose.N_PAIRED} best results",
        f"Beyond {choose.PAIRED_UP_TO:,} faces only single recipes are candidates",
        f"Beyond {choose.PAIRED_UP_TO:,} faces there are none.",
        f"in one of {len(finish.FINISHES)} ways",
        f"turns by more than {hold.LARGEST_TURN:.0f} degrees its vertices go half as far, "
        f"{WORDS[hold.HALVINGS]} times",
        f"The {WORDS[finish.N_PASSES]} passes cost as much as",
        f"up to {trial.WIDE_UP_TO:,} faces they are tried on the whole mesh",
    ],
)
def test_constants(words):
    assert words in PAGE


def test_powers():
    assert score.SMOOTHNESS == (1 / 4, 1 / 4)
    assert "R · (q b)^(1/4)" in PAGE
    risk, quarter, bends, angle = score.REHEARSED
    assert angle == 1
    assert f"R^{risk} · q^{quarter} · b^{bends} · a" in PAGE
    risk, quarter, bends, angle = score.PASSED
    assert (angle, bends) == (1, 0)
    assert f"the least R^{risk} · q^{quarter} · a;" in PAGE
    risk, quarter, bends, angle = score.HELD
    assert risk == 0 and bends == angle
    assert (
        f"the least q^{quarter} · (b a)^{angle}, of which {100 * score.IN_PLACE:.0f} % are taken off" in PAGE
    )


def test_numbers_of_averages_of_the_bands():
    first, *_, last = position_bands.NUMBERS
    assert list(position_bands.NUMBERS) == [2**j for j in range(len(position_bands.NUMBERS))]
    assert f"the bands L_k - L_2k with k = {first}, 2, 4 to {last}" in PAGE
