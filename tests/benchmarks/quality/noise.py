# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The noise that is added to clean models; lengths are in mean edge lengths."""

from collections.abc import Callable, Mapping
from functools import partial

import numpy as np
import sources  # noqa: F401
from framelet.core import SurfaceMesh, add_noise
from framelet.core.mesh.geometry import mean_edge_length, vertex_normals


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


def correlated(surface: SurfaceMesh, seed: int, n_averages: int, sigma: float = 0.2) -> np.ndarray:
    """Return positions (N, 3) after noise along the normals that is averaged with the one-ring, n times.

    Each time a vertex keeps half of its value and takes half of the mean of its neighbors. The result is
    scaled to its root mean square.
    """
    rng = np.random.default_rng(seed)
    heights = rng.normal(size=surface.n_vertices)
    ends = np.concatenate((surface.edges, surface.edges[:, ::-1]))
    valence = np.maximum(np.bincount(ends[:, 0], minlength=surface.n_vertices), 1)
    for _ in range(n_averages):
        around = np.bincount(ends[:, 0], heights[ends[:, 1]], surface.n_vertices) / valence
        heights = 0.5 * (heights + around)
    heights *= sigma * mean_edge_length(surface) / np.sqrt((heights**2).mean())
    return (surface.vertices + heights[:, None] * vertex_normals(surface)).astype(surface.vertices.dtype)


def local_edge(surface: SurfaceMesh) -> np.ndarray:
    """Return the mean length of the edges at each vertex, shape (N,); the mean edge length without any."""
    steps = surface.vertices[surface.edges[:, 0]] - surface.vertices[surface.edges[:, 1]]
    length = np.repeat(np.linalg.norm(steps, axis=1), 2)
    total = np.bincount(surface.edges.ravel(), length, surface.n_vertices)
    valence = np.bincount(surface.edges.ravel(), minlength=surface.n_vertices)
    return np.where(valence, total / np.maximum(valence, 1), mean_edge_length(surface))


def in_local_edges(surface: SurfaceMesh, seed: int, sigma: float) -> np.ndarray:
    """Return positions (N, 3) after noise along the normals that is as strong as the edges there are long."""
    heights = np.random.default_rng(seed).normal(0.0, sigma, surface.n_vertices) * local_edge(surface)
    return (surface.vertices + heights[:, None] * vertex_normals(surface)).astype(surface.vertices.dtype)


def half_of(surface: SurfaceMesh) -> np.ndarray:
    """Return which vertices lie beyond the middle of the longest side, shape (N,), bool."""
    axis = np.argmax(np.ptp(surface.vertices, axis=0))
    return surface.vertices[:, axis] > np.median(surface.vertices[:, axis])


def uneven(surface: SurfaceMesh, seed: int, weak: float, strong: float) -> np.ndarray:
    """Return positions (N, 3) after noise along the normals, weak on one half, strong on the other."""
    rng = np.random.default_rng(seed)
    sigma = np.where(half_of(surface), strong, weak) * mean_edge_length(surface)
    heights = sigma * rng.normal(size=surface.n_vertices)
    return (surface.vertices + heights[:, None] * vertex_normals(surface)).astype(surface.vertices.dtype)


def sparse(surface: SurfaceMesh, seed: int, share: float, sigma: float) -> np.ndarray:
    """Return positions (N, 3) after Gaussian displacements along the normals of a share of the vertices."""
    rng = np.random.default_rng(seed)
    heights = rng.normal(0.0, sigma * mean_edge_length(surface), surface.n_vertices)
    heights *= rng.random(surface.n_vertices) < share
    return (surface.vertices + heights[:, None] * vertex_normals(surface)).astype(surface.vertices.dtype)


def along_view(surface: SurfaceMesh, seed: int, sigma: float) -> np.ndarray:
    """Return positions (N, 3) after the errors of a range image: along one axis, larger at grazing angles."""
    rng = np.random.default_rng(seed)
    view = np.array([0.36, 0.48, 0.8])
    grazing = 1.0 / np.maximum(np.abs(vertex_normals(surface) @ view), 0.2)
    length = rng.normal(0.0, sigma * mean_edge_length(surface), surface.n_vertices) * np.sqrt(grazing)
    return (surface.vertices + length[:, None] * view).astype(surface.vertices.dtype)


def mixed(surface: SurfaceMesh, seed: int, white: float, n_averages: int, wide: float) -> np.ndarray:
    """Return positions (N, 3) after white noise along the normals and noise that is averaged n times."""
    both = along_normals(surface, seed, white) - surface.vertices
    return both + correlated(surface, seed + 1000, n_averages, wide)


def spiky(surface: SurfaceMesh, seed: int, share: float, sigma: float) -> np.ndarray:
    """Return positions (N, 3) after white noise, and spikes of 2 to 12 edges at a share of the vertices."""
    rng = np.random.default_rng(seed)
    heights = rng.uniform(2.0, 12.0, surface.n_vertices) * rng.choice([-1.0, 1.0], surface.n_vertices)
    heights *= rng.random(surface.n_vertices) < share
    heights += rng.normal(0.0, sigma, surface.n_vertices)
    heights *= mean_edge_length(surface)
    return (surface.vertices + heights[:, None] * vertex_normals(surface)).astype(surface.vertices.dtype)


def quantized(surface: SurfaceMesh, seed: int, step: float, n_axes: int) -> np.ndarray:
    """Return positions (N, 3) in whole steps along the last axes, from places that depend on the seed."""
    length, offset = step * mean_edge_length(surface), np.random.default_rng(seed).random(3)
    positions = surface.vertices.copy()
    positions[:, 3 - n_axes :] = ((np.round(positions / length + offset) - offset) * length)[:, 3 - n_axes :]
    return positions


NOISES: Mapping[str, Callable[[SurfaceMesh, int], np.ndarray]] = {
    "normal 0.1": partial(along_normals, sigma=0.1),
    "normal 0.2": partial(along_normals, sigma=0.2),
    "normal 0.3": partial(along_normals, sigma=0.3),
    "normal 0.5": partial(along_normals, sigma=0.5),
    "normal 0.7": partial(along_normals, sigma=0.7),
    "direction 0.2": partial(in_random_directions, sigma=0.2),
    "impulsive 0.5": partial(impulsive, sigma=0.5),
    "correlated 1": partial(correlated, n_averages=1),
    "correlated 2": partial(correlated, n_averages=2),
    "correlated 4": partial(correlated, n_averages=4),
    "correlated 8": partial(correlated, n_averages=8),
    "mixed 0.1 0.15": partial(mixed, white=0.1, n_averages=4, wide=0.15),
    "uneven 0.05 0.25": partial(uneven, weak=0.05, strong=0.25),
    "local 0.2": partial(in_local_edges, sigma=0.2),
    "sparse 0.6": partial(sparse, share=0.2, sigma=0.6),
    "view 0.15": partial(along_view, sigma=0.15),
    "spikes 1 %": partial(spiky, share=0.01, sigma=0.1),
    "terraces 0.8": partial(quantized, step=0.8, n_axes=1),
    "pixels 0.5": partial(quantized, step=0.5, n_axes=3),
}
"""Functions that take a clean surface and a seed, by name and standard deviation."""

WHITE = ("normal", "direction", "impulsive")
"""How the names of noise begin that is new at each vertex and the same everywhere."""


def is_white(noise: str) -> bool:
    """Return whether a noise is white and uniform; others are more like those of scanners."""
    return noise.startswith(WHITE)
