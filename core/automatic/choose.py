# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Choosing a recipe from the noisy mesh alone, by Stein's unbiased estimate of the risk."""

from __future__ import annotations

from collections.abc import Callable
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..normals.centroids import face_centroids
from ..normals.neighbors import Ragged, faces_of_vertices
from ..normals.noise_sample import area_vectors, normals_of, scrambled, vertex_means
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
"""In units of the variance of the noise; smaller risks count as this one: the estimate is not so exact."""

N_PROBES = (4, 8000)
"""Most probes, and the number of faces that one probe suffices for: small meshes need several."""


HANDICAP = 1.4
"""Factor on the risk of the low-pass of positions alone, which blurs creases: it has to be clearly better."""

LARGEST_RESPONSE = 3.0
"""How much further than it was moved a vertex may be seen to move: a few that jump would drown all others."""

STRONG = 0.35
"""Noise in mean edge lengths beyond which results of normals and of positions are not averaged. Risks are too
uncertain there, and the low-pass blurs the creases that the other one found."""

WIDENINGS = 3
"""Averages of normals over the faces around, so that strong noise does not tilt the directions."""


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
    directions = _wide_normals(points, part.surface, at_vertex)
    counted = part.counts & directions.any(axis=0)
    if not counted.any():
        return (RECIPES[0],)
    sample = unit_noise(scrambled(points, part.surface, at_vertex, sigma, 64.0))
    problem = NormalProblem(points, part.surface, connectivity, sigma, blocks, sample)
    n_probes = min(N_PROBES[0], -(-N_PROBES[1] // part.surface.n_faces))
    share = 1.0 / ((1 + n_probes) * len(RECIPES))
    results, divergences = [], np.zeros(len(RECIPES))
    for recipe in RECIPES:
        results.append(problem.run(recipe, is_unfolded=False))
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
            moved = other.run(recipe, is_unfolded=False) - results[index]
            follows = signs * np.einsum("cn,cn->n", moved, directions) / PROBE
            follows = np.clip(follows, -LARGEST_RESPONSE, LARGEST_RESPONSE)
            divergences[index] += float(np.mean(follows[counted], dtype=np.float64))
            tick(share)
    divergences /= n_probes
    choices: list[tuple[int, ...]] = [(index,) for index in range(len(RECIPES))]
    choices += [
        pair
        for pair in combinations(range(len(RECIPES)), 2)
        if sigma <= STRONG or _is_of_normals(pair[0]) == _is_of_normals(pair[1])
    ]
    risks, roughness = [], []
    for choice in choices:
        result = results[choice[0]] if len(choice) == 1 else 0.5 * (results[choice[0]] + results[choice[1]])
        q = np.einsum("cn,cn->n", result - points, directions)[counted].astype(np.float64)
        divergence = float(np.mean(divergences[list(choice)]))
        risk = float(np.mean(q * q)) - sigma**2 + 2.0 * sigma**2 * divergence
        is_blurring = not any(map(_is_of_normals, choice))
        risks.append(max(risk, LEAST_RISK * sigma**2) * (HANDICAP if is_blurring else 1.0))
        roughness.append(_roughness(result, problem, counted))
    return tuple(RECIPES[index] for index in choices[_best(risks, roughness)])


def _is_of_normals(index: int) -> bool:
    """Tell whether a recipe works on normals; the others work on positions."""
    return bool(RECIPES[index].range_sigmas)


def _wide_normals(
    points: NDArray[np.floating], surface: SurfaceMesh, at_vertex: Ragged
) -> NDArray[np.floating]:
    """Return unit normals, shape (3, N), over a few rings of faces; zero at loose vertices."""
    normals = area_vectors(points, surface)
    for _ in range(WIDENINGS):
        at_vertices = vertex_means(normals, at_vertex)
        normals = face_centroids(at_vertices, surface)
    at_vertices = vertex_means(normals, at_vertex)
    return unit_columns(at_vertices, np.zeros_like(at_vertices))


def _roughness(points: NDArray[np.floating], problem: NormalProblem, counted: NDArray[np.bool_]) -> float:
    """Return the mean of |n_f - n_g| over adjacent faces, those at the counted vertices only."""
    normals = normals_of(points, problem.surface)
    own = np.repeat(np.arange(normals.shape[1]), np.diff(problem.neighbors.offset))
    # The corners of a face are its edges as well, so that `own` goes along with them.
    inside = counted[problem.surface.corner_vertex]
    apart = normals[:, own[inside]] - normals[:, problem.neighbors.neighbor[inside]]
    return float(np.sqrt((apart * apart).sum(axis=0)).mean()) if apart.size else 0.0


def _best(risks: list[float], roughness: list[float]) -> int:
    """Return which choice has the lowest risk times squared roughness."""
    smallest = max(min(roughness), 1e-12)
    scores = [risk * (rough / smallest) ** 2 for risk, rough in zip(risks, roughness, strict=True)]
    return int(np.argmin(scores))
