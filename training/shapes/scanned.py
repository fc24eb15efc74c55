# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Range images: what a scanner sees of a shape from one side, on the grid of its sensor."""

from __future__ import annotations

import numpy as np

from .blender import to_data
from .mesh import Mesh, face_islands, from_faces, select_faces
from .noise import chance, log_uniform, random_rotation
from .organic import make_organic
from .parts import make_part
from .shells import make_shell
from .sweeps import make_sweep
from .terrain import make_terrain

STEEPEST = (3.0, 8.0)
"""A cell is empty where its corners are farther apart in depth, in spacings: another surface is behind."""


def depth_image(mesh: Mesh, shape: tuple[int, int], stretch: float):
    """Look along -z at a mesh; return the grid's spacings (2,) and depths, NaN where nothing is."""
    from bpy import data as blender
    from mathutils.bvhtree import BVHTree

    data = to_data(mesh)
    try:
        faces = [tuple(polygon.vertices) for polygon in data.polygons]
        tree = BVHTree.FromPolygons([tuple(point) for point in mesh.vertices], faces)
    finally:
        blender.meshes.remove(data)
    low, high = mesh.vertices.min(0), mesh.vertices.max(0)
    size = np.maximum((high - low)[:2], 1e-9)
    spacing = np.sqrt(size[0] * size[1] / (shape[0] * shape[1])) * np.array([stretch, 1 / stretch])
    count = np.maximum((size / spacing).astype(int), 2)
    depths = np.full(tuple(count), np.nan)
    start = high[2] + 1.0
    for i, j in np.ndindex(*depths.shape):
        place = low[:2] + (np.array([i, j]) + 0.5) * spacing
        found, _, _, distance = tree.ray_cast((place[0], place[1], start), (0, 0, -1))
        if found is not None:
            depths[i, j] = start - distance
    return spacing, depths


def _blurred(depths, n: int):
    """Return depths after n steps of averaging with the four neighbors that are near."""
    for _ in range(n):
        total, weight = depths.copy(), np.isfinite(depths).astype(float)
        for axis in (0, 1):
            for step in (-1, 1):
                other = np.roll(depths, step, axis)
                rim = [slice(None), slice(None)]
                rim[axis] = 0 if step == 1 else -1
                other[tuple(rim)] = np.nan
                is_near = np.isfinite(other)
                total[is_near] += 0.25 * other[is_near]
                weight[is_near] += 0.25
        depths = total / np.where(weight > 0, weight, np.nan)
    return depths


def make_scanned(rng, target: int) -> Mesh:
    """Make the range image of another shape, seen from a random side."""
    makers = [make_organic, make_part, make_sweep, make_shell, make_terrain]
    maker = makers[rng.choice(5, p=[0.45, 0.2, 0.2, 0.1, 0.05])]
    seen = maker(rng, int(log_uniform(rng, 3000, 16000)))
    if maker is not make_terrain:
        seen = seen.moved(seen.vertices @ random_rotation(rng).T)
    size = np.ptp(seen.vertices, axis=0)
    filled = 0.6 * size[0] * size[1]
    n = int(target / 2 / max(0.3, filled / (size[0] * size[1])))
    ratio = size[0] / max(size[1], 1e-9)
    columns = max(20, int(np.sqrt(n * ratio)))
    spacing, depths = depth_image(seen, (columns, max(20, n // columns)), log_uniform(rng, 0.75, 1.33))
    # Optics and spot size: no sensor resolves single cells of its grid.
    depths = _blurred(depths, round(log_uniform(rng, 2, 16)))
    i, j = np.meshgrid(*(np.arange(n) for n in depths.shape), indexing="ij")
    points = np.column_stack([i.ravel() * spacing[0], j.ravel() * spacing[1], np.nan_to_num(depths).ravel()])
    number = np.arange(depths.size).reshape(depths.shape)
    a, b, c, d = number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]
    z = depths.ravel()
    # The shorter diagonal, as scanners' programs choose it, or always the same.
    is_first = np.abs(z[a] - z[c]) <= np.abs(z[b] - z[d]) if chance(rng, 0.6) else np.ones(a.shape, bool)
    first = np.where(is_first[..., None], np.stack([a, b, c], -1), np.stack([a, b, d], -1))
    second = np.where(is_first[..., None], np.stack([a, c, d], -1), np.stack([b, c, d], -1))
    faces = np.concatenate([first.reshape(-1, 3), second.reshape(-1, 3)])
    span = np.ptp(z[faces], axis=1)
    steepest = log_uniform(rng, *STEEPEST) * spacing.mean()
    mesh = from_faces(points, faces[np.isfinite(span) & (np.nan_to_num(span) < steepest)])
    label = face_islands(mesh)
    size_of = np.bincount(label)
    mesh = _manifold(select_faces(mesh, size_of[label] > 0.02 * mesh.n_faces))
    grid = np.array([[1 / spacing[0], 0, 0], [0, 1 / spacing[1], 0], [0, 0, 1]])
    return mesh._replace(grid=grid)


def _manifold(mesh: Mesh) -> Mesh:
    """Give each fan of faces at a vertex a vertex of its own, where more than one meet."""
    faces = mesh.corner_vertex.reshape(-1, 3)
    corner = np.arange(len(mesh.corner_vertex)).reshape(-1, 3)
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    # Corners at the same vertex belong together if their faces share an edge there.
    sides = [(0, 1), (1, 2), (2, 0)]
    ends = np.concatenate([np.sort(faces[:, side], axis=1) for side in sides])
    own = np.concatenate(
        [np.take_along_axis(corner[:, side], np.argsort(faces[:, side], axis=1), 1) for side in sides]
    )
    order = np.lexsort(ends.T)
    ends, own = ends[order], own[order]
    is_same = (ends[1:] == ends[:-1]).all(1)
    left, right = own[:-1][is_same].ravel(), own[1:][is_same].ravel()
    n = len(mesh.corner_vertex)
    graph = coo_matrix((np.ones(len(left), bool), (left, right)), (n, n))
    _, fan = connected_components(graph, directed=False)
    _, first = np.unique(fan, return_index=True)
    return Mesh(mesh.vertices[mesh.corner_vertex[first]], mesh.face_offset, fan.astype(np.int32))
