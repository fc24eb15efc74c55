# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The meshes of the speed benchmark, made in code and kept as files of arrays: a noisy torus of any size.

Either diagonal of each of its quads is as likely, so that three in five vertices are irregular.
"""

from dataclasses import fields
from pathlib import Path

import numpy as np

SIGMA = 0.2  # of the mean edge length, along the normals


def make_torus(n_vertices, is_shuffled, seed=0):
    """Return vertices (N, 3), float32, and triangles (F, 3) of a noisy torus of about as many vertices.

    Shuffled means that vertices and triangles are in random order, the worst for caches.
    """
    rows = int(1.4 * n_vertices**0.5)
    columns = n_vertices // rows
    u, v = (2.0 * np.pi * np.arange(n) / n for n in (rows, columns))
    u, v = (angle.ravel() for angle in np.meshgrid(u, v, indexing="ij"))
    normals = np.stack((np.cos(v) * np.cos(u), np.cos(v) * np.sin(u), np.sin(v)), axis=1)
    vertices = normals + 2.0 * np.stack((np.cos(u), np.sin(u), 0.0 * u), axis=1)
    number = np.arange(rows * columns).reshape(rows, columns)
    down, right = np.roll(number, -1, axis=0), np.roll(number, -1, axis=1)
    a, b, c, d = (part.ravel() for part in (number, down, np.roll(down, -1, axis=1), right))
    rng = np.random.default_rng(seed)
    is_other = rng.random(len(a)) < 0.5
    first = np.where(is_other, (a, b, c), (a, b, d)).T
    second = np.where(is_other, (a, c, d), (b, c, d)).T
    faces = np.stack((first, second), axis=1).reshape(-1, 3)
    edge = np.linalg.norm(vertices[faces[:, 0]] - vertices[faces[:, 1]], axis=1).mean()
    vertices += normals * rng.normal(0.0, SIGMA * edge, (len(vertices), 1))
    if is_shuffled:
        order = rng.permutation(len(vertices))
        number = np.empty_like(order)
        number[order] = np.arange(len(order))
        vertices, faces = vertices[order], rng.permutation(number[faces])
    return vertices.astype(np.float32), faces


def torus_file(folder: Path, n_vertices: int, is_shuffled: bool) -> Path:
    """Return the file of a torus, which is made first if it has to be."""
    path = folder / f"torus_{n_vertices}{'_shuffled' if is_shuffled else ''}.npz"
    if not path.is_file():
        from framelet.core import SurfaceMesh

        mesh = SurfaceMesh.from_faces(*make_torus(n_vertices, is_shuffled))
        folder.mkdir(parents=True, exist_ok=True)
        np.savez(path, **{item.name: getattr(mesh, item.name) for item in fields(SurfaceMesh)})
    return path


def read_mesh(path):
    """Return the mesh of a file as a SurfaceMesh."""
    from framelet.core import SurfaceMesh

    with np.load(path) as arrays:
        return SurfaceMesh(**{name: arrays[name] for name in arrays.files})
