# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A clean mesh for training, with what noise and net need to know of it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from core.blocks import Blocks
from core.learned.engine import FaceEngine
from core.mesh.connectivity import connect
from core.mesh.geometry import face_area_vectors, mean_edge_length, unit_vectors, vertex_normals
from core.mesh.surface_mesh import SurfaceMesh

FACES_IN_CLUSTER = 700
"""Faces of a cluster: the loss is a mean of logarithms over clusters, so that each place counts alike."""


class SampleMesh:
    """A clean mesh in mean edge lengths, around its center.

    `voxels`, shape (N, 3), are its positions with the errors of the volume that it comes from, or None.
    `pixels`, shape (N, 2), are whole numbers: where the vertices of a range image lie on the sensor, or None;
    `sight` is its line of sight.
    """

    def __init__(
        self,
        surface: SurfaceMesh,
        voxels: NDArray[np.floating] | None = None,
        grid: NDArray[np.floating] | None = None,
    ) -> None:
        edge = mean_edge_length(surface)
        center = surface.vertices.mean(axis=0, dtype=np.float64)
        self.vertices = (surface.vertices - center) / edge
        self.surface = surface.with_vertices(self.vertices)
        self.voxels = None if voxels is None else (voxels - center) / edge
        self.pixels, self.sight = None, None
        if grid is not None:
            counted = surface.vertices @ grid[:2].T
            self.pixels = np.round(counted - counted.min(axis=0)).astype(np.int64)
            self.sight = grid[2]
        self.connectivity = connect(self.surface)
        self.engine = FaceEngine(self.surface, self.connectivity, Blocks(1))
        self.mean_edge = 1.0
        self.vertex_normals = vertex_normals(self.surface)
        steps = self.vertices[self.surface.edges[:, 0]] - self.vertices[self.surface.edges[:, 1]]
        length = np.repeat(np.linalg.norm(steps, axis=1), 2)
        ends = self.surface.edges.ravel()
        total = np.bincount(ends, length, self.n_vertices)
        self.local_edge = total / np.maximum(np.bincount(ends, minlength=self.n_vertices), 1)
        for _ in range(3):
            self.local_edge = self.averaged(self.local_edge, 1)
        areas = face_area_vectors(self.surface)
        graph = self.engine.graph
        self.normals = graph.in_graph_order(unit_vectors(areas).T).astype(np.float32)
        size = np.linalg.norm(areas, axis=1)
        self.is_counted = graph.in_graph_order(size > 1e-3 * np.median(size))
        middle = (
            np.add.reduceat(self.vertices[self.surface.corner_vertex], self.surface.face_offset[:-1], axis=0)
            / self.surface.face_sizes()[:, None]
        )
        self._centroids = graph.in_graph_order(middle.T).T
        self.last_offset = np.zeros(3)

    @classmethod
    def load(cls, path: Path) -> SampleMesh:
        """Read a mesh from a file of `training.shapes`."""
        with np.load(path) as file:
            offset, corners = file["face_offset"], file["corner_vertex"]
            faces = (
                corners.reshape(-1, int(offset[1]))
                if (np.diff(offset) == offset[1]).all()
                else np.split(corners, offset[1:-1])
            )
            voxels = file["noisy"].astype(np.float64) if "noisy" in file else None
            grid = file.get("grid")
            return cls(SurfaceMesh.from_faces(file["vertices"].astype(np.float64), faces), voxels, grid)

    @property
    def n_vertices(self) -> int:
        """Number of vertices."""
        return len(self.vertices)

    def averaged(self, field: NDArray[np.float64], n_averages: int) -> NDArray[np.float64]:
        """Return A^k of a field, shape (N,), see `RingMeans`."""
        rings = self.engine.rings
        return rings.outward(rings.averaged(rings.inward(field[:, None].copy()), n_averages))[:, 0]

    def smoothed(self, n_averages: int) -> SampleMesh:
        """Return the mesh after a low-pass L_k of its positions."""
        rings = self.engine.rings
        rows = np.zeros((self.n_vertices, 4), np.float32)
        rows[:, :3] = rings.inward(np.ascontiguousarray(self.vertices, np.float32))
        rows += rings.low_passes(rows.copy(), (n_averages,))[0]
        return SampleMesh(self.surface.with_vertices(rings.outward(rows)[:, :3].astype(np.float64)))

    def direction(self, rng: np.random.Generator) -> NDArray[np.float64]:
        """Return a coordinate along a random direction, shape (N,), about -1 to 1."""
        place = self.vertices @ self.rotation(rng)[:, 0]
        return place / max(float(np.abs(place).max()), 1e-9)

    def rotation(self, rng: np.random.Generator) -> NDArray[np.float64]:
        """Return a random orthogonal matrix."""
        return np.linalg.qr(rng.normal(size=(3, 3)))[0]

    def principal_axes(self) -> NDArray[np.float64]:
        """Return an orthogonal matrix whose last column is the direction in which the mesh is flattest."""
        return np.linalg.eigh(np.cov(self.vertices.T))[1][:, ::-1]

    def offset(self, rng: np.random.Generator) -> NDArray[np.float64]:
        """Return a random shift, shape (3,), and remember it as `last_offset`."""
        self.last_offset = rng.uniform(-0.5, 0.5, 3)
        return self.last_offset

    def clusters(self, rng: np.random.Generator) -> NDArray[np.int64]:
        """Return the cluster of each face, shape (F,): nearest of random faces; -1 if it does not count."""
        n_clusters = max(1, len(self._centroids) // FACES_IN_CLUSTER)
        seeds = self._centroids[rng.choice(len(self._centroids), n_clusters, replace=False)]
        cluster = cKDTree(seeds).query(self._centroids)[1]
        cluster[~self.is_counted] = -1
        return cluster
