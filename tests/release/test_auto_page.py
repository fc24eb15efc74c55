# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the page on AUTO and the changelog quote of recipes and constants is what the code has."""

import re
from pathlib import Path

import pytest
from framelet.core.automatic import choose, filter, patches, problem
from framelet.core.automatic.recipes import RECIPES

ROOT = Path(__file__).resolve().parents[2]
PAGE = " ".join((ROOT / "docs" / "how_auto_decides.md").read_text(encoding="utf-8").split())
WORDS = {10: "ten", 4: "four", 6: "six", 16: "sixteen"}


def listed_recipes():
    """Return the lines of the table of recipes, as tuples of the fields of a recipe."""
    text = (ROOT / "docs" / "how_auto_decides.md").read_text(encoding="utf-8")
    table = text[text.index("| Label |") :].split("\n\n")[0].splitlines()[2:]
    for line in table:
        label, threshold, widths, caution, bands, steps, after = (
            cell.strip() for cell in line.strip("|").split("|")
        )
        numbers = [int(number) for number in re.findall(r"\d+", after)]
        if not threshold:
            yield from ((label.replace(" k", f" {k}"), 0.0, (), 1.0, 0, 0, k) for k in numbers)
            continue
        shared = (
            float(threshold),
            tuple(map(float, widths.split(", "))),
            float(caution),
            int(bands),
            int(steps),
        )
        for k in numbers:
            yield (f"{label} after smoothing {k}" if k else label, *shared, k)


def test_the_table_has_all_recipes_and_their_parameters():
    listed = list(listed_recipes())
    assert len(listed) == len(set(listed))
    assert sorted(listed) == sorted(map(tuple, RECIPES))


def test_the_number_of_recipes():
    number = WORDS[len(RECIPES)]
    assert f"tries {number} recipes" in PAGE and f"**{number.capitalize()} recipes" in PAGE
    assert f"tries {number} recipes" in (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    "words",
    [
        f"Below {filter.LEAST_NOISE} the mesh counts as clean",
        f"at most {filter.LARGEST_RATIO} times that of the quieter places",
        f"the whole mesh up to {patches.WHOLE:,} faces, on {WORDS[patches.N_PATCHES]} patches of about "
        f"{patches.FACES_IN_PATCH:,} faces",
        f"the inner {patches.INNER:.0%} of the radius".replace("%", " %"),
        f"moved by {problem.TINY_STEP} sigma",
        f"fitted to the pilot in {problem.PILOT_VERTEX_STEPS} steps",
        f"up to {WORDS[choose.N_PROBES[0]]} different b",
        f"eps = {choose.PROBE}",
        f"counts with {choose.LARGEST_RESPONSE:.0f} at most",
        f"least risk / sigma²) + {choose.UNCERTAINTY})",
        f"Means of two of the {choose.N_PAIRED} best results",
        f"Beyond {choose.PAIRED_UP_TO:,} faces only single recipes",
    ],
)
def test_constants(words):
    assert words in PAGE


def test_powers_of_roughness():
    assert choose.SMOOTHNESS == (1 / 2, 1 / 4)
    assert "· sqrt(q) · b^(1/4)" in PAGE
