# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A rehearsal: noise is put on a surface that is known, and recipes show how near they get to it.

The surface is a first result on the mesh itself, so that it has about the creases, the curvature and the
triangles of the clean one. What a recipe does there to the normals, which is what people see, need not be
estimated.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from ..normals.noise_sample import normals_of
from .finish import Finish
from .problem import NormalProblem
from .run_choice import finished
from .trial import Trial, mean_of

NOISE_PERIODS = (331.0, 449.0, 571.0)
"""Periods of the digits whose sum stands for Gaussian noise; see `noise_sample.scrambled`."""

HIT_PERIODS = 241.0
"""Those of the digits that tell which vertices impulsive noise hits."""

FURTHER = 1.137
"""Factor on the periods for each further draw. Were it a summand, sums of two periods of different draws
would be alike, and so would be the draws."""


class Rehearsal:
    """Recipes on a surface with noise of the measured strength.

    Parameters
    ----------
    trial : Trial
        What the recipes did to the noisy mesh.
    surface_points : ndarray
        The surface that stands for the clean one: positions on the trial's ground, in columns.
    is_impulsive : bool
        Whether half of the vertices get all of the noise.
    """

    def __init__(self, trial: Trial, surface_points: NDArray[np.floating], *, is_impulsive: bool) -> None:
        self._trial = trial
        directions = trial.ground.vertex_normals(surface_points)
        self._noisy = [
            surface_points + self._noise(draw, is_impulsive) * directions for draw in range(trial.n_draws)
        ]
        self._normals = normals_of(trial.in_part(surface_points), trial.surface)
        corners = trial.surface.corner_vertex
        own = np.repeat(np.arange(trial.surface.n_faces), trial.surface.face_sizes())
        n_counted = np.bincount(own, trial.counted[corners], minlength=trial.surface.n_faces)
        self._faces = np.flatnonzero((n_counted == trial.surface.face_sizes()) & (n_counted > 0))
        self._runs: list[tuple[NormalProblem, dict[int, NDArray[np.floating]]]] = []

    def _noise(self, draw: int, is_impulsive: bool) -> NDArray[np.floating]:
        """Return how far each vertex of the ground is moved."""
        trial, other = self._trial, FURTHER**draw
        digits = [trial.scrambled(periods * other) for periods in NOISE_PERIODS]
        dtype = digits[0].dtype.type
        # The variance of a number that is spread evenly from 0 to 1 is 1 / 12.
        amount: NDArray[np.floating] = np.sum(digits, axis=0)
        amount -= dtype(0.5 * len(digits))
        amount *= dtype(trial.sigma * (12.0 / len(digits)) ** 0.5)
        if is_impulsive:
            amount *= trial.scrambled(HIT_PERIODS * other) < 0.5
            amount *= dtype(2.0**0.5)
        return amount

    def run(self, wanted: Sequence[int], tick: Callable[[], None]) -> None:
        """Run some recipes."""
        for noisy in self._noisy:
            problem = self._trial.problem_at(self._trial.in_part(noisy))
            results = {}
            for index, result in zip(wanted, self._trial.runs(problem, noisy, wanted), strict=True):
                results[index] = result
                tick()
            self._runs.append((problem, results))

    def angle(self, choice: Sequence[int]) -> float:
        """Return the mean angle in degrees between the normals of the surface and those of a mean of results.

        Only faces count whose vertices all do.
        """
        return self._angle([mean_of(results, choice) for _, results in self._runs])

    def angles_finished(
        self, choice: Sequence[int], finishes: Sequence[Finish], tick: Callable[[], None]
    ) -> NDArray[np.float64]:
        """Return the same, shape (n,), for each way to finish a mean of results; `tick` follows passes."""
        ways = [
            finished(problem, mean_of(results, choice), finishes, after_pass=tick)
            for problem, results in self._runs
        ]
        return np.array([self._angle(results) for results in zip(*ways, strict=True)])

    def _angle(self, results: Sequence[NDArray[np.floating]]) -> float:
        """Return the mean angle in degrees over the draws, of each of which there is a result (3, n)."""
        if not len(self._faces):
            return 0.0
        angles = []
        for points in results:
            apart = normals_of(points, self._trial.surface)[:, self._faces] - self._normals[:, self._faces]
            half = 0.5 * np.sqrt(np.einsum("cn,cn->n", apart, apart, dtype=np.float64))
            angles.append(2.0 * np.mean(np.arcsin(np.minimum(half, 1.0))))
        return float(np.degrees(np.mean(angles)))
