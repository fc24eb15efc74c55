# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The modifiers that there are: what denoising moved, and the scales of a mesh."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from .node_groups import Recipe, Term, has_inputs, kind_of

if TYPE_CHECKING:
    import bpy

DISPLACEMENT, EQUALIZER = "displacement", "equalizer"

AMOUNT = "Amount"

_LEVELS = re.compile(r"[1-9]\d?")

DENOISE_RECIPE = Recipe(
    DISPLACEMENT,
    "Framelet Denoise",
    (
        Term(
            "framelet_displacement",
            AMOUNT,
            "How much of what denoising moved is added: 0 shows the noisy mesh, 1 the result",
            0.0,
            2.0,
        ),
    ),
)
"""What adds the displacement that a run found."""


def level_name(level: int) -> str:
    """Return the input of a level's gain; 1 is the finest."""
    return f"Level {level}"


def level_attribute(level: int) -> str:
    """Return the attribute with the details of a level."""
    return f"framelet_level_{level}"


def equalizer_recipe(n_levels: int) -> Recipe:
    """Return what turns the scales of a mesh up and down: 0 removes the details of a level, 1 keeps them."""
    terms = [
        Term(
            level_attribute(level),
            level_name(level),
            "Factor for the details of this scale: 0 removes them, 1 keeps them; level 1 is the finest",
            1.0,
            3.0,
        )
        for level in range(1, n_levels + 1)
    ]
    return Recipe(f"{EQUALIZER} {n_levels}", "Framelet Equalizer", tuple(terms))


def recipe_of(modifier: bpy.types.Modifier) -> Recipe:
    """Return the recipe of one of Framelet's modifiers, as `stack.find_modifier` gives them."""
    recipe = known_recipe(modifier.node_group)
    assert recipe is not None
    return recipe


def known_recipe(group: bpy.types.NodeTree | None) -> Recipe | None:
    """Return the recipe of a node group; None if it is none of Framelet's, or lost inputs that it had."""
    if group is None:
        return None
    kind, _, number = kind_of(group).partition(" ")
    if kind == DISPLACEMENT and not number:
        recipe = DENOISE_RECIPE
    elif kind == EQUALIZER and _LEVELS.fullmatch(number):
        recipe = equalizer_recipe(int(number))
    else:
        return None
    return recipe if has_inputs(group, recipe) else None


OURS = re.compile(r"framelet_displacement|framelet_level_\d+|framelet_mask")
"""All attributes that belong to the modifiers."""
