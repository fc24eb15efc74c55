# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces of marching cubes as they come, with the slivers of a uniform grid."""

from __future__ import annotations

import numpy as np

from .mesh import Mesh, largest_island
from .noise import Noise, chance, log_uniform, random_rotation
from .organic import project, random_field, surface_of


def _piece(rng):
    """Draw the exact distance function of a simple solid."""
    center, turn = rng.uniform(-0.5, 0.5, 3), random_rotation(rng)
    kind = rng.integers(4)
    half = rng.uniform(0.15, 0.6, 3)
    rounding = rng.choice([0.0, rng.uniform(0.02, 0.15)])

    def distance(points):
        local = (points - center.astype(points.dtype)) @ turn.astype(points.dtype)
        if kind == 0:
            return np.sqrt((local**2).sum(1)) - half[0] * 1.2
        if kind == 1:
            away = np.abs(local) - half.astype(points.dtype)
            return np.sqrt((np.maximum(away, 0) ** 2).sum(1)) + np.minimum(away.max(1), 0) - rounding
        around = np.hypot(local[:, 0], local[:, 1])
        if kind == 2:
            away = np.stack([around - half[0], np.abs(local[:, 2]) - 1.5 * half[1]], 1)
            return np.sqrt((np.maximum(away, 0) ** 2).sum(1)) + np.minimum(away.max(1), 0) - rounding
        return np.hypot(around - 0.3 - half[0], local[:, 2]) - 0.35 * half[1] - 0.04

    return distance


def _solid(rng):
    """Unite, cut and hollow exact distances: edges come out beveled by the grid."""
    pieces = [_piece(rng) for _ in range(rng.integers(1, 8))]
    ways = rng.choice(3, len(pieces), p=[0.5, 0.35, 0.15])

    def field(points):
        value = pieces[0](points)
        for piece, way in zip(pieces[1:], ways[1:], strict=True):
            other = piece(points)
            if way == 0:
                value = np.minimum(value, other)
            elif way == 1:
                value = np.maximum(value, -other)
            else:
                value = np.maximum(value, other - 0.4)
        return value

    return field


def _lattice(rng):
    """Intersect a triply periodic surface, solid or as a wall, with a ball or a box."""
    wave = rng.uniform(2.5, 6.5)
    turn = random_rotation(rng)
    kind = rng.integers(3)
    level, is_wall = rng.uniform(-0.6, 0.6), chance(rng, 0.5)
    thick = rng.uniform(0.25, 0.6)
    hull = _piece(rng) if chance(rng, 0.3) else lambda points: np.sqrt((points**2).sum(1)) - 0.9

    def field(points):
        x, y, z = ((points @ turn.astype(points.dtype)) * wave).T
        if kind == 0:
            value = np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)
        elif kind == 1:
            value = np.cos(x) + np.cos(y) + np.cos(z)
        else:
            value = np.cos(x) * np.cos(y) * np.cos(z) - np.sin(x) * np.sin(y) * np.sin(z)
        value = (np.abs(value) - thick if is_wall else value - level) / wave
        return np.maximum(value, hull(points))

    return field


def _body(rng):
    """Take a creature, with or without noise in its field."""
    body = random_field(rng)
    low, high = body.bounds()
    middle, size = (low + high) / 2, float((high - low).max()) / 2
    noise = Noise(rng)
    strength = rng.choice([0.0, log_uniform(rng, 0.01, 0.06)])
    wave = log_uniform(rng, 2, 12)

    def field(points):
        value = body((points * size + middle).astype(points.dtype)) / size
        if strength:
            # Only near the surface: noise costs more than all limbs.
            near = np.abs(value) < 0.12
            value[near] += (strength * noise(points[near] * wave)).astype(value.dtype)
        return value

    return field


def make_marching(rng, target: int) -> Mesh:
    """Extract a random field at the resolution that gives the number of faces.

    Half of the volumes are not exact: they know inside and outside only, more or less, or are noisy. The
    clean vertices are those moved onto the exact field.
    """
    field = [_body, _solid, _lattice][rng.choice(3, p=[0.45, 0.35, 0.2])](rng)
    low, high = np.full(3, -1.35), np.full(3, 1.35)
    coarse = surface_of(field, low, high, 32)
    resolution = int(np.clip(32 * np.sqrt(target / coarse.n_faces), 24, 130))
    low = low + rng.uniform(0, 0.03, 3)
    if chance(rng, 0.5):
        return largest_island(surface_of(field, low, high, resolution))
    contrast = log_uniform(rng, 0.02, 1.5)
    level = rng.choice([0.0, log_uniform(rng, 0.05, 0.5)])

    def spoil(values, step):
        heights = np.clip(values / step, -contrast, contrast)
        return heights + min(level, 0.4 * contrast) * rng.normal(size=values.shape)

    mesh = largest_island(surface_of(field, low, high, resolution, spoil))
    return project(field, mesh, 8)._replace(noisy=mesh.vertices)
