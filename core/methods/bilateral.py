# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bilateral mesh filtering, the paper's baseline [48] (Fleishman, Drori, Cohen-Or 2003)."""

from __future__ import annotations

from math import ceil

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..mesh.connectivity import Connectivity
from ..mesh.distance_rings import distance_rings, edge_adjacency
from ..mesh.geometry import vertex_normals
from .problem import Problem, Solution, rms_motion

_Pairs = tuple[NDArray[np.intp], NDArray[np.intp]]

VERTICES_AT_ONCE = 2**14
"""Vertices whose neighborhoods are found at once: there are many pairs to each."""


def bilateral_filter(problem: Problem) -> Solution:
    """Move each vertex along its normal by the weighted mean height of its neighborhood.

    Parameters
    ----------
    problem : Problem
        With the settings `iterations`, `tolerance`, `sigma_c`, and `sigma_s`, where 0 stands for the standard
        deviation of the heights on the noisy mesh, around the vertices that may move; `strength` is a
        factor for it.

    Notes
    -----
    For a vertex p with normal n and the neighbors q within 2 sigma_c: t = |p - q|, h = <n, q - p>,
    w = exp(-t^2 / 2 sigma_c^2) exp(-h^2 / 2 sigma_s^2), p <- p + n sum(w h) / sum(w). Neighbors are looked
    for along the surface, as far as 2 sigma_c edges.
    """
    noisy, surface, settings, callback = problem.noisy, problem.surface, problem.settings, problem.callback
    if settings.strength == 0.0:
        return Solution(noisy, settings.iterations, False, settings)
    dtype = noisy.dtype.type
    points = noisy.copy()
    blocks = problem.blocks.with_block_size(min(problem.blocks.block_size, VERTICES_AT_ONCE))
    reach = max(1, ceil(2.0 * settings.sigma_c))
    pairs = blocks.run(
        lambda start, stop: vertices_within(problem.connectivity, start, stop, reach), noisy.shape[1]
    )
    sigma_s = settings.strength * settings.sigma_s
    for iteration in range(1, settings.iterations + 1):
        normals = np.ascontiguousarray(vertex_normals(surface.with_vertices(points.T)).T, dtype)
        if sigma_s == 0.0:
            sigma_s = _height_deviation(points, normals, pairs, settings.sigma_c, blocks, problem.movable)
            sigma_s *= settings.strength
        following = points.copy()

        def kernel(
            start: int,
            stop: int,
            points: NDArray[np.floating] = points,
            normals: NDArray[np.floating] = normals,
            following: NDArray[np.floating] = following,
            sigma_s: float = sigma_s,
        ) -> None:
            center, member = pairs[start // blocks.block_size]
            squared, height = _offsets(points, normals, center, member)
            weight = _bell(squared, settings.sigma_c)
            if sigma_s > 0.0:
                weight *= _bell(height * height, sigma_s)
            weight[squared > 4.0 * settings.sigma_c**2] = 0.0
            total = np.bincount(center - start, weight, stop - start)
            moved = np.bincount(center - start, weight * height, stop - start)
            moved = np.divide(moved, total, out=np.zeros(stop - start), where=total > 0)
            following[:, start:stop] += normals[:, start:stop] * moved.astype(dtype)

        blocks.run(kernel, noisy.shape[1])
        problem.constraints.apply(following, noisy)
        change = rms_motion(following, points, blocks)
        points = following
        if callback is not None and callback(iteration / settings.iterations, change):
            return Solution(points, iteration, True, settings)
        if change < settings.tolerance:
            return Solution(points, iteration, False, settings)
    return Solution(points, settings.iterations, False, settings)


def _bell(squared: NDArray[np.floating], sigma: float) -> NDArray[np.floating]:
    """Return exp(-squared / 2 sigma^2), of the same dtype; for the narrowest bells 0 but at 0."""
    most = float(np.finfo(squared.dtype).max)
    with np.errstate(over="ignore"):
        return np.exp(squared * squared.dtype.type(-min(0.5 / sigma / sigma, most)))


def vertices_within(connectivity: Connectivity, start: int, stop: int, n_edges: int) -> _Pairs:
    """Return the vertices at most so many edges away from each of a range of vertices, as pairs.

    Returns
    -------
    center, member : ndarray, shape (P,), intp
        In ascending order of both; a vertex is not its own member.
    """
    rings = distance_rings(edge_adjacency(connectivity), np.arange(start, stop), range(1, n_edges + 1))
    center, member = (np.concatenate(column) for column in zip(*rings.values(), strict=True))
    order = np.argsort(center * connectivity.n_vertices + member)
    return center[order] + start, member[order]


def _offsets(
    points: NDArray[np.floating],
    normals: NDArray[np.floating],
    center: NDArray[np.intp],
    member: NDArray[np.intp],
) -> tuple[NDArray[np.floating], NDArray[np.floating]]:
    """Return squared distances and heights above the tangent plane of pairs, each shape (P,)."""
    arms = points.take(member, axis=1) - points.take(center, axis=1)
    return np.einsum("cp,cp->p", arms, arms), np.einsum("cp,cp->p", arms, normals.take(center, axis=1))


def _height_deviation(
    points: NDArray[np.floating],
    normals: NDArray[np.floating],
    pairs: list[_Pairs],
    sigma_c: float,
    blocks: Blocks,
    movable: NDArray[np.bool_] | None,
) -> float:
    """Return the standard deviation of the heights of all neighbors within 2 sigma_c.

    Only neighbors of `movable` vertices, shape (N,), count; None for all.
    """

    def kernel(start: int, stop: int) -> NDArray[np.float64]:
        center, member = pairs[start // blocks.block_size]
        if movable is not None:
            is_counted = movable[center]
            center, member = center[is_counted], member[is_counted]
        squared, height = _offsets(points, normals, center, member)
        height = height[squared <= 4.0 * sigma_c**2].astype(np.float64)
        return np.array([len(height), height.sum(), (height * height).sum()])

    count, total, squares = np.sum(blocks.run(kernel, points.shape[1]), axis=0)
    return float(np.sqrt(max(squares / count - (total / count) ** 2, 0.0))) if count else 0.0
