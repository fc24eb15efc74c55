# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The noise that is added to clean models; lengths are in mean edge lengths."""

from collections.abc import Callable, Mapping
from functools import partial

import numpy as np
import sources  # noqa: F401
from framelet.core import SurfaceMesh, add_noise
from framelet.core.surface.geometry import mean_edge_length, vertex_normals


def along_normals(surface: SurfaceMesh, seed: int, sigma: float) -> np.ndarray:
    """Return positions (N, 3) after Gaussian displacements along the vertex normals."""
    return add_noise(surface, sigma, seed)


def in_random_directions(surface: SurfaceMesh, seed: int, sigma: float) -> np.ndarray:
    """Return positions (N, 3) after displacements of Gaussian length in directions uniform on the sphere."""
    rng = np.random.default_rng(seed)
    length = rng.normal(0.0, sigma * mean_edge_length(surface), surface.n_vertices)
    direction = rng.normal(size=(surface.n_vertices, 3))
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    return (surface.vertices + length[:, None] * direction).astype(surface.vertices.dtype)


def impulsive(surface: SurfaceMesh, seed: int, sigma: float) -> np.ndarray:
    """Return positions (N, 3) after Gaussian displacements along the normals of half of the vertices."""
    rng = np.random.default_rng(seed)
    moved = rng.permutation(surface.n_vertices)[: surface.n_vertices // 2]
    length = np.zeros(surface.n_vertices)
    length[moved] = rng.normal(0.0, sigma * mean_edge_length(surface), len(moved))
    positions = surface.vertices + length[:, None] * vertex_normals(surface)
    return positions.astype(surface.vertices.dtype)


NOISES: Mapping[str, Callable[[SurfaceMesh, int], np.ndarray]] = {
    "normal 0.1": partial(along_normals, sigma=0.1),
    "normal 0.2": partial(along_normals, sigma=0.2),
    "normal 0.3": partial(along_normals, sigma=0.3),
    "normal 0.5": partial(along_normals, sigma=0.5),
    "normal 0.7": partial(along_normals, sigma=0.7),
    "direction 0.2": partial(in_random_directions, sigma=0.2),
    "impulsive 0.5": partial(impulsive, sigma=0.5),
}
"""Functions that take a clean surface and a seed, by name and standard deviation."""
