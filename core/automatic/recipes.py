# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The recipes that automatic denoising chooses from."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from ..normals.pilot import ITERATIONS


class Recipe(NamedTuple):
    """Parameters of a run.

    Positions are filtered by a low-pass of `n_averages` first, if it is not 0. What follows works on normals:
    `threshold` is the pilot's, in units of the median difference that the noise makes between neighboring
    normals. There is a pass of shrinkage for each of `range_sigmas`; without any, the low-pass is all there
    is. `caution` is explained in `normals.band_shrinkage`.
    """

    label: str
    threshold: float = 0.0
    range_sigmas: tuple[float, ...] = ()
    caution: float = 1.0
    n_bands: int = 0
    vertex_steps: int = 0
    n_averages: int = 0


_FLAT = Recipe("Flat and sharp", 0.12, (0.4, 0.3), 1.5, 7, 50)
_EVEN = Recipe("Smooth and even", 0.12, (0.35, 0.25), 4.0, 7, 50)
_SHARP = Recipe("Sharp and coarse", 0.05, (0.5, 0.3), 1.5, 6, 25)
_ROUND = Recipe("Round with edges", 0.12, (0.5, 0.5), 1.5, 6, 20)
_FINE = Recipe("Fine relief", 0.12, (1.2, 1.2), 1.5, 4, 8)


def _after(n_averages: int, *recipes: Recipe) -> list[Recipe]:
    """Return recipes that work on smoothed positions."""
    return [
        recipe._replace(label=f"{recipe.label} after smoothing {n_averages}", n_averages=n_averages)
        for recipe in recipes
    ]


RECIPES = (
    *(_FLAT, _SHARP, _ROUND, _FINE),
    *_after(4, _FLAT, _EVEN, _SHARP, _FINE),
    *_after(8, _EVEN, _FINE),
    *_after(16, _EVEN, _FINE),
    *(Recipe(f"Smooth and coarse {k}", n_averages=k) for k in (8, 32, 64, 128)),
)
"""For weak to strong noise and, within each of these groups, from machine parts to organic shapes."""


def n_ticks(recipes: Sequence[Recipe]) -> int:
    """Return how often running recipes one after the other calls `tick`; they share pilots that are alike."""
    on_normals = [recipe for recipe in recipes if recipe.range_sigmas]
    n_pilots = len({(recipe.n_averages, recipe.threshold) for recipe in on_normals})
    others = (len(recipe.range_sigmas) * recipe.n_bands + recipe.vertex_steps for recipe in on_normals)
    return n_pilots * ITERATIONS + sum(others) + len(recipes) - len(on_normals)
