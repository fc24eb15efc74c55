# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The outside of cells of a grid, in quads: cages, thin bars, bodies that were cut into cells."""

from __future__ import annotations

import numpy as np

from .mesh import Mesh, area, condition, from_faces, half_edges, largest_island
from .noise import chance
from .organic import bend, project, smooth_body


def outside(full) -> Mesh:
    """Return the quads between full and empty cells of a grid, bool (A, B, C), that is empty all around."""
    quads = []
    for axis in range(3):
        one, two = np.roll(np.eye(3, dtype=int), -axis, axis=0)[1:]
        before, after = (np.moveaxis(full, axis, 0)[part] for part in (slice(None, -1), slice(1, None)))
        for is_wall, ring in (
            (before & ~after, (0 * one, one, one + two, two)),
            (after & ~before, (0 * one, two, one + two, one)),
        ):
            cell = np.moveaxis(np.argwhere(is_wall), 1, 0)
            place = np.empty((cell.shape[1], 3), int)
            place[:, axis] = cell[0] + 1
            place[:, [other for other in range(3) if other != axis]] = cell[1:].T
            quads.append(place[:, None] + np.array(ring))
    corners = np.concatenate(quads).reshape(-1, 3)
    points, number = np.unique(corners, axis=0, return_inverse=True)
    return from_faces(points, number.reshape(-1, 4))


def is_sound(mesh: Mesh) -> bool:
    """Return whether no two cells met in an edge or a corner only."""
    return condition(mesh)[1:] == (0, 0, 0)


def cage(rng) -> Mesh:
    """Make a blocky cage: a few cubes of a grid."""
    shape = rng.integers(2, 5, 3)
    full = np.zeros(shape + 2, bool)
    place = shape // 2
    for _ in range(rng.integers(3, 14)):
        full[tuple(place + 1)] = True
        axis = rng.integers(3)
        place = place.copy()
        place[axis] = np.clip(place[axis] + rng.choice([-1, 1]), 0, shape[axis] - 1)
    mesh = outside(full)
    if not is_sound(mesh):
        return cage(rng)
    points = mesh.vertices + rng.normal(size=mesh.vertices.shape) * rng.uniform(0, 0.22)
    return mesh.moved(points * rng.uniform(0.6, 1.4, 3))


def make_bars(rng, target: int) -> Mesh:
    """Make a frame of straight bars: a quad or two across each side, and right angles between the sides."""
    across = int(rng.integers(1, 3)) if chance(rng, 0.4) else 1
    pitch, nodes = int(rng.integers(3, 9)), rng.integers(2, 6, 3)
    full = np.zeros(pitch * (nodes - 1) + 3, bool)
    node = rng.integers(nodes)
    for _ in range(200):
        axis, step = rng.integers(3), rng.choice([-1, 1])
        following = node.copy()
        following[axis] = np.clip(node[axis] + step, 0, nodes[axis] - 1)
        low, high = np.minimum(node, following) * pitch + 1, np.maximum(node, following) * pitch + 1
        full[tuple(slice(a, b + 1) for a, b in zip(low, high, strict=True))] = True
        node = following
        if 4 * full.sum() * across**2 > target:
            break
    for axis in range(3):
        full = np.repeat(full, across, axis=axis)
    mesh = outside(full)
    return bend(rng, mesh.moved(mesh.vertices * rng.uniform(0.6, 1.5, 3)), rng.uniform(0.0, 0.1))


def make_hexes(rng, target: int) -> Mesh:
    """Make the surface of a body of hexahedra: rows of quads that follow the grid, not the shape."""
    smooth, field = smooth_body(rng, 2000)
    low, high = field.bounds()
    # The outside of cells has half as much area again as the surface.
    step = float(np.sqrt(1.5 * area(smooth) / target))
    count = np.ceil((high - low) / step).astype(int) + 4
    grid = np.stack(np.meshgrid(*map(np.arange, count), indexing="ij"), -1)
    full = (field(((grid - 1.5) * step + low).reshape(-1, 3)) < 0).reshape(count)
    full[[0, -1]] = full[:, [0, -1]] = full[:, :, [0, -1]] = False
    mesh = largest_island(outside(full))
    mesh = mesh.moved((mesh.vertices - 2) * step + low)
    start, end, _ = half_edges(mesh)
    valence = np.bincount(start, minlength=len(mesh.vertices))
    points = mesh.vertices
    for _ in range(rng.integers(3, 12)):
        around = [np.bincount(start, points[end, axis], len(points)) / valence for axis in range(3)]
        points = 0.5 * (points + np.stack(around, axis=1))
    return project(field, mesh.moved(points), int(rng.integers(0, 4)))
