# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The recipes that automatic denoising chooses from."""

from __future__ import annotations

from itertools import product
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


_ON_NORMALS = (
    Recipe("Flat and sharp", 0.12, (0.4, 0.3), 1.5, 8, 50),
    Recipe("Smooth and even", 0.12, (0.35, 0.25), 4.0, 7, 50),
    Recipe("Sharp and coarse", 0.05, (0.5, 0.3), 1.5, 6, 25),
    Recipe("Round with edges", 0.12, (0.5, 0.5), 1.5, 6, 20),
    Recipe("Fine relief", 0.12, (1.2, 1.2), 1.5, 4, 8),
)


def _after(n_averages: int, recipe: Recipe) -> Recipe:
    """Return a recipe that works on smoothed positions."""
    return recipe._replace(label=f"{recipe.label} after smoothing {n_averages}", n_averages=n_averages)


RECIPES = (
    *_ON_NORMALS,
    *(_after(n_averages, recipe) for n_averages, recipe in product((4, 8, 16), _ON_NORMALS)),
    *(Recipe(f"Smooth and coarse {k}", n_averages=k) for k in (4, 8, 16, 32, 64, 128)),
)
"""From machine parts to organic shapes, and from weak to strong noise."""


def n_ticks(recipe: Recipe) -> int:
    """Return how often a run of a recipe calls `tick`, if its pilot is not there yet."""
    if not recipe.range_sigmas:
        return 1
    return ITERATIONS + len(recipe.range_sigmas) * recipe.n_bands + recipe.vertex_steps
