# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Noise as scanners, sculptors and converters make it, drawn at random for training."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

from .sample_mesh import SampleMesh

Draw = Callable[[SampleMesh, np.random.Generator], NDArray[np.float64]]
"""`draw(mesh, rng)` returns noisy positions, shape (N, 3)."""


def log_uniform(rng: np.random.Generator, low: float, high: float) -> float:
    """Return a number whose logarithm is uniform."""
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


def _unit(mesh: SampleMesh, rng: np.random.Generator) -> NDArray[np.float64]:
    """Return the unit of length at each vertex, shape (N,): the mean edge of the mesh or of the place."""
    return mesh.local_edge if rng.random() < 0.5 else np.full(mesh.n_vertices, mesh.mean_edge)


def _standard(field: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return a field with mean square 1."""
    return field / max(float(np.sqrt((field * field).mean())), 1e-12)


def _along_normals(mesh: SampleMesh, heights: NDArray[np.float64]) -> NDArray[np.float64]:
    return mesh.vertices + mesh.vertex_normals * heights[:, None]


def _wide(mesh: SampleMesh, rng: np.random.Generator, n_averages: int) -> NDArray[np.float64]:
    """Return white noise that is averaged with the ring, of mean square 1, shape (N,)."""
    return _standard(mesh.averaged(rng.normal(size=mesh.n_vertices), n_averages))


def white(mesh: SampleMesh, rng: np.random.Generator) -> NDArray[np.float64]:
    """Gaussian along the normals."""
    sigma = log_uniform(rng, 0.02, 1.1)
    return _along_normals(mesh, sigma * _unit(mesh, rng) * rng.normal(size=mesh.n_vertices))


def directions(mesh: SampleMesh, rng: np.random.Generator) -> NDArray[np.float64]:
    """Gaussian lengths in random directions, or Gaussian in all coordinates."""
    sigma = log_uniform(rng, 0.03, 0.6)
    step = rng.normal(size=(mesh.n_vertices, 3))
    if rng.random() < 0.6:
        step *= (rng.normal(size=mesh.n_vertices) / np.linalg.norm(step, axis=1))[:, None]
    else:
        sigma *= 0.6
    return mesh.vertices + sigma * _unit(mesh, rng)[:, None] * step


def correlated(mesh: SampleMesh, rng: np.random.Generator) -> NDArray[np.float64]:
    """Smooth over 1 to 12 rings, most of it over few; half of it together with white noise."""
    n_averages = round(log_uniform(rng, 1, 60 if rng.random() < 0.4 else 6))
    sigma = log_uniform(rng, 0.06, 0.4) * min(1.0 + 0.03 * n_averages, 2.0)
    heights = sigma * _wide(mesh, rng, n_averages)
    if rng.random() < 0.5:
        heights += log_uniform(rng, 0.02, 0.3) * rng.normal(size=mesh.n_vertices)
    return _along_normals(mesh, heights * _unit(mesh, rng))


def uneven(mesh: SampleMesh, rng: np.random.Generator) -> NDArray[np.float64]:
    """White noise whose strength varies, smoothly or in steps."""
    return _along_normals(mesh, _level(mesh, rng) * rng.normal(size=mesh.n_vertices))


def uneven_wide(mesh: SampleMesh, rng: np.random.Generator) -> NDArray[np.float64]:
    """Somewhat smooth noise whose strength varies, smoothly or in steps."""
    return _along_normals(mesh, _level(mesh, rng) * _wide(mesh, rng, int(rng.integers(1, 12))))


def _level(mesh: SampleMesh, rng: np.random.Generator) -> NDArray[np.float64]:
    """Return a strength that varies, shape (N,)."""
    place = mesh.direction(rng)
    if rng.random() < 0.4:
        low = 0.0 if rng.random() < 0.5 else log_uniform(rng, 0.02, 0.2)
        level = np.where(place > rng.uniform(-0.6, 0.6), log_uniform(rng, 0.08, 0.8), low)
    else:
        wave = np.sin(rng.uniform(1, 6) * place + rng.uniform(0, 6.3)) * rng.uniform(0.5, 2.0)
        level = log_uniform(rng, 0.05, 0.4) * np.exp(wave)
    return level * _unit(mesh, rng)


def impulsive(mesh: SampleMesh, rng: np.random.Generator) -> NDArray[np.float64]:
    """Noise at some of the vertices only."""
    is_hit = rng.random(mesh.n_vertices) < log_uniform(rng, 0.01, 0.65)
    sigma = log_uniform(rng, 0.1, 1.2)
    step = rng.normal(size=mesh.n_vertices) * sigma * is_hit * _unit(mesh, rng)
    if rng.random() < 0.75:
        return _along_normals(mesh, step)
    direction = rng.normal(size=(mesh.n_vertices, 3))
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    return mesh.vertices + step[:, None] * direction


def spikes(mesh: SampleMesh, rng: np.random.Generator) -> NDArray[np.float64]:
    """A few vertices far off, on a surface that is clean or a little noisy."""
    is_hit = rng.random(mesh.n_vertices) < log_uniform(rng, 5e-4, 0.02)
    height = rng.uniform(2, 12, mesh.n_vertices) * rng.choice([-1, 1], mesh.n_vertices) * is_hit
    if rng.random() < 0.6:
        height += log_uniform(rng, 0.02, 0.3) * rng.normal(size=mesh.n_vertices)
    return _along_normals(mesh, height * mesh.local_edge)


def quantized(mesh: SampleMesh, rng: np.random.Generator) -> NDArray[np.float64]:
    """Coordinates in whole steps, along one axis (terraces) or all of them, with a little noise or none."""
    step = log_uniform(rng, 0.15, 1.6) * mesh.mean_edge
    positions = mesh.vertices + mesh.offset(rng) * step
    if rng.random() < 0.4:
        grain = log_uniform(rng, 0.02, 0.15) * mesh.mean_edge * rng.normal(size=mesh.n_vertices)
        positions = positions + mesh.vertex_normals * grain[:, None]
    axes = rng.random() < 0.35
    # Heights of a terrain, or any axis.
    turned = positions @ (turn := mesh.principal_axes() if rng.random() < 0.5 else mesh.rotation(rng))
    chosen = slice(None) if axes else slice(2, 3)
    turned[:, chosen] = np.round(turned[:, chosen] / step) * step
    return turned @ turn.T - mesh.last_offset * step


def voxels(mesh: SampleMesh, rng: np.random.Generator) -> NDArray[np.float64]:
    """Steps and noise of the volume that the mesh was extracted from, with a little noise or none."""
    assert mesh.voxels is not None
    positions = mesh.voxels
    if rng.random() < 0.3:
        grain = log_uniform(rng, 0.02, 0.2) * mesh.mean_edge * rng.normal(size=mesh.n_vertices)
        positions = positions + mesh.vertex_normals * grain[:, None]
    return positions


def range_image(mesh: SampleMesh, rng: np.random.Generator) -> NDArray[np.float64]:
    """Errors along the line of sight: partly smooth, larger at grazing angles, sometimes in whole steps."""
    view = mesh.rotation(rng)[:, 0] if mesh.sight is None else mesh.sight
    grazing = 1.0 / np.maximum(np.abs(mesh.vertex_normals @ view), 0.2)
    share = rng.uniform(0, 1)
    wide, reach = _sensed(mesh, rng)
    grain = share * wide + np.sqrt(1 - share**2) * rng.normal(size=mesh.n_vertices)
    sigma = log_uniform(rng, 0.03, 0.25) * mesh.mean_edge * (1 + 0.3 * share * reach)
    depth = mesh.vertices @ view
    found = depth + sigma * grazing ** rng.uniform(0, 1) * grain
    if rng.random() < 0.4:
        step = log_uniform(rng, 0.3, 2.0) * sigma
        found = np.round(found / step) * step
    return mesh.vertices + (found - depth)[:, None] * view


def _sensed(mesh: SampleMesh, rng: np.random.Generator) -> tuple[NDArray[np.float64], float]:
    """Return smooth noise of mean square 1, shape (N,), and over how many pixels it is smooth.

    On a sensor's grid each direction has its own reach: where a laser sweeps, stripes differ from each other.
    """
    if mesh.pixels is None:
        n_averages = int(rng.integers(1, 12))
        return _wide(mesh, rng, n_averages), float(np.sqrt(n_averages / 2))
    reach = np.array([log_uniform(rng, 0.3, 4), log_uniform(rng, 0.3, 4)])
    if rng.random() < 0.4:
        reach[:] = reach[0]
    image = gaussian_filter(rng.normal(size=mesh.pixels.max(axis=0) + 1), reach)
    return _standard(image[tuple(mesh.pixels.T)]), float(np.sqrt(reach.prod()))


def none(mesh: SampleMesh, rng: np.random.Generator) -> NDArray[np.float64]:
    """No noise, or too little to see."""
    sigma = 0.0 if rng.random() < 0.5 else log_uniform(rng, 0.003, 0.03)
    return _along_normals(mesh, sigma * mesh.mean_edge * rng.normal(size=mesh.n_vertices))


MIXTURES: dict[str, dict[Draw, float]] = {
    "fine": {
        white: 0.36,
        directions: 0.11,
        correlated: 0.03,
        uneven: 0.14,
        impulsive: 0.14,
        spikes: 0.04,
        quantized: 0.02,
        voxels: 0.05,
        range_image: 0.06,
        none: 0.08,
    },
    "wide": {
        white: 0.06,
        directions: 0.01,
        correlated: 0.42,
        uneven_wide: 0.07,
        impulsive: 0.01,
        spikes: 0.01,
        quantized: 0.13,
        voxels: 0.12,
        range_image: 0.2,
        none: 0.03,
    },
}
"""How often each kind is drawn for each net; voxels on meshes that have them. A little of the other's, as the
choice between the two may err."""

SEEN = 6
"""How much more often range images have the noise of range images."""


def draw(mesh: SampleMesh, rng: np.random.Generator, width: str) -> tuple[NDArray[np.float64], str]:
    """Return noisy positions (N, 3) as for the net "fine" or "wide", and the name of the kind of noise."""
    kinds = list(MIXTURES[width])
    shares = np.array(list(MIXTURES[width].values()))
    if mesh.voxels is None:
        shares[kinds.index(voxels)] = 0
    if mesh.pixels is not None:
        shares[kinds.index(range_image)] *= SEEN
    kind = kinds[rng.choice(len(kinds), p=shares / shares.sum())]
    return kind(mesh, rng), kind.__name__
