# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""All recipes, run on parts of a noisy mesh: what they do to it, and how much they follow the noise."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..normals.centroids import face_centroids
from ..normals.means import padded
from ..normals.neighbors import Ragged
from ..normals.noise_sample import area_vectors, scrambled, vertex_means
from ..normals.pilot import unit_columns
from ..surface.connectivity import Connectivity, connect
from ..surface.surface_mesh import SurfaceMesh
from .patches import trial_part
from .problem import NormalProblem
from .recipes import Recipe
from .smooth_positions import low_pass_changes

PROBE = 0.01
"""How far vertices are moved, in mean edge lengths, to see how much a result follows the noise."""

SIGNLESS = 1e-3
"""Scrambled numbers as near to 1/2 get no sign."""

N_PROBES = (2, 6000)
N_DRAWS = (2, 6000)
"""Most probes, or draws of noise for a rehearsal, and the number of faces that one suffices for: small meshes
need several."""

LARGEST_RESPONSE = 3.0
"""How much further than it was moved a vertex may be seen to move: a few that jump would drown all others."""

WIDENINGS = 3
"""Averages of normals over the faces around, so that strong noise does not tilt the directions."""

WIDE_UP_TO = 100_000
"""Faces up to which low-passes are tried on the whole mesh: wide ones reach over the rims of patches."""


class Probe(NamedTuple):
    """The part with its vertices moved a little.

    Attributes
    ----------
    problem : NormalProblem
        The part, moved.
    along : ndarray, shape (3, n)
        Signs times directions, zero where a vertex was not moved.
    results : dict
        What recipes, by their numbers, make of it, shape (3, n).
    """

    problem: NormalProblem
    along: NDArray[np.floating]
    results: dict[int, NDArray[np.floating]]


class Trial:
    """Results of recipes on a part of a mesh.

    Low-passes are cheap and may be wide. On meshes that are not too large they work on the whole mesh, the
    *ground*; on larger ones the ground is the part itself.

    Parameters
    ----------
    noisy : ndarray, shape (3, N)
        Noisy positions in mean edge lengths; not modified.
    surface : SurfaceMesh
        The mesh, for its faces.
    sigma : float
        Standard deviation of the noise along the normals, in mean edge lengths, above 0.
    recipes : sequence of Recipe
        What is run.
    blocks : Blocks
        Threads to work on.
    connectivity : Connectivity, optional
        Neighborhoods of the mesh, if they are known already.

    Attributes
    ----------
    is_empty : bool
        Whether no vertex counts, so that nothing can be tried.
    results : list of ndarray, shape (3, n)
        Positions of the part's vertices by each recipe, before folds are undone.
    heights : ndarray, shape (R, m)
        How far the vertices that count were moved along the normals of the noisy mesh, in units of sigma.
    """

    def __init__(
        self,
        noisy: NDArray[np.floating],
        surface: SurfaceMesh,
        sigma: float,
        recipes: Sequence[Recipe],
        blocks: Blocks,
        connectivity: Connectivity | None = None,
    ) -> None:
        part = trial_part(noisy, surface)
        # A part is so small that handing its blocks to threads costs more than they save.
        self.blocks = blocks.alone()
        self.surface, self.sigma, self.recipes = part.surface, sigma, recipes
        self.points = np.ascontiguousarray(noisy[:, part.vertices])
        self._connectivity = connect(part.surface, self.blocks)
        whole: Connectivity | None = None
        if part.surface is not surface and surface.n_faces <= WIDE_UP_TO:
            whole = connectivity or connect(surface, blocks)
        # Where vertices are not manifold low-passes are made average by average: too long for a whole mesh.
        if whole is None or whole.is_non_manifold.any():
            self.problem = self.ground = self.problem_at(self.points)
            self._in_ground: NDArray[np.integer] | slice = slice(None)
        else:
            self.ground = NormalProblem(noisy, surface, whole, sigma, blocks)
            self._in_ground = part.vertices
            self.problem = self.problem_at(self.points, self.ground.sample[part.vertices])
        self._ground_directions = _wide_normals(self.ground.noisy, self.ground.surface, self.ground.at_vertex)
        self.directions = self.in_part(self._ground_directions)
        self.counted = part.counts & self.directions.any(axis=0)
        self.is_empty = not self.counted.any()
        self.probes: list[Probe] = []
        self.n_probes, self.n_draws = (
            min(most, -(-n_faces // part.surface.n_faces)) for most, n_faces in (N_PROBES, N_DRAWS)
        )

    def problem_at(
        self, points: NDArray[np.floating], sample: NDArray[np.floating] | None = None
    ) -> NormalProblem:
        """Return the part with other positions, shape (3, n)."""
        return NormalProblem(points, self.surface, self._connectivity, self.sigma, self.blocks, sample)

    def in_part(self, field: NDArray) -> NDArray:
        """Return the values at the part's vertices, shape (..., n), of a field on the ground."""
        return np.ascontiguousarray(field[..., self._in_ground])

    def scrambled(self, periods: float) -> NDArray[np.floating]:
        """Return a number between 0 and 1 for each vertex of the ground, which looks random."""
        ground = self.ground
        return scrambled(ground.noisy, ground.surface, ground.at_vertex, self.sigma, periods, ground.blocks)

    def runs(
        self, problem: NormalProblem, on_ground: NDArray[np.floating], wanted: Iterable[int]
    ) -> Iterator[NDArray[np.floating]]:
        """Yield what recipes make of a problem on the part, shape (3, n), one after the other.

        The problem's positions on the ground go with it, for the low-passes.
        """
        wanted = list(wanted)
        filters = {
            index: self.recipes[index].n_averages for index in wanted if self.recipes[index].is_low_pass
        }
        rings = self.ground.rings
        changes: dict[int, NDArray[np.floating]] = {}
        if filters and self.ground is not self.problem:
            numbers = list(filters.values())
            found = low_pass_changes(rings.inward(padded(on_ground)), rings, numbers)
            changes = {n: rings.outward(change)[:, :3].T for n, change in zip(numbers, found, strict=True)}
        for index in wanted:
            if index in filters and changes:
                yield self.in_part(on_ground + changes[filters[index]])
            else:
                yield problem.run(self.recipes[index], is_unfolded=False)

    def run(self, tick: Callable[[], None]) -> None:
        """Run all recipes."""
        self.results, heights = [], []
        for result in self.runs(self.problem, self.ground.noisy, range(len(self.recipes))):
            self.results.append(result)
            heights.append(self.height_of(result))
            tick()
        self.heights = np.array(heights)

    def height_of(self, result: NDArray[np.floating]) -> NDArray[np.float64]:
        """Return how far the vertices that count were moved, shape (m,), in units of sigma."""
        height = np.einsum("cn,cn->n", result - self.points, self.directions)
        return height[self.counted].astype(np.float64) / self.sigma

    def divergences(self, wanted: NDArray[np.integer], tick: Callable[[], None]) -> NDArray[np.float64]:
        """Return mean(b dr / eps) of some recipes, shape (R,), zero for the others; see `choose_recipes`."""
        found = np.zeros(len(self.recipes))
        for probe in range(self.n_probes):
            # Signs and the sample of the noise are digits of different places of the same number.
            apart = self.scrambled(1009.0 - 101.0 * probe)
            apart -= apart.dtype.type(0.5)
            # Heights of 0 give 0, as rounding would decide the sign.
            signs = np.where(np.abs(apart) < SIGNLESS, 0, np.sign(apart))
            probed = self.ground.noisy + signs.dtype.type(PROBE) * signs * self._ground_directions
            other = self.problem_at(self.in_part(probed), self.problem.sample)
            other.units = self.problem.units
            seen = Probe(other, self.in_part(signs) * self.directions, {})
            for index, moved in zip(wanted, self.runs(other, probed, wanted), strict=True):
                seen.results[int(index)] = moved
                found[index] += self.follows(seen, moved, self.results[index]) / self.n_probes
                tick()
            self.probes.append(seen)
        return found

    def follows(self, probe: Probe, moved: NDArray[np.floating], result: NDArray[np.floating]) -> float:
        """Return mean(b dr / eps) of a result, shape (3, n), and of what is the same with a probe."""
        follows = np.einsum("cn,cn->n", moved - result, probe.along) / PROBE
        follows = np.clip(follows, -LARGEST_RESPONSE, LARGEST_RESPONSE)
        return float(np.mean(follows[self.counted], dtype=np.float64))

    def mean_of(self, choice: Sequence[int]) -> NDArray[np.floating]:
        """Return the mean, shape (3, n), of the results of some recipes."""
        return mean_of(self.results, choice)

    def ground_mean_of(
        self, choice: Sequence[int], tick: Callable[[], None] = lambda: None
    ) -> NDArray[np.floating]:
        """Return the mean of what some recipes make of the ground, in columns; `tick` is called often."""
        if self.ground is self.problem:
            return self.mean_of(choice)
        results = [
            self.ground.run(self.recipes[index], None, lambda _: tick(), is_unfolded=False)
            for index in choice
        ]
        return np.mean(results, axis=0, dtype=self.points.dtype)


def mean_of(
    results: Sequence[NDArray[np.floating]] | Mapping[int, NDArray[np.floating]], choice: Sequence[int]
) -> NDArray[np.floating]:
    """Return the mean, shape (3, n), of the results of some recipes, given by their numbers."""
    chosen = [results[index] for index in choice]
    return np.mean(chosen, axis=0, dtype=chosen[0].dtype)


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
