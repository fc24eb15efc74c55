# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Height fields: mountains, lakes, terraces, buildings."""

from __future__ import annotations

import numpy as np
from scipy.spatial import Delaunay

from .mesh import Mesh, from_faces
from .noise import Noise, chance, log_uniform, octaves, smooth_step, warped
from .sweeps import grid_faces, grid_style


def _heights(rng, plane, edge: float):
    """Draw heights at points of the plane (N, 2), of a terrain about 2 wide."""
    points = np.column_stack([plane, np.zeros(len(plane))])
    if chance(rng, 0.4):
        points = warped(rng, points, rng.uniform(0.4, 1), rng.uniform(0.05, 0.3)) * [1, 1, 0]
    wave = rng.uniform(0.4, 1.8)
    # Octaves end where they would be shorter than a few edges.
    most = max(1, int(np.log(wave / (3 * edge)) / np.log(1.93)))
    n = int(rng.integers(1, most + 1))
    is_ridged = chance(rng, 0.55)
    height = octaves(rng, points, wave, n, rng.uniform(0.3, 0.55), is_ridged) * log_uniform(rng, 0.06, 0.4)
    span = float(np.ptp(height)) + 1e-9
    if chance(rng, 0.4):
        # Terraces, smooth or with sharp rims.
        step = span / rng.integers(3, 9)
        level = np.floor(height / step)
        rise = smooth_step(height / step - level - 0.5, rng.uniform(0.05, 0.8))
        where = smooth_step(Noise(rng)(points * 2.0) + rng.uniform(-0.3, 0.5), 0.3)
        height = height + where * ((level + rise) * step - height)
    if chance(rng, 0.4):
        # A lake is exactly flat.
        height = np.maximum(height, np.quantile(height, rng.uniform(0.1, 0.5)))
    if chance(rng, 0.2):
        height = np.minimum(height, np.quantile(height, rng.uniform(0.6, 0.95)))
    if chance(rng, 0.4):
        for _ in range(rng.integers(2, 30)):
            center = rng.uniform(-0.9, 0.9, 2)
            angle = rng.choice([0, rng.uniform(0, np.pi)])
            local = (plane - center) @ np.array(
                [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
            )
            half = rng.uniform(0.03, 0.14, 2)
            inside = (np.abs(local) < half).all(1)
            if inside.any():
                roof = height[inside].mean() + log_uniform(rng, 0.5 * edge, 6 * edge)
                slope = rng.choice([0, rng.uniform(0.2, 1)])
                height[inside] = roof + slope * (half[0] - np.abs(local[inside, 0]))
    if chance(rng, 0.3):
        # A road or a ditch cuts through.
        line = plane @ [1, rng.normal()] + 0.15 * Noise(rng)(points * 1.5) - rng.uniform(-0.5, 0.5)
        inside = smooth_step(rng.uniform(0.03, 0.1) - np.abs(line), log_uniform(rng, 0.5, 4) * edge)
        height = height + inside * (np.quantile(height, rng.uniform(0.2, 0.7)) - height) * rng.uniform(0.3, 1)
    return height


def make_terrain(rng, target: int) -> Mesh:
    """Make a terrain on a grid or on irregular points."""
    side = max(20, int(np.sqrt(target / 2)))
    edge = 2 / side
    kind = rng.choice(3, p=[0.35, 0.25, 0.4])
    if kind < 2:
        ratio = log_uniform(rng, 0.6, 1.6)
        n_u, n_v = int(side * ratio), int(side / ratio)
        style = grid_style(rng, 0.2 if kind == 0 else 0.1)
        if style == "quads":
            n_u, n_v = int(n_u * 1.35), int(n_v * 1.35)
        u, v = np.meshgrid(
            np.linspace(-ratio, ratio, n_u), np.linspace(-1 / ratio, 1 / ratio, n_v), indexing="ij"
        )
        plane = np.stack([u, v], -1)
        if kind == 1:
            jitter = rng.uniform(0.1, 0.35) * 2 * ratio / n_u
            plane[1:-1, 1:-1] += rng.uniform(-jitter, jitter, plane[1:-1, 1:-1].shape)
        plane = plane.reshape(-1, 2)
        faces = grid_faces(rng, n_u, n_v, False, False, style)
    else:
        n = target // 2
        plane = rng.uniform(-1, 1, (3 * n, 2))
        if chance(rng, 0.5):
            # Denser where a noise is high, as in a scan with many stations.
            weight = 0.15 + smooth_step(Noise(rng)(np.column_stack([plane, 0 * plane[:, 0]]) * 1.5), 1.0)
        else:
            weight = np.ones(len(plane))
        plane = plane[rng.random(len(plane)) < weight / weight.max()][:n]
        # Points that nearly coincide make needles: drop the closer ones.
        from scipy.spatial import cKDTree

        pairs = cKDTree(plane).query_pairs(rng.uniform(0.1, 0.6) * edge, output_type="ndarray")
        keep = np.ones(len(plane), bool)
        keep[pairs[:, 1]] = False
        plane = plane[keep]
        rim = np.linspace(-1, 1, side // 2)
        rim = np.concatenate([np.stack([rim, s + 0 * rim], 1) for s in (-1, 1)])
        plane = np.unique(np.concatenate([plane, rim, rim[1:-1, ::-1]]), axis=0)
        triangulation = Delaunay(plane)
        faces = triangulation.simplices
        a, b, c = (plane[faces[:, k]] for k in range(3))
        twice = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
        faces = np.where((twice < 0)[:, None], faces[:, ::-1], faces)[np.abs(twice) > 1e-6 * edge**2]
        used, faces = np.unique(faces, return_inverse=True)
        plane, faces = plane[used], faces.reshape(-1, 3)
    height = _heights(rng, plane, edge)
    return from_faces(np.column_stack([plane, height]), faces)
