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

from .patches import Patches

_RIDGE = 1e-9
"""Added to the diagonal of the normal equations, whose entries are numbers of vertices: fits with coefficients
that the vertices do not determine, as on a line, stay finite."""

_FLAT = 1e-9
"""Extent, relative to the largest, below which a patch is a line."""


_N_QUADRIC = 6
"""Coefficients of a polynomial of degree 2, which come first."""


class Leftovers(NamedTuple):
    """What fits leave over, for each patch."""

    variance: NDArray[np.float64]
    """Estimate of the variance of noise along the normal, shape (n,), in squared units of the positions."""
    freedom: NDArray[np.float64]
    """Its degrees of freedom, shape (n,)."""
    extent: NDArray[np.float64]
    """Standard deviation of the patch's vertices along its narrower tangent, shape (n,)."""
    studentized: NDArray[np.float64]
    """Leftover of the center by its own standard deviation as the patch estimates it, shape (n,)."""


def fit_heights(positions: NDArray[np.float64], patches: Patches, degree: int) -> Leftovers:
    """Fit a polynomial of the given degree to the heights of each patch over its principal plane.

    Parameters
    ----------
    positions : ndarray, shape (N, 3), float64
        Positions, near the origin.
    patches : Patches
        Vertices of each patch; none is empty.
    degree : int
        2 or 3.
    """
    row, begin = patches.row, patches.offset[:-1]
    heights, tangents, extents = _principal_heights(positions, patches)
    inverse = np.divide(1.0, extents, out=np.zeros_like(extents), where=extents > _FLAT * extents[:, 1:])
    u, w = (tangents * inverse[row]).T
    basis, along_u, along_w = _monomials(u, w, degree)
    normal_matrix = np.add.reduceat(basis[:, :, None] * basis[:, None, :], begin)
    diagonal = np.arange(basis.shape[1])
    normal_matrix[:, diagonal, diagonal] += _RIDGE
    inverse_matrix = np.linalg.inv(normal_matrix)
    right = np.add.reduceat(basis * heights[:, None], begin)
    coefficients = np.einsum("nij,nj->ni", inverse_matrix, right)[row]
    covariance = inverse_matrix[row]
    residual = heights - np.einsum("pi,pi->p", basis, coefficients)
    freedom_of_point = 1.0 - _quadratic(basis, covariance)
    freedom = np.add.reduceat(freedom_of_point, begin)
    variance = np.add.reduceat(residual**2, begin) / np.maximum(freedom, 1.0)
    center_freedom = np.maximum(freedom_of_point[begin], _FLAT)
    scale = np.sqrt(variance * center_freedom)
    studentized = np.divide(residual[begin], scale, out=np.zeros_like(scale), where=scale > 0)
    slope = _squared_slopes(
        normal_matrix, right, (along_u, along_w), inverse, variance, np.maximum(freedom_of_point, 0.0), patches
    )
    variance = variance / (1.0 + slope)
    return Leftovers(variance, freedom, extents[:, 0], studentized)


def _squared_slopes(
    normal_matrix: NDArray[np.float64],
    right: NDArray[np.float64],
    derivatives: tuple[NDArray[np.float64], NDArray[np.float64]],
    inverse: NDArray[np.float64],
    variance: NDArray[np.float64],
    weights: NDArray[np.float64],
    patches: Patches,
) -> NDArray[np.float64]:
    """Return the mean squared slope of each patch against its plane, shape (n,), from its fit of degree 2.

    What the noise itself adds to the slope is taken off.
    """
    row, begin = patches.row, patches.offset[:-1]
    inverse_matrix = np.linalg.inv(normal_matrix[:, :_N_QUADRIC, :_N_QUADRIC])
    coefficients = np.einsum("nij,nj->ni", inverse_matrix, right[:, :_N_QUADRIC])
    total = np.zeros(len(begin))
    for axis, derivative in enumerate(derivatives):
        derivative = derivative[:, :_N_QUADRIC] * inverse[row, axis, None]
        squared = np.einsum("pi,pi->p", derivative, coefficients[row]) ** 2
        squared -= variance[row] * _quadratic(derivative, inverse_matrix[row])
        total += np.add.reduceat(weights * squared, begin)
    return np.maximum(total / np.maximum(np.add.reduceat(weights, begin), _FLAT), 0.0)


def _principal_heights(
    positions: NDArray[np.float64], patches: Patches
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Return heights (P,) over the plane of least variance, coordinates (P, 2) in it, and extents (n, 2)."""
    row, begin = patches.row, patches.offset[:-1]
    counts = np.diff(patches.offset)
    points = positions[patches.vertex]
    points -= points[begin][row]  # digits: the mean is taken near the center
    points -= (np.add.reduceat(points, begin) / counts[:, None])[row]
    covariance = np.add.reduceat(points[:, :, None] * points[:, None, :], begin) / counts[:, None, None]
    variances, axes = np.linalg.eigh(covariance)
    coordinates = np.einsum("pi,pij->pj", points, axes[row])
    return coordinates[:, 0], coordinates[:, 1:], np.sqrt(np.maximum(variances[:, 1:], 0.0))


def _monomials(
    u: NDArray[np.float64], w: NDArray[np.float64], degree: int
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Return all monomials up to a degree and their derivatives along u and w, shape (P, k) each."""
    powers = [(total - j, j) for total in range(degree + 1) for j in range(total + 1)]
    basis = np.stack([u**i * w**j for i, j in powers], axis=1)
    along_u = np.stack([i * u ** max(i - 1, 0) * w**j for i, j in powers], axis=1)
    along_w = np.stack([j * u**i * w ** max(j - 1, 0) for i, j in powers], axis=1)
    return basis, along_u, along_w


def _quadratic(vectors: NDArray[np.float64], matrices: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return v' A v for each vector (P, k) and matrix (P, k, k)."""
    return np.einsum("pi,pi->p", np.einsum("pij,pj->pi", matrices, vectors), vectors)
