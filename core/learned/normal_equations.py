# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The normal equations of the screened fit, and Chebyshev steps that solve them.

For the displacement u of the vertices, with the valence as a preconditioner,

    A_v u_v - (1 / val(v)) sum over faces f at v of w_f n_f <n_f, mean of u over f> = r_v,

where A_v is the mean of w_f n_f n_f^T over the faces at v, and what holds v in its place. All arrays go by
the rows of vertices that `Means` works on, with a fourth column that is not used.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

import numpy as np
from numpy.typing import NDArray

from ..averages.means import Means, padded
from .face_graph import FaceGraph, Polygons
from .symmetric import ENTRIES, ROWS

NORMAL_PULL = 0.006
TANGENT_PULL = 0.1

LOWEST, HIGHEST = 0.05, 1.12
"""Eigenvalues that Chebyshev steps are made for. Lower ones belong to wide shapes, which hardly change."""

Rows = NDArray[np.float32]


class NormalEquations:
    """The equations for wanted normals and positions to hold the vertices at.

    Parameters
    ----------
    graph : FaceGraph
        Faces.
    at_vertex : Means
        Faces at each vertex.
    corners : sequence of ndarray, shape (K, F_K), int32
        Rows of the corners of each group of faces.
    points : ndarray, shape (3, N), float32
        Positions to hold the vertices at.
    normals : ndarray, shape (3, F), float32
        Wanted unit normals.
    weights : ndarray, shape (F,), float32
        Of the faces.
    is_free : ndarray, shape (N,), bool, or None
        Vertices that may move; None for all.
    """

    def __init__(
        self,
        graph: FaceGraph,
        at_vertex: Means,
        corners: Sequence[NDArray[np.int32]],
        points: NDArray[np.float32],
        normals: NDArray[np.float32],
        weights: NDArray[np.float32],
        is_free: NDArray[np.bool_] | None,
    ) -> None:
        self._graph, self._at_vertex, self._corners = graph, at_vertex, corners
        self._normals, self._weights = normals, weights
        n_vertices = points.shape[1]
        self._matrix = np.zeros((len(ENTRIES), n_vertices), np.float32)  # A, its upper half
        self._residual = np.zeros((n_vertices, 4), np.float32)
        self._pulls = np.zeros((graph.n_faces, 4), np.float32)  # w n <n, mean of u>
        self._assemble(at_vertex.inward(padded(points)))
        self._free = None
        if is_free is not None:
            # Rows of what is held are 0 in all steps.
            self._free = np.repeat(at_vertex.inward(is_free).astype(np.float32)[:, None], 4, axis=1)
            self._residual *= self._free

    def _assemble(self, rows: Rows) -> None:
        """Fill the matrix, and the residual of no displacement."""
        normals, weights = self._normals, self._weights
        arms = np.zeros((self._graph.n_faces, 4), np.float32)  # w n, and w <n, c> for centroids c

        def keep(faces: slice, along: NDArray[np.float32]) -> None:
            arms[faces, 3] = along
            for axis in range(3):
                np.multiply(normals[axis, faces], weights[faces], out=arms[faces, axis])

        self._project(rows, keep)
        plain = padded(normals)

        def begin(part: slice, members: NDArray[np.int32]) -> None:
            if not len(members):
                return
            share = np.float32(1.0 / len(members))
            weighted = np.ascontiguousarray(np.moveaxis(arms.take(members, axis=0), 2, 0))
            normal = np.ascontiguousarray(np.moveaxis(plain.take(members, axis=0), 2, 0)[:3])
            along = weighted[3].copy()
            for axis in range(3):
                along -= weighted[axis] * rows[part, axis]
            mean = normal.sum(axis=1)
            length = (mean * mean).sum(axis=0)
            np.divide(mean, np.sqrt(np.maximum(length, np.float32(1e-12))), out=mean)
            for axis in range(3):
                self._residual[part, axis] = (normal[axis] * along).sum(axis=0) * share
            for entry, (i, j) in enumerate(ENTRIES):
                own = (weighted[i] * normal[j]).sum(axis=0)
                own *= share
                own += np.float32(NORMAL_PULL - TANGENT_PULL) * mean[i] * mean[j]
                if i == j:
                    own += np.float32(TANGENT_PULL)
                self._matrix[entry, part] = own

        self._at_vertex.for_parts(begin)

    def _project(self, field: Rows, use: Callable[[slice, NDArray[np.float32]], None]) -> None:
        """Call `use(faces, along)` with w <n, mean of a field over the corners> for blocks of faces."""

        def kernel(group: Polygons, corners: NDArray[np.int32], start: int, stop: int) -> None:
            along = self._along(field, group, corners, start, stop)
            use(slice(group.begin + start, group.begin + stop), along)

        for group, corners in zip(self._graph.groups, self._corners, strict=True):
            self._graph.blocks.run(partial(kernel, group, corners), group.end - group.begin)

    def _along(
        self, field: Rows, group: Polygons, corners: NDArray[np.int32], start: int, stop: int
    ) -> NDArray[np.float32]:
        """Return w <n, mean of a field over the corners> of some faces of a group, shape (stop - start,)."""
        middle = field.take(corners[0, start:stop], axis=0)
        for corner in corners[1:, start:stop]:
            middle += field.take(corner, axis=0)
        middle *= np.float32(1.0 / len(corners))
        faces = slice(group.begin + start, group.begin + stop)
        normal = self._normals[:, faces]
        along = normal[0] * middle[:, 0]
        along += normal[1] * middle[:, 1]
        along += normal[2] * middle[:, 2]
        along *= self._weights[faces]
        return along

    def solved(self, n_steps: int) -> Rows:
        """Return the displacement, shape (N, 4), after some Chebyshev steps; to be called once."""
        middle, half = np.float32((HIGHEST + LOWEST) / 2), np.float32((HIGHEST - LOWEST) / 2)
        step = self._residual / middle
        total = step.copy()
        rho = half / middle
        for _ in range(n_steps - 1):
            following = np.float32(1) / (2 * middle / half - rho)
            self._advance(step, total, np.float32(following * rho), np.float32(2 * following / half))
            rho = following
        return total

    def _advance(self, step: Rows, total: Rows, keep: np.float32, gain: np.float32) -> None:
        """Take a step, in place: keep * step + gain * what is left of the residual."""
        normals, pulls = self._normals, self._pulls

        def pull(faces: slice, along: NDArray[np.float32]) -> None:
            for axis in range(3):
                np.multiply(normals[axis, faces], along, out=pulls[faces, axis])

        self._project(step, pull)

        def advance(part: slice, means: Rows) -> None:
            own = np.ascontiguousarray(step[part].T)
            for axis, entries in enumerate(ROWS):
                product = self._matrix[entries[0], part] * own[0]
                product += self._matrix[entries[1], part] * own[1]
                product += self._matrix[entries[2], part] * own[2]
                means[:, axis] -= product
            means += self._residual[part]
            if self._free is not None:
                means *= self._free[part]
            self._residual[part] = means
            means *= gain
            means += keep * step[part]
            step[part] = means
            total[part] += means

        # Faces have been read before any vertex is written.
        self._at_vertex.visit(pulls, advance)
