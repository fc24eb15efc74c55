# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Least-squares polynomial heights over patches, and what they leave over.

A polynomial of degree d leaves nothing of a surface that is one, wherever its vertices lie in it: neither
curvature nor an uneven mesh looks like noise. White noise of variance s^2 leaves s^2 times the degrees of
freedom of the fit, exactly.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..mesh.ragged import Ragged

_RIDGE = 1e-9
"""Added to the diagonal of the normal equations, relative to it: fits with coefficients that the vertices do
not determine, as on a line, stay finite."""

_FLAT = 1e-9
"""Extent, relative to the largest, below which a patch is a line."""

_N_QUADRIC = 6
"""Coefficients of a polynomial of degree 2, which come first."""


class Residuals(NamedTuple):
    """What fits leave over, for each patch."""

    variance: NDArray[np.float64]
    """Estimate of the variance of noise along the normal, shape (n,), in squared units of the positions."""
    degrees_of_freedom: NDArray[np.float64]
    """Its degrees of freedom, shape (n,)."""
    cubic: NDArray[np.float64]
    """The same from what the cubic terms of the fit take away, shape (n,): shape shows here first."""
    cubic_degrees_of_freedom: NDArray[np.float64]
    """Its degrees of freedom, shape (n,)."""
    extent: NDArray[np.float64]
    """Standard deviation of the patch's vertices along its narrower tangent, shape (n,)."""
    studentized: NDArray[np.float64]
    """Residual of the center by its own standard deviation as the patch estimates it, shape (n,)."""


def fit_heights(positions: NDArray[np.float64], patches: Ragged) -> Residuals:
    """Fit a cubic polynomial to the heights of each patch over its principal plane.

    Parameters
    ----------
    positions : ndarray, shape (N, 3), float64
        Positions, near the origin.
    patches : Ragged
        Vertices of each patch, its center first; none is empty.
    """
    row, begin = patches.row_of_item, patches.offset[:-1]
    heights, tangents, extents = _principal_heights(positions, patches)
    inverse = np.divide(1.0, extents, out=np.zeros_like(extents), where=extents > _FLAT * extents[:, 1:])
    u, w = (tangents * inverse[row]).T
    basis, along_u, along_w = _monomials(u, w)
    normal_matrix = np.add.reduceat(basis[:, :, None] * basis[:, None, :], begin)
    diagonal = np.arange(basis.shape[1])
    normal_matrix[:, diagonal, diagonal] *= 1.0 + _RIDGE
    normal_matrix[:, diagonal, diagonal] += _RIDGE
    inverse_matrix = np.linalg.inv(normal_matrix)
    right = np.add.reduceat(basis * heights[:, None], begin)
    coefficients = np.einsum("nij,nj->ni", inverse_matrix, right)[row]
    covariance = inverse_matrix[row]
    residual = heights - np.einsum("pi,pi->p", basis, coefficients)
    point_degrees_of_freedom = 1.0 - _quadratic(basis, covariance)
    degrees_of_freedom = np.add.reduceat(point_degrees_of_freedom, begin)
    variance = np.add.reduceat(residual**2, begin) / np.maximum(degrees_of_freedom, 1.0)
    center_degrees_of_freedom = np.maximum(point_degrees_of_freedom[begin], _FLAT)
    scale = np.sqrt(variance * center_degrees_of_freedom)
    studentized = np.divide(residual[begin], scale, out=np.zeros_like(scale), where=scale > 0)
    quadric = _Quadric(normal_matrix, right, row)
    slope = quadric.squared_slopes(
        (along_u * inverse[row, :1], along_w * inverse[row, 1:]), variance, point_degrees_of_freedom, begin
    )
    taken = np.add.reduceat((heights - quadric.values(basis)) ** 2 - residual**2, begin)
    cubic_degrees_of_freedom = np.add.reduceat(1.0 - quadric.leverage(basis), begin) - degrees_of_freedom
    cubic = np.maximum(taken, 0.0) / np.maximum(cubic_degrees_of_freedom, 1.0)
    return Residuals(
        variance / (1.0 + slope),
        degrees_of_freedom,
        cubic / (1.0 + slope),
        cubic_degrees_of_freedom,
        extents[:, 0],
        studentized,
    )


class _Quadric:
    """The fits of degree 2 that are part of the normal equations of degree 3."""

    def __init__(
        self, normal_matrix: NDArray[np.float64], right: NDArray[np.float64], row: NDArray[np.intp]
    ) -> None:
        inverse = np.linalg.inv(normal_matrix[:, :_N_QUADRIC, :_N_QUADRIC])
        self._row = row
        self._covariance = inverse[row]
        self._coefficients = np.einsum("nij,nj->ni", inverse, right[:, :_N_QUADRIC])[row]

    def values(self, basis: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the fitted heights, or for derivatives of the basis the slopes, shape (P,)."""
        return np.einsum("pi,pi->p", basis[:, :_N_QUADRIC], self._coefficients)

    def leverage(self, basis: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the variance of `values` for noise of variance 1, shape (P,)."""
        return _quadratic(basis[:, :_N_QUADRIC], self._covariance)

    def squared_slopes(
        self,
        derivatives: tuple[NDArray[np.float64], NDArray[np.float64]],
        variance: NDArray[np.float64],
        weights: NDArray[np.float64],
        begin: NDArray[np.int64],
    ) -> NDArray[np.float64]:
        """Return the mean squared slope of each patch against its plane, without what noise adds to it."""
        weights = np.maximum(weights, 0.0)
        total = np.zeros(len(begin))
        for derivative in derivatives:
            squared = self.values(derivative) ** 2 - variance[self._row] * self.leverage(derivative)
            total += np.add.reduceat(weights * squared, begin)
        return np.maximum(total / np.maximum(np.add.reduceat(weights, begin), _FLAT), 0.0)


def _principal_heights(
    positions: NDArray[np.float64], patches: Ragged
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Return heights (P,) over the plane of least variance, coordinates (P, 2) in it, and extents (n, 2)."""
    row, begin = patches.row_of_item, patches.offset[:-1]
    counts = np.diff(patches.offset)
    points = positions[patches.items]
    points -= points[begin][row]  # digits: the mean is taken near the center
    points -= (np.add.reduceat(points, begin) / counts[:, None])[row]
    covariance = np.add.reduceat(points[:, :, None] * points[:, None, :], begin) / counts[:, None, None]
    variances, axes = np.linalg.eigh(covariance)
    coordinates = np.einsum("pi,pij->pj", points, axes[row])
    return coordinates[:, 0], coordinates[:, 1:], np.sqrt(np.maximum(variances[:, 1:], 0.0))


def _monomials(
    u: NDArray[np.float64], w: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Return all monomials up to the third degree and their derivatives along u and w, shape (P, k) each."""
    powers = [(total - j, j) for total in range(4) for j in range(total + 1)]
    basis = np.stack([u**i * w**j for i, j in powers], axis=1)
    along_u = np.stack([i * u ** max(i - 1, 0) * w**j for i, j in powers], axis=1)
    along_w = np.stack([j * u**i * w ** max(j - 1, 0) for i, j in powers], axis=1)
    return basis, along_u, along_w


def _quadratic(vectors: NDArray[np.float64], matrices: NDArray[np.floating]) -> NDArray[np.float64]:
    """Return v' A v for each vector (P, k) and matrix (P, k, k)."""
    product: NDArray[np.float64] = np.einsum("pij,pj->pi", matrices, vectors)
    return np.einsum("pi,pi->p", product, vectors)
