# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The recipes that automatic denoising chooses from."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from ..normals.pilot import ITERATIONS


class Recipe(NamedTuple):
    """Parameters of a run.

    Positions are filtered by a low-pass of `n_averages` first, if it is not 0. What follows works on normals,
    in one of two ways.

    - `range_sigmas`: from a pilot, whose `threshold` is in units of the median difference that the noise
      makes between neighboring normals, there is a pass of shrinkage for each of them. `caution` is explained
      in `normals.band_shrinkage`.
    - `n_rounds`: averages over the faces around, each with weights from the one before it, whose width
      `range_units` is in the same units.

    Without either, the low-pass is all there is. At last, if `position_caution` is not 0, the result is the
    pilot by which bands of the noisy positions are shrunk, with this caution.
    """

    label: str
    threshold: float = 0.0
    range_sigmas: tuple[float, ...] = ()
    caution: float = 1.0
    n_bands: int = 0
    vertex_steps: int = 0
    n_averages: int = 0
    n_rounds: int = 0
    range_units: float = 0.0
    position_caution: float = 0.0

    @property
    def is_refined(self) -> bool:
        """Whether bands of positions are shrunk at last."""
        return self.position_caution > 0

    @property
    def pilot(self) -> Recipe:
        """What a refined recipe takes its pilot from."""
        return self._replace(label="", position_caution=0.0)

    @property
    def is_low_pass(self) -> bool:
        """Whether the low-pass of positions is all there is."""
        return not (self.range_sigmas or self.n_rounds or self.is_refined)

    @property
    def is_quick(self) -> bool:
        """Whether the recipe serves large meshes: the other ones make weights, or wide bands, many times."""
        return not self.n_rounds and not self.is_refined


_FLAT = Recipe("Flat and sharp", 0.12, (0.4, 0.3), 1.5, 7, 50)
_EVEN = Recipe("Smooth and even", 0.12, (0.35, 0.25), 4.0, 7, 50)
_SHARP = Recipe("Sharp and coarse", 0.05, (0.5, 0.3), 1.5, 6, 25)
_FINE = Recipe("Fine relief", 0.12, (1.2, 1.2), 1.5, 4, 8)


def _after(n_averages: int, *recipes: Recipe) -> list[Recipe]:
    """Return recipes that work on smoothed positions."""
    return [
        recipe._replace(label=f"{recipe.label} after smoothing {n_averages}", n_averages=n_averages)
        for recipe in recipes
    ]


def _crisp(range_units: float, n_rounds: int) -> Recipe:
    """Return a recipe that averages normals in rounds."""
    label = f"Crisp edges {n_rounds}"
    return Recipe(label, vertex_steps=10, n_rounds=n_rounds, range_units=range_units)


def _low_pass(n_averages: int) -> Recipe:
    """Return a recipe that filters positions only."""
    return Recipe(f"Smooth and coarse {n_averages}", n_averages=n_averages)


RECIPES = (
    *(_FLAT, _SHARP, _FINE),
    *_after(4, _FLAT, _EVEN, _SHARP),
    *_after(8, _FINE),
    *_after(16, _EVEN, _FINE),
    *map(_low_pass, (24, 32, 128, 192)),
    _crisp(0.9, 32),
    *_after(4, _crisp(1.3, 16), _crisp(0.6, 32)),
    _FINE._replace(label="Soft relief", position_caution=1.0),
    *_after(8, _FINE._replace(label="Soft relief", position_caution=1.5)),
    _low_pass(32)._replace(label="Soft and coarse 32", position_caution=1.5),
)
"""What was left over of many, on models with noise of known strength; see `docs/how_auto_decides.md`."""

PILOTS = frozenset(recipe.pilot for recipe in RECIPES if recipe.is_refined)


def n_ticks(recipes: Sequence[Recipe]) -> int:
    """Return how often running recipes one after the other calls `tick`; they share pilots that are alike."""
    on_normals = [recipe for recipe in recipes if recipe.range_sigmas]
    n_pilots = len({(recipe.n_averages, recipe.threshold) for recipe in on_normals})
    total = n_pilots * ITERATIONS
    for recipe in recipes:
        steps = len(recipe.range_sigmas) * recipe.n_bands + recipe.n_rounds + recipe.vertex_steps
        total += (steps or 1) + recipe.is_refined
    return total
