# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The recipes that automatic denoising chooses from, and running one of them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..denoising.constraints import Constraints
from ..denoising.progress import rms_motion
from ..normals.band_shrinkage import shrink_bands
from ..normals.face_averages import FaceAverages
from ..normals.folds import unfold
from ..normals.neighbors import edge_neighbors, faces_of_vertices
from ..normals.noise_sample import area_vectors, noise_in_normals, normals_of, scrambled, vertex_means
from ..normals.pilot import ITERATIONS, median_difference, pilot_normals, unit_columns
from ..normals.vertex_fit import VertexFit
from ..normals.vertex_update import face_centroids
from ..surface.connectivity import Connectivity
from ..surface.surface_mesh import SurfaceMesh
from .smooth_positions import RingAverages, smooth_positions


class Recipe(NamedTuple):
    """Parameters of a run on normals.

    `threshold` is the pilot's, in units of the median difference that the noise makes between neighboring
    normals. There is a pass of shrinkage for each of `range_sigmas`; without any, positions are filtered
    instead of normals, by a low-pass of `n_averages`. `caution` is explained in `normals.band_shrinkage`.
    """

    label: str
    threshold: float = 0.0
    range_sigmas: tuple[float, ...] = ()
    caution: float = 1.0
    n_bands: int = 0
    vertex_steps: int = 0
    n_averages: int = 0


RECIPES = (
    Recipe("Flat and sharp", 0.12, (0.4, 0.3), 1.5, 6, 40),
    Recipe("Smooth and even", 0.12, (0.35, 0.25), 4.0, 6, 40),
    Recipe("Sharp and coarse", 0.05, (0.5, 0.3), 1.5, 6, 25),
    Recipe("Round with edges", 0.12, (0.5, 0.5), 1.5, 5, 15),
    Recipe("Soft", 0.12, (0.8, 0.6), 1.5, 4, 12),
    Recipe("Fine relief", 0.12, (1.2, 1.2), 1.5, 4, 8),
    *(Recipe(f"Smooth and coarse {k}", n_averages=k) for k in (2, 4, 8, 16, 32, 64)),
)
"""From machine parts to organic shapes."""

PILOT_VERTEX_STEPS = 8
"""Vertex steps that make a surface from a pilot, to sample the noise on."""

TINY_STEP = 0.02
"""Share of the noise by which vertices move to see what the noise does to normals of the noisy mesh."""

Tick = Callable[[float], None]
"""Called with the rms motion of the vertices, or 0."""


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
        self.neighbors = edge_neighbors(surface, connectivity)
        self.at_vertex = faces_of_vertices(surface)
        self.normals = normals_of(noisy, surface)
        if sample is None:
            sample = unit_noise(scrambled(noisy, surface, self.at_vertex, sigma, 64.0))
        self.sample = sample
        centroids = face_centroids(noisy, surface)
        areas = np.sqrt((area_vectors(noisy, surface) ** 2).sum(axis=0))
        own = np.repeat(np.arange(surface.n_faces), np.diff(self.neighbors.offset))
        apart = centroids[:, self.neighbors.neighbor] - centroids[:, own]
        distance = np.sqrt((apart * apart).sum(axis=0))
        spatial_sigma = float(distance[distance > 0].mean()) if distance.any() else 1.0
        self.averages = FaceAverages(
            surface, self.at_vertex, np.ascontiguousarray(centroids.T), areas, spatial_sigma, blocks
        )
        little = noise_in_normals(noisy, TINY_STEP * sigma * sample, surface, self.at_vertex, blocks)
        # What a little noise does, scaled up, is too much for strong noise: no angle exceeds a half turn.
        self.unit = min(
            median_difference(little, self.neighbors) / TINY_STEP,
            median_difference(self.normals, self.neighbors),
        )
        self.fit = VertexFit(surface, self.at_vertex, blocks)
        self._connectivity = connectivity
        self._pilots: dict[float, NDArray[np.floating]] = {}

    @cached_property
    def rings(self) -> RingAverages:
        """Means over the neighbors of each vertex."""
        return RingAverages(self._connectivity, self.blocks)

    def clean_normals(self, recipe: Recipe, tick: Tick = lambda _: None) -> NDArray[np.floating]:
        """Return unit normals, shape (3, F)."""
        if recipe.threshold not in self._pilots:
            self._pilots[recipe.threshold] = pilot_normals(
                self.normals,
                self.neighbors,
                recipe.threshold,
                0.0,
                self.blocks,
                lambda: tick(0.0),
                unit=self.unit,
            )
        normals = self._pilots[recipe.threshold]
        for range_sigma in recipe.range_sigmas:
            cleaned = shrink_bands(
                self.normals,
                self._noise_around(normals),
                normals,
                self.averages,
                self.averages.weights(normals, range_sigma),
                recipe.n_bands,
                recipe.caution,
                lambda: tick(0.0),
            )
            normals = unit_columns(cleaned, self.normals)
        return normals

    def _noise_around(self, normals: NDArray[np.floating]) -> NDArray[np.floating]:
        """Return a sample of the noise in normals, shape (3, F), on a surface with given normals."""
        points = self.fitted(normals, PILOT_VERTEX_STEPS)
        return noise_in_normals(points, self.sigma * self.sample, self.surface, self.at_vertex, self.blocks)

    def fitted(
        self,
        normals: NDArray[np.floating],
        n_steps: int,
        constraints: Constraints | None = None,
        tick: Tick | None = None,
    ) -> NDArray[np.floating]:
        """Return positions, shape (3, N), whose faces have the wanted normals as far as possible."""
        steps = self.fit.steps(self.noisy, normals)
        displacement = np.zeros_like(self.noisy)
        for _ in range(n_steps):
            before, displacement = displacement, steps.advance(displacement)
            if constraints is not None:
                points = self.noisy + displacement
                constraints.apply(points, self.noisy)
                displacement = points - self.noisy
            if tick is not None:
                tick(rms_motion(displacement, before, self.blocks))
        return self.noisy + displacement

    def run(
        self,
        recipe: Recipe,
        constraints: Constraints | None = None,
        tick: Tick = lambda _: None,
        *,
        is_unfolded: bool = True,
    ) -> NDArray[np.floating]:
        """Return denoised positions, shape (3, N), if asked for without folds as far as possible."""
        if recipe.range_sigmas:
            normals = self.clean_normals(recipe, tick)
            points = self.fitted(normals, recipe.vertex_steps, constraints, tick)
        else:
            points = smooth_positions(self.noisy, self.rings, recipe.n_averages)
            tick(0.0)
            normals = self._normals_around(points)
        if not is_unfolded:
            return points
        points = unfold(points, normals, self.surface, self._ring_mean)
        if constraints is not None:
            constraints.apply(points, self.noisy)
        return points

    def run_all(
        self, recipes: Sequence[Recipe], constraints: Constraints, tick: Tick = lambda _: None
    ) -> NDArray[np.floating]:
        """Return the mean, shape (3, N), of what recipes give."""
        points = self.run(recipes[0], constraints, tick)
        if len(recipes) > 1:
            points = sum((self.run(recipe, constraints, tick) for recipe in recipes[1:]), points)
            points = points / points.dtype.type(len(recipes))
            points = unfold(points, self._normals_around(points), self.surface, self._ring_mean)
            constraints.apply(points, self.noisy)
        return points

    def _normals_around(self, points: NDArray[np.floating]) -> NDArray[np.floating]:
        """Return, for each face, the mean normal of the faces around its corners, shape (3, F)."""
        at_corners = vertex_means(area_vectors(points, self.surface), self.at_vertex)
        around = face_centroids(at_corners, self.surface)
        return unit_columns(around, np.zeros_like(around))

    def _ring_mean(self, points: NDArray[np.floating]) -> NDArray[np.floating]:
        """Return the means over the neighbors of each vertex, shape (3, N)."""
        return self.rings.mean_of(points)


def unit_noise(number: NDArray[np.floating]) -> NDArray[np.floating]:
    """Return numbers of mean 0 and variance 1 from numbers spread evenly from 0 to 1."""
    return (number - number.dtype.type(0.5)) * number.dtype.type(12.0**0.5)


def n_ticks(recipe: Recipe) -> int:
    """Return how often a run of a recipe calls `tick`, if its pilot is not there yet."""
    if not recipe.range_sigmas:
        return 1
    return ITERATIONS + len(recipe.range_sigmas) * recipe.n_bands + recipe.vertex_steps
