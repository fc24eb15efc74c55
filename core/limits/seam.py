# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The seam between vertices that may move and those that stay, without a step."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..mesh.connected_components import connected_components

RINGS = 4
"""Rings over which a shift fades in beside vertices that stay."""

MEAN_STEPS = 64
INDEPENDENT = 20
"""Steps of averaging along a ring, and how many independent vertices such a mean is worth, about
2 sqrt(pi MEAN_STEPS / 2)."""

CHANCE = 2.5
"""Standard errors of a mean up to which it counts as chance."""


def faded_in(ring: NDArray[np.integer]) -> NDArray[np.float64]:
    """Return the share of a shift that vertices make by their ring, smooth from 0 to 1 over `RINGS`."""
    step = np.minimum(ring, RINGS) / RINGS
    return step * step * (3.0 - 2.0 * step)


def rings_beside(stays: NDArray[np.bool_], edges: NDArray[np.integer]) -> NDArray[np.int8]:
    """Return how many edges each vertex is away from those that stay, shape (N,), up to `RINGS`.

    Parameters
    ----------
    stays : ndarray, shape (N,), bool
        Vertices of ring 0.
    edges : ndarray, shape (E, 2), int
        The edges of the mesh.
    """
    ring = np.where(stays, 0, RINGS).astype(np.int8)
    for number in range(1, RINGS if stays.any() else 0):
        one, other = ring[edges[:, 0]], ring[edges[:, 1]]
        fresh = np.concatenate((edges[one == number - 1, 1], edges[other == number - 1, 0]))
        ring[fresh[ring[fresh] == RINGS]] = number
    return ring


def fade_shift_in(
    found: NDArray[np.float64],
    normals: NDArray[np.float64],
    stays: NDArray[np.bool_],
    pinned: NDArray[np.integer],
    edges: NDArray[np.integer],
) -> None:
    """Let what vertices beside a seam move in common begin at the seam with nothing.

    Smoothing shrinks a surface a little, so that a part of it that moves as a whole would end in a step. A
    ring's shift is the mean motion across the surface along the ring, as far as it is more than chance; the
    rest of the motion, which removes noise, is made in full. Rings of fewer than `INDEPENDENT` vertices, as
    beside small parts, tell nothing of a shift and are left alone.

    Parameters
    ----------
    found : ndarray, shape (3, N)
        Displacements in any unit; changed.
    normals : ndarray, shape (3, N)
        Unit normals of the vertices.
    stays : ndarray, shape (N,), bool
        Vertices that stay because they do not belong to the part.
    pinned : ndarray, shape (p,), int
        Vertices whose displacements are left alone.
    edges : ndarray, shape (E, 2), int
        The edges of the mesh.
    """
    ring = rings_beside(stays, edges)
    is_beside = (ring > 0) & (ring < RINGS)
    is_beside[pinned] = False
    vertices = np.flatnonzero(is_beside)
    if not len(vertices):
        return
    rank = np.full(len(ring), -1)
    rank[vertices] = np.arange(len(vertices))
    # Rings are averaged along themselves only: across the seam the shift is not constant.
    along = edges[is_beside[edges].all(axis=1) & (ring[edges[:, 0]] == ring[edges[:, 1]])]
    along = rank[along[along[:, 0] != along[:, 1]]]
    group = connected_components(len(vertices), along[:, 0], along[:, 1])
    is_long = np.bincount(group, minlength=len(vertices))[group] >= INDEPENDENT
    if not is_long.any():
        return
    vertices = vertices[is_long]
    rank = np.cumsum(is_long) - 1
    along = rank[along[is_long[along[:, 0]]]]
    one, other = np.concatenate((along, along[:, ::-1])).T
    counts = np.bincount(one, minlength=len(vertices))
    height = np.einsum("cn,cn->n", found[:, vertices], normals[:, vertices])
    shift = height
    for _ in range(MEAN_STEPS):
        shift = 0.5 * (shift + np.bincount(one, shift[other], len(vertices)) / counts)
    rest = height - shift
    chance = CHANCE * np.sqrt((rest @ rest) / (len(vertices) * INDEPENDENT))
    excess = np.sign(shift) * np.maximum(np.abs(shift) - chance, 0.0)
    found[:, vertices] -= normals[:, vertices] * ((1.0 - faded_in(ring[vertices])) * excess)
