# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Random functions of space, the raw material of relief and terrain."""

from __future__ import annotations

import numpy as np


def log_uniform(rng, low: float, high: float) -> float:
    """Draw a number whose logarithm is uniform; ``low`` itself when it is above ``high``."""
    return float(np.exp(rng.uniform(np.log(low), np.log(max(low, high)))))


def chance(rng, probability: float) -> bool:
    """Return true with this probability."""
    return bool(rng.random() < probability)


def random_rotation(rng):
    """Draw a rotation matrix, all equally likely."""
    q = rng.normal(size=4)
    w, x, y, z = q / np.linalg.norm(q)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


class Noise:
    """Gradient noise in space: smooth, about -1 to 1, with hills of about one unit."""

    def __init__(self, rng):
        self._table = rng.permutation(512)
        gradient = rng.normal(size=(512, 3))
        self._gradient = gradient / np.linalg.norm(gradient, axis=1, keepdims=True)
        self._shift = rng.uniform(0, 100, 3)

    def __call__(self, points):
        """Evaluate at points (N, 3)."""
        points = points + self._shift
        cell = np.floor(points).astype(int)
        part = points - cell
        fade = part**3 * (part * (part * 6 - 15) + 10)
        result = np.zeros(len(points))
        table = self._table
        for corner in np.ndindex(2, 2, 2):
            index = (cell + corner) & 511
            index = table[(table[(table[index[:, 0]] + index[:, 1]) & 511] + index[:, 2]) & 511]
            weight = np.prod(np.where(corner, fade, 1 - fade), axis=1)
            result += weight * np.einsum("ij,ij->i", self._gradient[index], part - corner)
        return result * 1.7


def octaves(rng, points, wavelength: float, n: int, gain: float = 0.5, is_ridged: bool = False):
    """Sum noise of halving wavelengths; ridged noise has sharp crests."""
    total = np.zeros(len(points))
    weight = 1.0
    crest = 1.0
    for _ in range(n):
        layer = Noise(rng)(points * (1.6 / wavelength))
        if is_ridged:
            layer = (1 - 2 * np.abs(layer)) * crest
            # Detail belongs on the crests, as in eroded mountains.
            crest = np.clip(layer + 0.5, 0, 1)
        total += weight * layer
        weight *= gain
        wavelength /= 1.93
    return total


def warped(rng, points, wavelength: float, strength: float):
    """Move points by smooth noise, so that patterns made on them flow."""
    shift = np.stack([Noise(rng)(points * (1.6 / wavelength)) for _ in range(3)], axis=1)
    return points + shift * strength * wavelength


def cells(rng, points, spacing: float, jitter: float = 1.0):
    """Distances to the nearest and the second nearest of irregular seeds, in spacings, and the seed."""
    from scipy.spatial import cKDTree

    # One seed in each box of a grid that the surface touches or that is next to one.
    box = np.unique(np.floor(points / spacing).astype(int), axis=0)
    around = np.stack(np.meshgrid(*[[-1, 0, 1]] * 3, indexing="ij"), -1).reshape(-1, 3)
    box = np.unique((box[:, None] + around).reshape(-1, 3), axis=0)
    seeds = (box + 0.5 + jitter * rng.uniform(-0.5, 0.5, box.shape)) * spacing
    distance, index = cKDTree(seeds).query(points, 2)
    return distance[:, 0] / spacing, distance[:, 1] / spacing, index[:, 0]


def smooth_step(x, width: float = 1.0):
    """Rise from 0 to 1 where x rises from -width / 2 to width / 2."""
    t = np.clip(np.asarray(x) / width + 0.5, 0, 1)
    return t * t * (3 - 2 * t)
