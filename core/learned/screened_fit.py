# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertices that fit wanted face normals and stay near where they were: a screened Poisson problem.

With wanted normals n_f, centroids c_f, weights w_f and noisy positions p_v the minimum of

    sum over faces f and corners v of w_f <n_f, v - c_f>^2
    + sum over v of val(v) (NORMAL_PULL <m_v, v - p_v>^2 + TANGENT_PULL |(v - p_v) across m_v|^2)

with m_v the direction of the mean wanted normal at v. The second sum keeps what is wider than the normals
can tell and holds vertices within the surface. Where normals spread, at creases and corners, the first is
stiff in more directions and wins by itself.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..averages.means import Means, padded
from ..averages.ring_means import RingMeans
from .face_graph import FaceGraph, Polygons
from .normal_equations import NormalEquations
from .unfolding import ROUNDS, doubled_areas, unfolded_points

STEPS = 12
"""Steps of a fit from the noisy positions."""

NEEDLE = 0.1
"""Height over longest edge below which a face counts less: its normal says little about where it is."""

OUTLIER = 5.0
"""Displacement in units of what is usual around a vertex from which it is an outlier."""

LEAST_USUAL = np.float32(0.01)
"""What is usual at least, in local edge lengths: where there is no noise, displacements are of the size of
rounding and curvature, and which of them stick out is chance."""

OUTLIER_AVERAGES = 32
"""Averages over which the usual displacement is taken."""

LEAST_OUTLIERS = 5e-4
"""Share of the vertices from which outliers matter."""


class ScreenedFit:
    """The fit on a mesh.

    Parameters
    ----------
    graph : FaceGraph
        Faces and their corners.
    at_vertex : Means
        Faces of the graph at each vertex.
    rings : RingMeans
        Neighbors of vertices.
    """

    def __init__(self, graph: FaceGraph, at_vertex: Means, rings: RingMeans) -> None:
        self._graph, self._at_vertex, self._rings = graph, at_vertex, rings
        self._corners = [at_vertex.place.take(group.corners) for group in graph.groups]

    def fit(
        self,
        points: NDArray[np.float32],
        normals: NDArray[np.float32],
        is_free: NDArray[np.bool_] | None = None,
        unit: NDArray[np.float32] | None = None,
        *,
        least_outliers: float = LEAST_OUTLIERS,
        rounds: int = ROUNDS,
    ) -> NDArray[np.float32]:
        """Return fitted positions.

        Parameters
        ----------
        points : ndarray, shape (3, N), float32
            Noisy positions.
        normals : ndarray, shape (3, F), float32
            Wanted unit normals of the faces of the graph.
        is_free : ndarray, shape (N,), bool, optional
            Vertices that may move; all by default.
        unit : ndarray, shape (N,), float32, optional
            Local edge lengths; 1 by default.
        least_outliers : float
            Share of the vertices from which outliers matter.
        rounds : int
            Rounds of unfolding at most.

        Returns
        -------
        ndarray, shape (3, N), float32
        """
        weights = self._needle_weights(points)
        if is_free is not None and is_free.all():
            is_free = None
        fitted = self._solved(points, normals, weights, STEPS, is_free)
        start = self._without_outliers(points, fitted, is_free, unit, least_outliers)
        if start is not None:
            fitted = self._solved(start, normals, weights, STEPS, is_free)
        unfolded = unfolded_points(fitted, normals, self._graph, self._rings, is_free, rounds)
        return fitted if unfolded is None else self._solved(unfolded, normals, weights, STEPS // 2, is_free)

    def _needle_weights(self, points: NDArray[np.float32]) -> NDArray[np.float32]:
        """Return the weight of each face, shape (F,): 1, and less where it is thin."""
        weights = np.empty(self._graph.n_faces, np.float32)

        def kernel(faces: slice, polygons: Polygons) -> None:
            corners = [points.take(own, axis=1) for own in polygons.corners]
            area = doubled_areas(corners)
            longest = np.zeros_like(area)
            for corner, following in zip(corners, corners[1:] + corners[:1], strict=True):
                edge = following - corner
                edge *= edge
                np.maximum(longest, edge.sum(axis=0), out=longest)
            area /= np.maximum(longest, np.float32(1e-30))
            area *= np.float32(1.0 / NEEDLE)
            np.minimum(area, np.float32(1), out=area)
            # Squared, as the error of a normal moves the far ends by its lever.
            np.square(area, out=weights[faces])

        self._graph.for_faces(kernel)
        return weights

    def _solved(
        self,
        points: NDArray[np.float32],
        normals: NDArray[np.float32],
        weights: NDArray[np.float32],
        n_steps: int,
        is_free: NDArray[np.bool_] | None,
    ) -> NDArray[np.float32]:
        """Return the positions after some Chebyshev steps from `points`, where the vertices are held."""
        equations = NormalEquations(
            self._graph, self._at_vertex, self._corners, points, normals, weights, is_free
        )
        total, result = equations.solved(n_steps), np.empty_like(points)

        def move(start: int, stop: int) -> None:
            moved = total.take(self._at_vertex.place[start:stop], axis=0)
            np.add(points[:, start:stop], moved[:, :3].T, out=result[:, start:stop])

        self._graph.blocks.run(move, points.shape[1])
        return result

    def _without_outliers(
        self,
        points: NDArray[np.float32],
        fitted: NDArray[np.float32],
        is_free: NDArray[np.bool_] | None,
        unit: NDArray[np.float32] | None,
        least_outliers: float,
    ) -> NDArray[np.float32] | None:
        """Return positions to hold vertices at: those given, but outliers at the height of their rings.

        Squares are not robust: a spike that is held where it is lifts all vertices around. None without
        outliers.
        """
        rings = self._rings
        rows, step = rings.inward(padded(points)), rings.inward(padded(fitted - points))
        distance = np.sqrt((step * step).sum(axis=1))[:, None]
        usual = rings.averaged(distance.copy(), OUTLIER_AVERAGES)
        usual = rings.averaged(np.minimum(distance, 2 * usual), OUTLIER_AVERAGES)
        least = LEAST_USUAL if unit is None else LEAST_USUAL * rings.inward(unit[:, None])
        is_out = (distance > OUTLIER * np.maximum(usual, least))[:, 0]
        if is_free is not None:
            is_out &= rings.inward(is_free)
        if np.count_nonzero(is_out) < least_outliers * len(is_out):
            return None
        # Means over those in the ring that are no outliers; a fourth number counts them.
        others = rows.copy()
        others[:, 3] = 1
        others[is_out] = 0
        means = rings.mean(others)
        out = np.flatnonzero(is_out & (means[:, 3] > 0))
        away = means[out] / means[out, 3:] - rows[out]
        away[:, 3] = 0
        # Along the displacement only, so that nothing slides.
        direction = step[out] / distance[out]
        rows[out] += direction * (direction * away).sum(axis=1, keepdims=True)
        return np.ascontiguousarray(rings.outward(rows)[:, :3].T)
