# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Choosing a recipe from the noisy mesh alone, by Stein's unbiased estimate of the risk."""

from __future__ import annotations

from collections.abc import Callable

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

LEAST_RISK = 0.05
"""In units of the variance of the noise; smaller risks count as this one, as the estimate is not that exact."""


def choose_recipe(
    noisy: NDArray[np.floating],
    surface: SurfaceMesh,
    sigma: float,
    blocks: Blocks,
    tick: Callable[[], None] = lambda: None,
) -> Recipe:
    """Try all recipes on parts of a mesh and return the best one.

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
        Called after each of twice as many runs as there are recipes.

    Returns
    -------
    Recipe

    Notes
    -----
    Stein's estimate of the mean squared error (Ramani, Blu, Unser 2008), for displacements q along the
    normals of the noisy mesh: mean(q^2) - sigma^2 + 2 sigma^2 mean(b dq / eps), where dq is how q changes
    when the vertices move by eps b, b = +-1. It is multiplied by the square of the mean difference of
    adjacent normals, as the error of positions says little about roughness, which is what people see.
    """
    part = trial_part(noisy, surface)
    points = np.ascontiguousarray(noisy[:, part.vertices])
    connectivity = connect(part.surface, blocks)
    at_vertex = faces_of_vertices(part.surface)
    directions = vertex_means(normals_of(points, part.surface), at_vertex)
    directions = unit_columns(directions, np.zeros_like(directions))
    # Signs and the sample of the noise are digits of different places of the same number.
    signs = np.where(scrambled(points, part.surface, at_vertex, sigma, 1009.0) < 0.5, -1, 1)
    signs = signs.astype(noisy.dtype)
    sample = unit_noise(scrambled(points, part.surface, at_vertex, sigma, 64.0))
    step = noisy.dtype.type(PROBE)
    probed = points + step * signs * directions
    problem, other = (
        NormalProblem(at, part.surface, connectivity, sigma, blocks, sample) for at in (points, probed)
    )
    other.unit = problem.unit
    counted = part.counts & directions.any(axis=0)
    risks, roughness = [], []
    for recipe in RECIPES:
        result = problem.run(recipe)
        tick()
        moved = other.run(recipe)
        tick()
        q = np.einsum("cn,cn->n", result - points, directions)[counted].astype(np.float64)
        change = np.einsum("cn,cn->n", moved - result, directions)[counted].astype(np.float64)
        divergence = float((signs[counted] * change).mean()) / PROBE if len(q) else 0.0
        # Both sides hold q = result - points, whose own divergence is that of the result less 1.
        risks.append(float((q * q).mean() if len(q) else 0.0) - sigma**2 + 2.0 * sigma**2 * divergence)
        roughness.append(_roughness(result, problem))
    return RECIPES[_best(risks, roughness, sigma)]


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
