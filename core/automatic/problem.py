# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A noisy mesh on which recipes are run."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property, partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..denoising.constraints import Constraints
from ..memory import MANY_ITEMS, give_back
from ..normals.band_shrinkage import shrink_inside
from ..normals.centroids import face_centroids
from ..normals.face_averages import FaceAverages, face_averages
from ..normals.folds import unfold
from ..normals.neighbors import Ragged, edge_neighbors, faces_of_vertices
from ..normals.noise_sample import (
    PERIODS,
    area_vectors,
    noise_in_normals,
    normals_of,
    scrambled,
    vertex_means,
)
from ..normals.pilot import median_difference, pilot_normals, unit_columns
from ..normals.vertex_fit import VertexFit
from ..surface.connectivity import Connectivity
from ..surface.surface_mesh import SurfaceMesh
from ..transform.adaptive_level import Neighbors
from .finish import Pass
from .position_bands import shrink_positions
from .recipes import PILOTS, Recipe
from .smooth_positions import RingAverages, smooth_positions

PILOT_VERTEX_STEPS = 8
"""Vertex steps that make a surface from a pilot, to sample the noise on."""

TINY_STEP = 0.02
"""Share of the noise by which vertices move to see what the noise does to normals of the noisy mesh."""

LEAST_WIDTH = 1e-4
"""Of weights on differences of unit normals; where the noise changes none of them, rounding does."""

SLIGHTLY = 4
"""Averages that smooth the positions from which distances and areas are taken."""

Tick = Callable[[float], None]
"""Called with the rms motion of the vertices, or 0."""


class _Start(NamedTuple):
    """What a recipe begins with: smoothed positions, their normals, the noise that is left, pilots."""

    points: NDArray[np.floating]  # (3, N)
    normals: NDArray[np.floating] | None  # (3, F); None where they are made again each time
    sample: NDArray[np.floating]  # (N,), for noise of standard deviation 1 before smoothing
    pilots: dict[float, NDArray[np.floating]]


class NormalProblem:
    """A noisy mesh and what all recipes need of it.

    Parameters
    ----------
    noisy : ndarray, shape (3, N)
        Noisy positions in mean edge lengths; not modified.
    surface : SurfaceMesh
        The mesh, for its faces.
    connectivity : Connectivity
        Its neighborhoods.
    sigma : float
        Standard deviation of the noise along the normals, in mean edge lengths, above 0.
    blocks : Blocks
        Threads to work on.
    sample : ndarray, shape (N,), optional
        Numbers of mean 0 and variance 1 that stand for noise; by default made from the positions.
    """

    def __init__(
        self,
        noisy: NDArray[np.floating],
        surface: SurfaceMesh,
        connectivity: Connectivity,
        sigma: float,
        blocks: Blocks,
        sample: NDArray[np.floating] | None = None,
    ) -> None:
        self.noisy, self.surface, self.blocks, self.sigma = noisy, surface, blocks, sigma
        self._connectivity = connectivity
        if sample is None:
            sample = unit_noise(scrambled(noisy, surface, self.at_vertex, sigma, PERIODS, blocks))
        self.sample = sample
        self.units: dict[int, float] = {}
        """Median differences that the noise makes between neighboring normals, by the averages before."""
        self._starts: dict[int, _Start] = {}
        self._pilots: dict[Recipe, NDArray[np.floating]] = {}
        self.is_frugal = False
        """Whether nothing is kept for other recipes that is made again quickly."""

    @property
    def neighbors(self) -> Neighbors:
        """The faces across edges; made quickly, and large."""
        return edge_neighbors(self.surface, self._connectivity)

    @cached_property
    def at_vertex(self) -> Ragged:
        """The faces at each vertex."""
        return faces_of_vertices(self.surface, self._connectivity)

    @cached_property
    def fit(self) -> VertexFit:
        """Steps of the vertices."""
        return VertexFit(self.surface, self.at_vertex, self.blocks)

    @cached_property
    def averages(self) -> FaceAverages:
        """Averages over the faces around a face.

        Distances and areas are those of slightly smoothed positions, since noise makes areas too large.
        """
        points = smooth_positions(self.noisy, self.rings, SLIGHTLY)
        areas = np.sqrt((area_vectors(points, self.surface, self.blocks) ** 2).sum(axis=0))
        return face_averages(points, self.surface, self.at_vertex, self.neighbors, areas, self.blocks)

    @cached_property
    def rings(self) -> RingAverages:
        """Means over the neighbors of each vertex."""
        return RingAverages(self._connectivity, self.blocks)

    def start(self, n_averages: int) -> _Start:
        """Return what recipes begin with that smooth positions by so many averages; kept for others."""
        if n_averages not in self._starts:
            self._starts[n_averages] = self._make_start(n_averages)
        return self._starts[n_averages]

    def _make_start(self, n_averages: int) -> _Start:
        points, sample = self.noisy, self.sample
        if n_averages:
            both = smooth_positions(np.concatenate((points, sample[None])), self.rings, n_averages)
            points, sample = both[:3], both[3]
        normals = normals_of(points, self.surface, self.blocks)
        if n_averages not in self.units:
            neighbors = self.neighbors
            little = self._noise_in_normals(points, TINY_STEP * sample)
            # What a little noise does, scaled up, is too much for strong noise: no angle exceeds a half turn.
            self.units[n_averages] = min(
                median_difference(little, neighbors, self.blocks) / TINY_STEP,
                median_difference(normals, neighbors, self.blocks),
            )
        return _Start(points, None if self.is_frugal else normals, sample, {})

    def _normals_of(self, start: _Start) -> NDArray[np.floating]:
        """Return the normals, shape (3, F), that a recipe begins with."""
        return normals_of(start.points, self.surface, self.blocks) if start.normals is None else start.normals

    def clean_normals(self, recipe: Recipe, tick: Tick = lambda _: None) -> NDArray[np.floating]:
        """Return unit normals, shape (3, F)."""
        start = self.start(recipe.n_averages)
        if recipe.n_rounds:
            return self._averaged_in_rounds(recipe, self._normals_of(start), tick)
        if recipe.threshold not in start.pilots:
            start.pilots[recipe.threshold] = pilot_normals(
                self._normals_of(start),
                self.neighbors,
                recipe.threshold,
                0.0,
                self.blocks,
                lambda: tick(0.0),
                unit=self.units[recipe.n_averages],
            )
            give_back(self.surface.n_faces)
        normals = start.pilots[recipe.threshold]
        if self.is_frugal:
            del start.pilots[recipe.threshold]
        for range_sigma in recipe.range_sigmas:
            guides = [normals]
            del normals  # handed over, so that its memory is free once the fields are made
            normals = self._shrunk(start, guides, range_sigma, recipe.caution, recipe.n_bands, tick)
        return normals

    def _shrunk(
        self,
        start: _Start,
        guides: list[NDArray[np.floating]],
        range_sigma: float,
        caution: float,
        n_bands: int,
        tick: Tick,
    ) -> NDArray[np.floating]:
        """Return unit normals, shape (3, F), by a pass of shrinkage. Guides are taken out of the list."""
        weights = self.averages.weights(guides[0], range_sigma)
        cleaned = shrink_inside(
            partial(self._fields_around, start, guides),
            self.averages,
            weights,
            n_bands,
            caution,
            lambda: tick(0.0),
        )
        del weights
        return unit_columns(cleaned, self._normals_of(start))

    def pass_again(
        self,
        points: NDArray[np.floating],
        again: Pass,
        constraints: Constraints | None = None,
        tick: Tick = lambda _: None,
    ) -> NDArray[np.floating]:
        """Return positions, shape (3, N), after one more pass whose pilot is a result."""
        guides = [normals_of(points, self.surface, self.blocks)]
        normals = self._shrunk(self.start(0), guides, again.range_sigma, again.caution, again.n_bands, tick)
        return self.fitted(points, normals, again.vertex_steps, constraints, tick)

    def _averaged_in_rounds(
        self, recipe: Recipe, normals: NDArray[np.floating], tick: Tick
    ) -> NDArray[np.floating]:
        """Return unit normals, shape (3, F), after averages with weights that are made again each time."""
        self.start(0)  # the unit is that of the noisy normals, smoothed or not
        width = max(recipe.range_units * self.units[0], LEAST_WIDTH)
        for _ in range(recipe.n_rounds):
            normals = self.averages.smooth(normals, self.averages.weights(normals, width), 1)
            tick(0.0)
        return normals

    def _fields_around(self, start: _Start, guides: list[NDArray[np.floating]]) -> NDArray[np.floating]:
        """Return noisy normals, a sample of the noise in them on a surface with given normals, and these.

        The latter are taken out of the list.
        """
        normals = guides.pop()
        points = self.fitted(start.points, normals, PILOT_VERTEX_STEPS)
        noise = self._noise_in_normals(points, start.sample)
        fields = self.averages.inward_rows([*self._normals_of(start), *noise, *normals])
        del points, noise, normals
        if self.surface.n_faces >= MANY_ITEMS:
            # Made again quickly, and large when memory is needed most.
            for name in ("fit", "rings", "at_vertex"):
                self.__dict__.pop(name, None)
        give_back(self.surface.n_faces)
        return fields

    def _noise_in_normals(
        self, points: NDArray[np.floating], sample: NDArray[np.floating]
    ) -> NDArray[np.floating]:
        """Return how normals, shape (3, F), change when the noise that a sample stands for is added."""
        return noise_in_normals(points, self.sigma * sample, self.surface, self.at_vertex, self.blocks)

    def fitted(
        self,
        start: NDArray[np.floating],
        normals: NDArray[np.floating],
        n_steps: int,
        constraints: Constraints | None = None,
        tick: Tick | None = None,
    ) -> NDArray[np.floating]:
        """Return positions, shape (3, N), whose faces have the wanted normals as far as possible."""
        fit = self.fit.steps(start, normals)
        return fit.after(n_steps, constraints, self.noisy, tick or (lambda _: None))

    def run(
        self,
        recipe: Recipe,
        constraints: Constraints | None = None,
        tick: Tick = lambda _: None,
        *,
        is_unfolded: bool = True,
    ) -> NDArray[np.floating]:
        """Return denoised positions, shape (3, N), if asked for without folds as far as possible."""
        if recipe.is_refined:
            points, normals = self._refined(recipe, tick), None
        elif recipe.range_sigmas or recipe.n_rounds:
            normals = self.clean_normals(recipe, tick)
            start = self.start(recipe.n_averages).points
            points = self.fitted(start, normals, recipe.vertex_steps, constraints, tick)
        else:
            points, normals = self.start(recipe.n_averages).points, None
            if constraints is not None:
                points = points.copy()  # others start from them, where nothing is held yet
            tick(0.0)
        if not is_unfolded:
            pilot = recipe._replace(label="")
            if constraints is None and pilot in PILOTS and self.surface.n_faces < MANY_ITEMS:
                self._pilots[pilot] = points
            return points
        if normals is None:
            normals = self.normals_around(points)
        points = unfold(points, normals, self.surface, self.ring_mean)
        if constraints is not None:
            constraints.apply(points, self.noisy)
        return points

    def _refined(self, recipe: Recipe, tick: Tick) -> NDArray[np.floating]:
        """Return positions, shape (3, N), whose bands are shrunk by those of what the recipe gives else."""
        if recipe.pilot in self._pilots:
            pilot = self._pilots[recipe.pilot]
        else:
            pilot = self.run(recipe.pilot, None, tick, is_unfolded=False)
        directions = self.vertex_normals(pilot)
        noise = self.sigma * self.sample
        points = shrink_positions(self.noisy, noise, pilot, directions, self.rings, recipe.position_caution)
        tick(0.0)
        return points

    def vertex_normals(self, points: NDArray[np.floating]) -> NDArray[np.floating]:
        """Return unit normals at the vertices, shape (3, N), weighted by area; zero at loose vertices."""
        areas = area_vectors(points, self.surface, self.blocks)
        at_vertices = vertex_means(areas, self.at_vertex, self.blocks)
        return unit_columns(at_vertices, np.zeros_like(at_vertices))

    def normals_around(self, points: NDArray[np.floating]) -> NDArray[np.floating]:
        """Return, for each face, the mean normal of the faces around its corners, shape (3, F)."""
        areas = area_vectors(points, self.surface, self.blocks)
        at_corners = vertex_means(areas, self.at_vertex, self.blocks)
        around = face_centroids(at_corners, self.surface, self.blocks)
        return unit_columns(around, np.zeros_like(around))

    def ring_mean(self, points: NDArray[np.floating]) -> NDArray[np.floating]:
        """Return the means over the neighbors of each vertex, shape (3, N)."""
        return self.rings.mean_of(points)


def unit_noise(number: NDArray[np.floating]) -> NDArray[np.floating]:
    """Return numbers of mean 0 and variance 1 from numbers spread evenly from 0 to 1."""
    return (number - number.dtype.type(0.5)) * number.dtype.type(12.0**0.5)
