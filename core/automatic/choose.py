# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Choosing a recipe from the noisy mesh alone, by its risk, by roughness and by a rehearsal."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..surface.connectivity import Connectivity
from ..surface.surface_mesh import SurfaceMesh
from .choose_finish import choose_finish
from .finish import FINISHES, N_PASSES
from .recipes import RECIPES
from .rehearsal import Rehearsal
from .roughness import Roughness
from .run_choice import Choice
from .score import risk_of, scores
from .trial import Trial

HOPELESS = 1.5
"""A recipe whose mean squared displacement is so many times that of the noise, or of most recipes, is given
up without probes: they do not tell more than that apart."""

CAREFUL_SHARE = 0.25
"""Of the recipes: how far those at this place move vertices is what impulsive noise amounts to. Others move
them farther because they take shape away, and no recipe leaves much of the noise."""

MEASURINGS = 2
"""How often, at most, impulsive noise is measured so."""

LARGEST_CORRECTION = 4.0
"""Factor by which a measuring changes the noise at most."""

WELL_MEASURED = 0.1
"""Impulsive noise that was measured wrong by a smaller share is not tried again."""

N_PAIRED = 14
"""Recipes, the best ones alone, that are rehearsed and whose pairs are looked at."""

NEARLY_BEST = 1.1
"""How many times the least score a recipe may have, alone, to be in a pair that is the first choice. Where
the risk is wrong, two that do too little may look good together, and a rehearsal on them would like them."""

PAIRED_UP_TO = 500_000
"""Faces up to which two recipes may be run and averaged, and slow ones run; the time of larger meshes is
better spent on one."""

Numbers = tuple[int, ...]
"""Numbers of recipes whose results are averaged."""


def choose_recipes(
    noisy: NDArray[np.floating],
    surface: SurfaceMesh,
    sigma: float,
    blocks: Blocks,
    tick: Callable[[float], None] = lambda _: None,
    strength: float = 1.0,
    *,
    is_impulsive: bool = False,
    connectivity: Connectivity | None = None,
) -> Choice:
    """Try all recipes on parts of a mesh and return the best one, or the best two, and what is to follow.

    Parameters
    ----------
    noisy : ndarray, shape (3, N)
        Noisy positions in mean edge lengths; not modified.
    surface : SurfaceMesh
        The mesh, for its faces.
    sigma : float
        Standard deviation of the noise along the normals, in mean edge lengths, above 0.
    blocks : Blocks
        Threads to work on.
    tick : callable, optional
        Called after each run with the share of the work that it was.
    strength : float, optional
        How much more smoothness counts: factor on the powers of roughness.
    is_impulsive : bool, optional
        Whether the noise hits some vertices only.
    connectivity : Connectivity, optional
        Neighborhoods of the mesh, if they are known already.

    Returns
    -------
    Choice
        One recipe or two, and how they are finished.

    Notes
    -----
    Stein's estimate of the mean squared error (Ramani, Blu, Unser 2008), for displacements q along the
    normals of the noisy mesh: mean(q^2) - sigma^2 + 2 sigma^2 mean(b dr / eps), where dr is how the result
    changes when the vertices move by eps b, b = +-1. In units of sigma^2 and plus `UNCERTAINTY`, it is
    multiplied by powers of two measures of roughness (see `Roughness`), as the error of positions says
    little about roughness, which is what people see. Estimates below zero say that the noise was estimated
    too strong; all are raised by as much.

    What is best by that is a first choice. Its result gets noise once more, and the recipes are rehearsed on
    it: there their angles are known. The last choice weighs all of it.

    Two results whose errors differ are better on average than each of them. The risk of a mean of two results
    needs no further run.

    Of impulsive noise the measured sigma says little, as it follows the quieter places. But whatever recipes
    do, most of what they take away is noise, so that displacements say how strong it is; if that is another
    number, all recipes are tried again with it, `MEASURINGS` times at most.

    Ways to finish what was chosen are judged by scores like the last one; see `choose_finish`.
    """
    is_large = surface.n_faces > PAIRED_UP_TO
    recipes = [recipe for recipe in RECIPES if recipe.is_quick or not is_large]
    trial = Trial(noisy, surface, sigma, recipes, blocks, connectivity)
    if trial.is_empty:
        tick(1.0)
        return Choice((recipes[0],))
    finishes = [finish for finish in FINISHES if finish.is_quick or not is_large]
    n_passes = 0 if is_large else N_PASSES
    share = 1.0 / ((1 + trial.n_probes + trial.n_draws) * (len(recipes) + n_passes))
    trial.run(lambda: tick(share))
    spread = np.mean(trial.heights**2, axis=1)
    found_sigma: float | None = None
    for _ in range(MEASURINGS if is_impulsive else 0):
        ratio = strength * float(np.sqrt(np.quantile(spread, CAREFUL_SHARE)))
        if abs(ratio - 1.0) <= WELL_MEASURED:
            break
        # Where recipes move next to nothing, as on a few faces, they say nothing about the noise either.
        found_sigma = trial.sigma * min(max(ratio, 1.0 / LARGEST_CORRECTION), LARGEST_CORRECTION)
        trial = Trial(noisy, surface, found_sigma, recipes, blocks, connectivity)
        trial.run(lambda: tick(0.0))
        spread = np.mean(trial.heights**2, axis=1)
    # Where the noise is measured too weak, all that do away with it move vertices farther than it says.
    hopeful = np.flatnonzero(spread <= HOPELESS * max(1.0, float(np.median(spread))))
    divergence = trial.divergences(hopeful, lambda: tick(share))
    tick(share * trial.n_probes * (len(recipes) - len(hopeful)))
    rough = Roughness(trial.problem, trial.counted)

    def judge(choices: Sequence[Numbers]) -> NDArray[np.float64]:
        """Return a risk and two measures of roughness for each choice, shape (n, 3)."""
        judged = []
        for choice in choices:
            height = trial.heights[list(choice)].mean(axis=0)
            risk = risk_of(height, float(divergence[list(choice)].mean()))
            judged.append((risk, *rough.of(trial.mean_of(choice))))
        return np.array(judged).reshape(-1, 3)

    singles = [(int(index),) for index in hopeful]
    judged = judge(singles)
    alone = scores(judged, strength=strength)
    order = np.sort(np.argsort(alone, kind="stable")[:N_PAIRED])
    best = [singles[place][0] for place in order]
    choices: list[Numbers] = [(index,) for index in best]
    judged, is_good = judged[order], alone[order] <= NEARLY_BEST * alone.min()
    if not is_large and len(best) > 1:
        pairs: list[Numbers] = list(combinations(best, 2))
        choices, judged = choices + pairs, np.concatenate((judged, judge(pairs)))
        is_good = np.append(is_good, [one and other for one, other in combinations(is_good, 2)])
    first = choices[int(np.argmin(np.where(is_good, scores(judged, strength=strength), np.inf)))]
    surface_points = trial.ground_mean_of(first, lambda: tick(0.0))
    rehearsal = Rehearsal(trial, surface_points, is_impulsive=is_impulsive)
    rehearsal.run(best, lambda: tick(share))
    tick(share * trial.n_draws * (len(recipes) - len(best)))
    angles = np.array([rehearsal.angle(choice) for choice in choices])
    last = choices[int(np.argmin(scores(judged, angles, strength=strength)))]
    finish = choose_finish(trial, rehearsal, rough, last, finishes, lambda: tick(share), strength)
    return Choice(tuple(recipes[index] for index in last), finish, found_sigma)
