# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Choosing a recipe from the noisy mesh alone, by Stein's unbiased estimate of the risk."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..normals.centroids import face_centroids
from ..normals.neighbors import Ragged, faces_of_vertices
from ..normals.noise_sample import PERIODS, area_vectors, normals_of, scrambled, vertex_means
from ..normals.pilot import unit_columns
from ..surface.connectivity import connect
from ..surface.surface_mesh import SurfaceMesh
from .patches import trial_part
from .problem import NormalProblem, unit_noise
from .recipes import RECIPES, Recipe

PROBE = 0.01
"""How far vertices are moved, in mean edge lengths, to see how much a result follows the noise."""

SIGNLESS = 1e-3
"""Scrambled numbers as near to 1/2 get no sign."""

N_PROBES = (4, 6000)
"""Most probes, and the number of faces that one probe suffices for: small meshes need several."""

LARGEST_RESPONSE = 3.0
"""How much further than it was moved a vertex may be seen to move: a few that jump would drown all others."""

HOPELESS = 0.5
"""A recipe whose squared displacements are so many variances of the noise above the smallest ones is given up
without probes: they do not tell more than that apart."""

UNCERTAINTY = 0.08
"""In units of the variance of the noise: how well risks are known. It is added to them, so that risks that
are all nearly zero leave the choice to smoothness."""

SMOOTHNESS = (0.5, 0.25)
"""Powers of the two measures of roughness that risks are multiplied by."""

N_PAIRED = 12
"""Recipes, the best ones alone, whose pairs are looked at."""

TINY_ROUGHNESS = 1e-4
"""Differences of normals below this are rounding."""

PAIRED_UP_TO = 500_000
"""Faces up to which two recipes may be run and averaged; the time of larger meshes is better spent on one."""

WIDENINGS = 3
"""Averages of normals over the faces around, so that strong noise does not tilt the directions."""


def choose_recipes(
    noisy: NDArray[np.floating],
    surface: SurfaceMesh,
    sigma: float,
    blocks: Blocks,
    tick: Callable[[float], None] = lambda _: None,
    strength: float = 1.0,
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
    strength : float, optional
        How much more smoothness counts: factor on the powers of roughness.

    Returns
    -------
    tuple of Recipe
        One or two.

    Notes
    -----
    Stein's estimate of the mean squared error (Ramani, Blu, Unser 2008), for displacements q along the
    normals of the noisy mesh: mean(q^2) - sigma^2 + 2 sigma^2 mean(b dr / eps), where dr is how the result
    changes when the vertices move by eps b, b = +-1. In units of sigma^2 and plus `UNCERTAINTY`, it is
    multiplied by powers of two measures of roughness (see `_Roughness`), as the error of positions says
    little about roughness, which is what people see. Estimates below zero say that the noise was estimated
    too strong; all are raised by as much.

    Two results whose errors differ are better on average than each of them. The risk of a mean of two results
    needs no further run.
    """
    part = trial_part(noisy, surface)
    points = np.ascontiguousarray(noisy[:, part.vertices])
    connectivity = connect(part.surface, blocks)
    at_vertex = faces_of_vertices(part.surface)
    directions = _wide_normals(points, part.surface, at_vertex)
    counted = part.counts & directions.any(axis=0)
    if not counted.any():
        tick(1.0)
        return (RECIPES[0],)
    sample = unit_noise(scrambled(points, part.surface, at_vertex, sigma, PERIODS))
    problem = NormalProblem(points, part.surface, connectivity, sigma, blocks, sample)
    n_probes = min(N_PROBES[0], -(-N_PROBES[1] // part.surface.n_faces))
    share = 1.0 / ((1 + n_probes) * len(RECIPES))
    results, heights = [], []
    for recipe in RECIPES:
        results.append(problem.run(recipe, is_unfolded=False))
        height = np.einsum("cn,cn->n", results[-1] - points, directions)
        heights.append(height[counted].astype(np.float64))
        tick(share)
    spread = np.array([np.mean(height * height) for height in heights]) / sigma**2
    hopeful = np.flatnonzero(spread <= spread.min() + HOPELESS)
    divergence = np.zeros(len(RECIPES))
    for probe in range(n_probes):
        # Signs and the sample of the noise are digits of different places of the same number.
        number = scrambled(points, part.surface, at_vertex, sigma, 1009.0 - 101.0 * probe)
        apart = number - noisy.dtype.type(0.5)
        # Heights of 0 give 0, as rounding would decide the sign.
        signs = np.where(np.abs(apart) < SIGNLESS, 0, np.sign(apart))
        probed = points + noisy.dtype.type(PROBE) * signs * directions
        other = NormalProblem(probed, part.surface, connectivity, sigma, blocks, sample)
        other.units = problem.units
        for index in hopeful:
            moved = other.run(RECIPES[index], is_unfolded=False) - results[index]
            follows = signs * np.einsum("cn,cn->n", moved, directions) / PROBE
            follows = np.clip(follows, -LARGEST_RESPONSE, LARGEST_RESPONSE)
            divergence[index] += float(np.mean(follows[counted], dtype=np.float64)) / n_probes
            tick(share)
        tick(share * (len(RECIPES) - len(hopeful)))
    rough = _Roughness(problem, counted)

    def judge(choices: Sequence[tuple[int, ...]]) -> NDArray[np.float64]:
        """Return a risk and two measures of roughness for each choice, shape (3, n)."""
        judged = []
        for choice in choices:
            members = list(choice)
            result = np.mean([results[index] for index in members], axis=0, dtype=noisy.dtype)
            height = np.mean([heights[index] for index in members], axis=0)
            chosen_risk = np.mean(height * height) / sigma**2 - 1.0 + 2.0 * divergence[members].mean()
            judged.append((chosen_risk, *rough.of(result)))
        return np.array(judged).T

    singles = [(int(index),) for index in hopeful]
    alone = judge(singles)
    if surface.n_faces > PAIRED_UP_TO:
        return (RECIPES[singles[int(np.argmin(scores(*alone, strength=strength)))][0]],)
    best = hopeful[np.argsort(scores(*alone, strength=strength), kind="stable")[:N_PAIRED]]
    choices = singles + [(int(first), int(second)) for first, second in combinations(np.sort(best), 2)]
    judged = np.concatenate((alone, judge(choices[len(singles) :])), axis=1) if len(best) > 1 else alone
    return tuple(RECIPES[index] for index in choices[int(np.argmin(scores(*judged, strength=strength)))])


def scores(
    risk: NDArray[np.float64], *roughness: NDArray[np.float64], strength: float = 1.0
) -> NDArray[np.float64]:
    """Return what is to be small, shape (n,): risks in variances of the noise times powers of roughness.

    The powers are multiplied by `strength`: who asks for more than was measured wants it smoother.
    """
    found = risk - min(0.0, float(risk.min())) + UNCERTAINTY
    for rough, power in zip(roughness, SMOOTHNESS, strict=True):
        smallest = max(float(rough.min()), TINY_ROUGHNESS)
        found = found * (np.maximum(rough, smallest) / smallest) ** (strength * power)
    return found


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


class _Roughness:
    """How rough a result is, at the counted vertices only.

    Parameters
    ----------
    problem : NormalProblem
        The mesh.
    counted : ndarray, shape (N,), bool
        Vertices that count.
    """

    def __init__(self, problem: NormalProblem, counted: NDArray[np.bool_]) -> None:
        surface, neighbors = problem.surface, problem.neighbors
        own = np.repeat(np.arange(surface.n_faces), np.diff(neighbors.offset))
        # The corners of a face are its edges as well, so that `own` goes along with them.
        is_seen = counted[surface.corner_vertex] & (own != neighbors.neighbor)
        self._surface, self._first, self._second = surface, own[is_seen], neighbors.neighbor[is_seen]
        n_all = np.bincount(own, minlength=surface.n_faces)
        self._n_seen = np.bincount(self._first, minlength=surface.n_faces)
        n_counted = np.bincount(own[counted[surface.corner_vertex]], minlength=surface.n_faces)
        self._inner = np.flatnonzero((self._n_seen > 0) & (n_counted == n_all))

    def of(self, points: NDArray[np.floating]) -> tuple[float, float]:
        """Return two measures of the roughness of positions, shape (3, N).

        The lower quartile of |n_f - n_g| over adjacent faces: creases do not count, and flat regions do. The
        root mean square of |n_f - mean(n_g)|: bends that all neighbors share do not count.
        """
        if not len(self._inner):
            return 0.0, 0.0
        normals = normals_of(points, self._surface)
        others = normals[:, self._second]
        apart = normals[:, self._first] - others
        squares = np.einsum("cn,cn->n", apart, apart)
        quarter = len(squares) // 4
        n_faces = normals.shape[1]
        sums = np.stack([np.bincount(self._first, row, minlength=n_faces) for row in others])
        bent = normals[:, self._inner] - sums[:, self._inner] / self._n_seen[self._inner]
        return (
            float(np.sqrt(np.partition(squares, quarter)[quarter])),
            float(np.sqrt(np.mean(np.einsum("cn,cn->n", bent, bent)))),
        )
