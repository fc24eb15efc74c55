# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Choosing a recipe from the noisy mesh alone, by Stein's unbiased estimate of the risk."""

from __future__ import annotations

from collections.abc import Callable
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..normals.neighbors import faces_of_vertices
from ..normals.noise_sample import normals_of, scrambled, vertex_means
from ..normals.pilot import unit_columns
from ..surface.connectivity import connect
from ..surface.surface_mesh import SurfaceMesh
from .patches import trial_part
from .recipes import RECIPES, NormalProblem, Recipe, unit_noise

PROBE = 0.01
"""How far vertices are moved, in mean edge lengths, to see how much a result follows the noise."""

SIGNLESS = 1e-3
"""Scrambled numbers as near to 1/2 get no sign."""

LEAST_RISK = 0.03
"""In units of the variance of the noise; smaller risks count as this one: the estimate is not that exact."""

N_PROBES = (4, 8000)
"""Most probes, and the number of faces that one probe suffices for: small meshes need several."""


def choose_recipes(
    noisy: NDArray[np.floating],
    surface: SurfaceMesh,
    sigma: float,
    blocks: Blocks,
    tick: Callable[[float], None] = lambda _: None,
) -> tuple[Recipe, ...]:
    """Try all recipes on parts of a mesh and return the best one, or the best two to be averaged.

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

    Returns
    -------
    tuple of Recipe
        One or two.

    Notes
    -----
    Stein's estimate of the mean squared error (Ramani, Blu, Unser 2008), for displacements q along the
    normals of the noisy mesh: mean(q^2) - sigma^2 + 2 sigma^2 mean(b dr / eps), where dr is how the result
    changes when the vertices move by eps b, b = +-1. It is multiplied by the square of the mean difference of
    adjacent normals, as the error of positions says little about roughness, which is what people see.

    Two estimates whose errors differ are better on average than each of them. The risk of a mean of two
    results needs no further run.
    """
    part = trial_part(noisy, surface)
    points = np.ascontiguousarray(noisy[:, part.vertices])
    connectivity = connect(part.surface, blocks)
    at_vertex = faces_of_vertices(part.surface)
    directions = vertex_means(normals_of(points, part.surface), at_vertex)
    directions = unit_columns(directions, np.zeros_like(directions))
    counted = part.counts & directions.any(axis=0)
    if not counted.any():
        return (RECIPES[0],)
    sample = unit_noise(scrambled(points, part.surface, at_vertex, sigma, 64.0))
    problem = NormalProblem(points, part.surface, connectivity, sigma, blocks, sample)
    n_probes = min(N_PROBES[0], -(-N_PROBES[1] // part.surface.n_faces))
    share = 1.0 / ((1 + n_probes) * len(RECIPES))
    results, divergences = [], np.zeros(len(RECIPES))
    for recipe in RECIPES:
        results.append(problem.run(recipe))
        tick(share)
    for probe in range(n_probes):
        # Signs and the sample of the noise are digits of different places of the same number.
        number = scrambled(points, part.surface, at_vertex, sigma, 1009.0 - 101.0 * probe)
        apart = number - noisy.dtype.type(0.5)
        # Heights of 0 give 0, as rounding would decide the sign.
        signs = np.where(np.abs(apart) < SIGNLESS, 0, np.sign(apart))
        probed = points + noisy.dtype.type(PROBE) * signs * directions
        other = NormalProblem(probed, part.surface, connectivity, sigma, blocks, sample)
        other.unit = problem.unit
        for index, recipe in enumerate(RECIPES):
            change = np.einsum("cn,cn->n", other.run(recipe) - results[index], directions)
            divergences[index] += float(np.mean(signs[counted] * change[counted], dtype=np.float64)) / PROBE
            tick(share)
    divergences /= n_probes
    choices: list[tuple[int, ...]] = [(index,) for index in range(len(RECIPES))]
    choices += list(combinations(range(len(RECIPES)), 2))
    risks, roughness = [], []
    for choice in choices:
        result = results[choice[0]] if len(choice) == 1 else 0.5 * (results[choice[0]] + results[choice[1]])
        q = np.einsum("cn,cn->n", result - points, directions)[counted].astype(np.float64)
        divergence = float(np.mean(divergences[list(choice)]))
        risks.append(float(np.mean(q * q)) - sigma**2 + 2.0 * sigma**2 * divergence)
        roughness.append(_roughness(result, problem))
    return tuple(RECIPES[index] for index in choices[_best(risks, roughness, sigma)])


def _roughness(points: NDArray[np.floating], problem: NormalProblem) -> float:
    """Return the mean of |n_f - n_g| over adjacent faces."""
    normals = normals_of(points, problem.surface)
    own = np.repeat(np.arange(normals.shape[1]), np.diff(problem.neighbors.offset))
    apart = normals[:, own] - normals[:, problem.neighbors.neighbor]
    return float(np.sqrt((apart * apart).sum(axis=0)).mean()) if apart.size else 0.0


def _best(risks: list[float], roughness: list[float], sigma: float) -> int:
    """Return the recipe with the lowest risk times squared roughness."""
    smallest = max(min(roughness), 1e-12)
    scores = [
        max(risk, LEAST_RISK * sigma**2) * (rough / smallest) ** 2
        for risk, rough in zip(risks, roughness, strict=True)
    ]
    return int(np.argmin(scores))
