# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Detail along the normals: what a sculptor or a scanned skin adds to a smooth body."""

from __future__ import annotations

import numpy as np

from .mesh import Mesh, mean_edge, vertex_normals
from .noise import Noise, cells, chance, log_uniform, octaves, random_rotation, smooth_step, warped


def _bumps(rng, points, wave):
    return octaves(rng, points, wave, rng.integers(1, 5), rng.uniform(0.4, 0.8))


def _ridges(rng, points, wave):
    return octaves(rng, points, wave, rng.integers(1, 4), 0.5, is_ridged=True)


def _wrinkles(rng, points, wave):
    # Long in one direction, bent by a slower warp.
    stretch = np.diag([1.0, 1.0, rng.uniform(0.15, 0.5)]) @ random_rotation(rng)
    bent = warped(rng, points, wave * rng.uniform(3, 10), rng.uniform(0.05, 0.3))
    value = Noise(rng)(bent @ stretch.T * (1.6 / wave))
    return -np.exp(-((value / rng.uniform(0.1, 0.3)) ** 2)) if chance(rng, 0.5) else 1 - 2 * np.abs(value)


def _grooves(rng, points, wave):
    # Hair and combed fur: lines of equal phase of a warped field.
    bent = warped(rng, points, wave * rng.uniform(4, 16), rng.uniform(0.05, 0.35))
    phase = bent @ random_rotation(rng)[0] * (2 * np.pi / wave)
    phase = phase + rng.uniform(0, 2) * Noise(rng)(points * (0.8 / wave))
    kind = rng.integers(3)
    if kind == 0:
        return np.sin(phase)
    if kind == 1:
        return 2 * np.abs(np.sin(phase / 2)) - 1
    return np.tanh(rng.uniform(1.5, 5) * np.sin(phase))


def _scales(rng, points, wave):
    near, second, _ = cells(rng, points, wave, rng.uniform(0.2, 1))
    if chance(rng, 0.5):
        return 1 - 2 * near**2
    return 2 * np.minimum((second - near) / rng.uniform(0.1, 0.5), 1) - 1


def _plates(rng, points, wave):
    # Flat scales of random heights: short steps between smooth parts.
    near, second, seed = cells(rng, points, wave, rng.uniform(0.3, 1))
    height = rng.uniform(-1, 1, seed.max() + 1)[seed]
    return height * smooth_step(second - near - 0.06, 0.12)


def _pores(rng, points, wave):
    near, _, seed = cells(rng, points, wave, 0.7)
    size = rng.uniform(0.1, 0.35, seed.max() + 1)[seed]
    sign = -1 if chance(rng, 0.6) else 1
    return sign * 2 * smooth_step(size - near, rng.uniform(0.08, 0.3))


def _folds(rng, points, wave):
    # Cloth: soft crests that run down and end.
    stretch = np.diag([1.0, 1.0, rng.uniform(0.1, 0.4)]) @ random_rotation(rng)
    bent = warped(rng, points, wave * 3, rng.uniform(0.05, 0.2))
    value = Noise(rng)(bent @ stretch.T * (1.3 / wave))
    return 1.5 * np.abs(value) ** rng.uniform(0.7, 1.6) - 0.5


def _terraces(rng, points, wave):
    height = octaves(rng, points, wave * 2, 2) * rng.uniform(1, 3)
    level = np.floor(height)
    return level + smooth_step(height - level - 0.5, rng.uniform(0.05, 0.6)) - height * rng.uniform(0, 1)


def _stamps(rng, points, wave):
    # Buttons, rims, eyes, letters of a seal: a few round marks with short edges.
    value = np.zeros(len(points))
    for _ in range(rng.integers(2, 14)):
        distance = np.linalg.norm(points - points[rng.integers(len(points))], axis=1) / wave
        size = rng.uniform(0.4, 1.6)
        width = rng.uniform(0.05, 0.4)
        mark = smooth_step(size - distance, width)
        if chance(rng, 0.5):
            mark -= rng.uniform(0.5, 1.6) * smooth_step(size * rng.uniform(0.3, 0.85) - distance, width)
        value += rng.choice([-1, 1]) * mark
    return value


LAYERS = {
    _bumps: 3.0,
    _ridges: 2.0,
    _wrinkles: 2.0,
    _grooves: 2.0,
    _scales: 1.5,
    _plates: 0.8,
    _pores: 1.2,
    _folds: 1.5,
    _terraces: 0.6,
    _stamps: 1.5,
}
"""Kinds of relief, with how often they are drawn."""


def heights(rng, points, edge: float, n_layers: int, shortest: float = 3.0, longest: float = 60.0):
    """Sum random layers of relief at points.

    Parameters
    ----------
    rng : numpy.random.Generator
    points : (N, 3) array
    edge : float
        Mean edge; wavelengths are multiples of it.
    n_layers : int
    shortest, longest : float
        Wavelengths, in edges.

    Returns
    -------
    (N,) array
        Heights, in the unit of the points.
    """
    total = np.zeros(len(points))
    kinds = list(LAYERS)
    weights = np.array(list(LAYERS.values()))
    for _ in range(n_layers):
        layer = kinds[rng.choice(len(kinds), p=weights / weights.sum())]
        wave = log_uniform(rng, shortest, longest)
        slope = log_uniform(rng, 0.12, 1.3)
        value = layer(rng, points, wave * edge) * slope * wave / (2 * np.pi)
        if chance(rng, 0.55):
            # Only here and there, so that smooth and rich parts are neighbors.
            mask = Noise(rng)(points / (edge * log_uniform(rng, 12, 60)))
            value = value * smooth_step(mask - rng.uniform(-0.3, 0.3), log_uniform(rng, 0.02, 0.6))
        total += value * edge
    return total


def with_relief(rng, mesh: Mesh, n_layers: int | None = None, shortest: float = 3.0, room=np.inf) -> Mesh:
    """Displace a mesh along its normals by random relief, nowhere by more than ``room``."""
    if n_layers is None:
        n_layers = int(rng.integers(1, 6))
    edge = mean_edge(mesh)
    height = heights(rng, mesh.vertices, edge, n_layers, shortest)
    size = np.ptp(mesh.vertices, axis=0).max()
    # Relief as deep as a limb is thick would turn it inside out.
    most = np.minimum(0.05 * size, room)
    height = most * np.tanh(height / most)
    return mesh.moved(mesh.vertices + height[:, None] * vertex_normals(mesh))
