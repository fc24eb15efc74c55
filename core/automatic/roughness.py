# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How rough results are."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..normals.noise_sample import normals_of
from .problem import NormalProblem


class Roughness:
    """How rough a result is, at the counted vertices only.

    Parameters
    ----------
    problem : NormalProblem
        The mesh.
    counted : ndarray, shape (N,), bool
        Vertices that count.
    """

    def __init__(self, problem: NormalProblem, counted: NDArray[np.bool_]) -> None:
        surface, neighbors = problem.surface, problem.neighbors
        own = np.repeat(np.arange(surface.n_faces), np.diff(neighbors.offset))
        # The corners of a face are its edges as well, so that `own` goes along with them.
        is_seen = counted[surface.corner_vertex] & (own != neighbors.neighbor)
        self._surface, self._first, self._second = surface, own[is_seen], neighbors.neighbor[is_seen]
        n_all = np.bincount(own, minlength=surface.n_faces)
        self._n_seen = np.bincount(self._first, minlength=surface.n_faces)
        n_counted = np.bincount(own[counted[surface.corner_vertex]], minlength=surface.n_faces)
        self._inner = np.flatnonzero((self._n_seen > 0) & (n_counted == n_all))

    def of(self, points: NDArray[np.floating]) -> tuple[float, float]:
        """Return two measures of the roughness of positions, shape (3, N).

        The lower quartile of |n_f - n_g| over adjacent faces: creases do not count, and flat regions do. The
        root mean square of |n_f - mean(n_g)|: bends that all neighbors share do not count.
        """
        if not len(self._inner):
            return 0.0, 0.0
        normals = normals_of(points, self._surface)
        others = normals[:, self._second]
        apart = normals[:, self._first] - others
        squares = np.einsum("cn,cn->n", apart, apart)
        quarter = len(squares) // 4
        n_faces = normals.shape[1]
        sums = np.stack([np.bincount(self._first, row, minlength=n_faces) for row in others])
        bent = normals[:, self._inner] - sums[:, self._inner] / self._n_seen[self._inner]
        return (
            float(np.sqrt(np.partition(squares, quarter)[quarter])),
            float(np.sqrt(np.mean(np.einsum("cn,cn->n", bent, bent)))),
        )
