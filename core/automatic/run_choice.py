# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What was chosen, and running it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..denoising.constraints import Constraints
from ..memory import MANY_ITEMS
from ..normals.folds import unfold
from .finish import Finish, Pass
from .hold import held_in_place
from .problem import NormalProblem, Tick
from .recipes import Recipe
from .recipes import n_ticks as n_ticks_of_recipes


class Choice(NamedTuple):
    """What is run on a mesh.

    Attributes
    ----------
    recipes : tuple of Recipe
        One recipe, or two whose results are averaged.
    finish : Finish
        What follows.
    sigma : float, optional
        Standard deviation of the noise, in mean edge lengths, if the trials found another one.
    """

    recipes: tuple[Recipe, ...]
    finish: Finish = Finish()
    sigma: float | None = None

    @property
    def label(self) -> str:
        """The words for it, such as "Fine relief and Soft relief (refined, in place)"."""
        label = " and ".join(recipe.label for recipe in self.recipes)
        return f"{label} ({self.finish.label})" if self.finish.label else label

    @property
    def vertex_steps(self) -> int:
        """The most steps of vertices that follow each other."""
        of_passes = [again.vertex_steps for again in self.finish.passes]
        return max([*(recipe.vertex_steps for recipe in self.recipes), *of_passes])


def n_ticks(choice: Choice) -> int:
    """Return how often `run_choice` calls `tick`."""
    further = sum(again.n_bands + again.vertex_steps for again in choice.finish.passes)
    return n_ticks_of_recipes(choice.recipes) + further


def run_choice(
    problem: NormalProblem, choice: Choice, constraints: Constraints, tick: Tick = lambda _: None
) -> NDArray[np.floating]:
    """Return denoised positions, shape (3, N), without folds as far as possible."""
    recipes, finish, _ = choice
    problem.is_frugal = len(recipes) == 1 and problem.surface.n_faces >= MANY_ITEMS
    is_mean, is_finished = len(recipes) > 1, finish != Finish()
    # A result that is finished is unfolded afterwards; a mean is of results without folds.
    is_unfolded = is_mean or not is_finished
    points = problem.run(recipes[0], constraints, tick, is_unfolded=is_unfolded)
    if is_mean:
        points = sum((problem.run(recipe, constraints, tick) for recipe in recipes[1:]), points)
        points = points / points.dtype.type(len(recipes))
    if is_mean or is_finished:
        (points,) = finished(problem, points, [finish], constraints, tick)
        normals = problem.normals_around(points)
        points = unfold(points, normals, problem.surface, problem.ring_mean)
        constraints.apply(points, problem.noisy)
    return points


def finished(
    problem: NormalProblem,
    points: NDArray[np.floating],
    finishes: Sequence[Finish],
    constraints: Constraints | None = None,
    tick: Tick = lambda _: None,
    after_pass: Callable[[], None] = lambda: None,
) -> Iterator[NDArray[np.floating]]:
    """Yield the positions, shape (3, N), after each way to finish a result; passes are shared.

    `tick` is called in passes, `after_pass` after each of them.
    """
    passed: dict[tuple[Pass, ...], NDArray[np.floating]] = {(): points}
    for finish in finishes:
        for n_passes, again in enumerate(finish.passes):
            before, after = finish.passes[:n_passes], finish.passes[: n_passes + 1]
            if after not in passed:
                passed[after] = problem.pass_again(passed[before], again, constraints, tick)
                after_pass()
        result = passed[finish.passes]
        if finish.share < 1:
            result = points + points.dtype.type(finish.share) * (result - points)
        if finish.held:
            normals = problem.vertex_normals(result)
            result = held_in_place(
                result, problem.noisy, normals, finish.held, problem.surface, problem.blocks
            )
        yield result
