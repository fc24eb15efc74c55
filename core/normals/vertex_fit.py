# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Many steps of moving vertices until the faces have wanted normals, with what does not change made once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..surface.surface_mesh import SurfaceMesh
from .averages import Averages, Group
from .neighbors import Ragged
from .vertex_update import face_centroids


class VertexFit:
    """The steps of `vertex_update.update_vertices`, for the displacement instead of the position.

    With the mean over the faces f at a vertex, a step is u <- u + r + mean(n_f <n_f, c_f(u)>) - Q u: r is the
    step at the start, c_f(u) the mean displacement of the corners, and Q = mean(n_f n_f'). All of them are
    small, so that single precision loses nothing, and each face is looked at once.

    Parameters
    ----------
    surface : SurfaceMesh
        The mesh, for its faces.
    at_vertex : Ragged
        Faces at each vertex.
    blocks : Blocks
        Threads to work on.
    """

    def __init__(self, surface: SurfaceMesh, at_vertex: Ragged, blocks: Blocks) -> None:
        self._surface = surface

        def around(start: int, stop: int) -> Ragged:
            offset = at_vertex.offset[start : stop + 1]
            return Ragged(offset - offset[0], at_vertex.items[offset[0] : offset[-1]])

        def equal(group: Group) -> NDArray[np.floating]:
            return np.full(group.members.shape, 1.0 / group.members.shape[1])

        self._faces = Averages(around, surface.n_vertices, blocks)
        self._weights = self._faces.for_groups(equal)

    def steps(self, start: NDArray[np.floating], normals: NDArray[np.floating]) -> VertexSteps:
        """Begin to fit: `start` are positions (3, N), `normals` wanted unit normals (3, F)."""
        return VertexSteps(self, start, normals)

    def mean(self, field: NDArray[np.floating]) -> NDArray[np.floating]:
        """Return means over the faces at each vertex, shape (N, C), of a field (F, C)."""
        if self._weights and self._weights[0] and self._weights[0][0].dtype != field.dtype:
            self._weights = [[part.astype(field.dtype) for part in block] for block in self._weights]
        return self._faces.average(self._weights, field)

    def centroids(self, points: NDArray[np.floating]) -> NDArray[np.floating]:
        """Return the means of the corners, shape (3, F)."""
        return face_centroids(points, self._surface)

    def start_of_corners(
        self, start: NDArray[np.floating], normals: NDArray[np.floating]
    ) -> NDArray[np.floating]:
        """Return r, shape (N, 3): the mean over the faces at a vertex of n <n, c - v>."""
        surface = self._surface
        sizes = surface.face_sizes()
        own = np.repeat(np.arange(surface.n_faces), sizes)
        arm = self.centroids(start)[:, own] - start[:, surface.corner_vertex]
        corner_normals = normals[:, own]
        pull = corner_normals * np.einsum("cn,cn->n", corner_normals, arm)
        counts = np.bincount(surface.corner_vertex, minlength=surface.n_vertices)
        sums = [np.bincount(surface.corner_vertex, row, minlength=surface.n_vertices) for row in pull]
        return (np.stack(sums, axis=1) / np.maximum(counts, 1)[:, None]).astype(start.dtype)


class VertexSteps:
    """A fit that is under way."""

    def __init__(self, fit: VertexFit, start: NDArray[np.floating], normals: NDArray[np.floating]) -> None:
        self._fit, self._normals = fit, normals
        self._first = fit.start_of_corners(start, normals)
        outer = (normals[:, None] * normals[None]).reshape(9, -1)
        self._mean_outer = fit.mean(np.ascontiguousarray(outer.T)).reshape(-1, 3, 3)

    def advance(self, displacement: NDArray[np.floating]) -> NDArray[np.floating]:
        """Return the displacement, shape (3, N), after another step."""
        normals = self._normals
        pull = normals * np.einsum("cf,cf->f", normals, self._fit.centroids(displacement))
        change = self._fit.mean(np.ascontiguousarray(pull.T)) + self._first
        change -= np.einsum("nij,jn->ni", self._mean_outer, displacement)
        return displacement + change.T
