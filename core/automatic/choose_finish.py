# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Choosing what follows the recipes, by the same numbers as they are chosen by."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from .finish import Finish
from .rehearsal import Rehearsal
from .roughness import Roughness
from .run_choice import finished
from .score import HELD, IN_PLACE, PASSED, risk_of, scores
from .trial import Trial, mean_of


def choose_finish(
    trial: Trial,
    rehearsal: Rehearsal,
    rough: Roughness,
    choice: Sequence[int],
    finishes: Sequence[Finish],
    tick: Callable[[], None],
    strength: float = 1.0,
) -> Finish:
    """Return the way to finish the mean of some recipes' results that promises most.

    Parameters
    ----------
    trial : Trial
        What the recipes did, probes included.
    rehearsal : Rehearsal
        What they did where the answer is known.
    rough : Roughness
        Measures roughness on the trial's mesh.
    choice : sequence of int
        Numbers of the recipes.
    finishes : sequence of Finish
        Those to choose from, at least one of which holds nothing.
    tick : callable
        Called after each further pass.
    strength : float, optional
        See `scores`.

    Notes
    -----
    Passes are chosen among the ways that hold no vertex. How far vertices are held is chosen for these, by a
    score in which roughness counts more: a rehearsal does not know noise within the surface.
    """
    angles = rehearsal.angles_finished(choice, finishes, tick)
    judged = _judged(trial, rough, choice, finishes, tick)
    passed = scores(judged, angles, strength, PASSED)
    held = scores(judged, angles, strength, HELD)
    held *= 1.0 - IN_PLACE * np.array([finish.held for finish in finishes])
    free = [index for index, finish in enumerate(finishes) if not finish.held]
    best = finishes[min(free, key=lambda index: passed[index])]
    alike = [index for index, finish in enumerate(finishes) if finish.passed == best.passed]
    return finishes[min(alike, key=lambda index: held[index])]


def _judged(
    trial: Trial,
    rough: Roughness,
    choice: Sequence[int],
    finishes: Sequence[Finish],
    tick: Callable[[], None],
) -> NDArray[np.float64]:
    """Return a risk and two measures of roughness for each way to finish, shape (n, 3)."""
    results = list(finished(trial.problem, trial.mean_of(choice), finishes, after_pass=tick))
    follows = np.zeros(len(results))
    for probe in trial.probes:
        moved = finished(probe.problem, mean_of(probe.results, choice), finishes, after_pass=tick)
        follows += [trial.follows(probe, *pair) for pair in zip(moved, results, strict=True)]
    return np.array(
        [
            (risk_of(trial.height_of(result), divergence), *rough.of(result))
            for result, divergence in zip(results, follows / trial.n_probes, strict=True)
        ]
    )
