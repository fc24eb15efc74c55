# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the net sees of a surface: scalars that do not depend on pose, size or numbering.

Lengths are in the local unit. Energies are logarithms with a floor, e(x) = log(x^2 + 1e-4).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..averages.means import Means
from ..averages.ring_means import RingMeans
from .face_graph import FaceGraph, Polygons
from .measured import Measured, counted_faces
from .residual import Residual
from .scales import N_SCALES, Scales

FLOOR = np.float32(1e-4)
"""Least energy: jumps of normals and heights below a hundredth are as good as none."""

SPREAD_AVERAGES = 64
"""Averages over which energies are spread, about six rings."""

N_SAMPLES = 4096
"""Faces of an island from which its quantiles are taken."""

PAIRS_OF_SCALES = ((0, 1), (1, 2), (2, 3), (0, 2), (1, 3), (0, 3))

N_SPREAD = 8
N_GLOBAL = 16
N_RESIDUAL = 2
N_FACE = 3 + 3 + len(PAIRS_OF_SCALES) + 1 + N_SPREAD + N_GLOBAL + N_RESIDUAL
N_CONTEXT = N_GLOBAL + N_RESIDUAL
N_EDGE = 7


@dataclass(frozen=True, eq=False)
class Features:
    """Inputs of the net.

    Attributes
    ----------
    pairs : ndarray, shape (P + 1, N_EDGE), float32
        Distance, ratio of areas, bends and offsets across each edge; 0 for the pair without faces.
    context : ndarray, shape (I, N_CONTEXT), float32
        What is known of each island as a whole (small ones are one): its quantiles, and means of what the
        pass before took away.
    island : ndarray, shape (F,), intp, or None
        The island of each face; None if there is one.
    block : callable
        `block(faces, polygons)` returns the inputs of some faces, shape (n, N_FACE), float32: heights and
        energies at each face, the same spread over its neighborhood, quantiles over its island, and what the
        pass before took away. Those of all faces at once would be the largest array of a run.
    graph : FaceGraph
        The faces.
    """

    pairs: NDArray[np.float32]
    context: NDArray[np.float32]
    island: NDArray[np.intp] | None
    block: Callable[[slice, Polygons], NDArray[np.float32]]
    graph: FaceGraph

    @cached_property
    def faces(self) -> NDArray[np.float32]:
        """The inputs of all faces, shape (F, N_FACE)."""
        result = np.empty((self.graph.n_faces, N_FACE), np.float32)

        def fill(faces: slice, polygons: Polygons) -> None:
            result[faces] = self.block(faces, polygons)

        self.graph.for_faces(fill)
        return result


def energy(values: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return log(values^2 + floor)."""
    result = values * values
    result += FLOOR
    return np.log(result, out=result)


def find_features(
    scales: Scales,
    graph: FaceGraph,
    rings: RingMeans,
    at_vertex: Means,
    island: NDArray[np.intp] | None,
    residual: Residual | None = None,
    log_strength: float = 0.0,
    measured: Measured | None = None,
) -> Features:
    """Describe a surface for the net.

    Parameters
    ----------
    scales : Scales
        The surface at all scales.
    graph : FaceGraph
        Pairs of faces.
    rings : RingMeans
        Means over one-rings.
    at_vertex : Means
        Faces of the graph at each vertex.
    island : ndarray, shape (F,), intp, or None
        The island of each face, see `find_islands`; None if there is one.
    residual : Residual, optional
        What the pass before took away.
    log_strength : float
        Logarithm of Strength: added to the logarithms of fine jumps, and half of it to those of heights.
    measured : Measured, optional
        Whose faces count for what is known of islands; by default all.
    """
    n_bands = N_SCALES - 1
    pairs = np.zeros((graph.n_pairs + 1, N_EDGE), np.float32)
    jumps = np.empty((graph.n_pairs + 1, 4), np.float32)
    jumps[-1] = np.log(FLOOR)
    jumps[:, 3] = 0
    normals, centroids = scales.normals, scales.centroids
    area = scales.areas[:, 0].copy()  # `take` would copy all of a strided array for every block

    def across(start: int, stop: int) -> None:
        one, two = graph.first[start:stop], graph.second[start:stop]
        unit = np.float32(0.5) * (scales.length.take(one) + scales.length.take(two))
        bend = np.zeros((stop - start, N_SCALES), np.float32)
        offset = np.zeros_like(bend)
        distance = np.zeros_like(bend)
        jump = np.zeros_like(bend)
        for axis in range(3):
            normal_one = normals[axis].take(one, axis=0)
            normal_two = normals[axis].take(two, axis=0)
            arm = centroids[axis].take(two, axis=0)
            arm -= centroids[axis].take(one, axis=0)
            apart = normal_two - normal_one
            distance += arm * arm
            jump += apart * apart
            apart *= arm
            bend += apart
            normal_one += normal_two
            normal_one *= arm
            offset += normal_one
        jump += FLOOR
        np.log(jump, out=jump)
        jumps[start:stop, :n_bands] = jump[:, :n_bands]
        # Faces in the same place, as doubled ones are, lie in no direction from each other.
        np.maximum(distance, (np.float32(1e-3) * unit[:, None]) ** 2 + np.float32(1e-20), out=distance)
        np.sqrt(distance, out=distance)
        bend /= distance
        part = pairs[start:stop]
        ratio = np.log((area.take(one) + FLOOR) / (area.take(two) + FLOOR))
        part[:, 0] = np.log(distance[:, 0] / unit + np.float32(0.01))
        part[:, 1] = np.abs(ratio, out=ratio)
        part[:, 2 : 2 + n_bands] = bend[:, :n_bands]
        part[:, 2 + n_bands :] = energy(offset[:, :2] / unit[:, None])

    graph.for_pairs(across)
    spread = np.empty((graph.n_faces, N_SPREAD), np.float32)
    is_flat = np.empty(graph.n_faces, bool)

    def heights_of(block: slice) -> NDArray[np.float32]:
        height = np.zeros((block.stop - block.start, N_SCALES), np.float32)
        for axis in range(3):
            center = centroids[axis, block]
            step = np.zeros_like(height)
            step[:, :-1] = center[:, :-1] - center[:, 1:]
            step[:, :-1] *= normals[axis, block, 1:]
            height += step
        height /= scales.length[block, None]
        return height

    def energies_at(block: slice, polygons: Polygons) -> None:
        height = heights_of(block)
        around = jumps.take(polygons.pairs, axis=0)
        energies = around.reshape(len(around), -1).sum(axis=0).reshape(-1, 4)
        energies *= np.float32(1.0 / len(around))
        heights = energy(height)
        own = spread[block]
        own[:, :n_bands] = energies[:, :n_bands]
        own[:, n_bands : 2 * n_bands] = heights[:, :n_bands]
        own[:, -2] = energies[:, 0] ** 2
        own[:, -1] = heights[:, 0] ** 2
        is_flat[block] = (around[..., 0].max(axis=0) < np.log(2 * FLOOR)) & (
            np.abs(height[:, 0]) < np.float32(1e-3)
        )

    graph.for_faces(energies_at)
    counted = counted_faces(island, measured)
    quantiles = np.array([quantiles_of(spread[own], is_flat[own]) for own in counted])
    stronger = quantiles + np.float32(log_strength) * _BY_STRENGTH
    before = np.zeros((graph.n_faces, N_RESIDUAL), np.float32)
    if residual is not None:

        def recall(block: slice, polygons: Polygons) -> None:
            strength = residual.strength.take(polygons.corners).mean(axis=0) / scales.length[block]
            before[block, 0] = energy(strength) / 4 + 1  # 0, as in a first pass, for a usual strength
            before[block, 1] = 2 * residual.correlation.take(polygons.corners).mean(axis=0)

        graph.for_faces(recall)
    means = np.array([before[own].sum(axis=0) / max(len(is_flat[own]), 1) for own in counted], np.float32)
    context = np.concatenate((stronger, means), axis=1)
    at_faces = rings.inward(at_vertex.outward(at_vertex.mean(spread)))
    at_faces = rings.outward(rings.averaged(at_faces, SPREAD_AVERAGES))

    def collect(block: slice, polygons: Polygons) -> NDArray[np.float32]:
        n = block.stop - block.start
        faces = np.empty((n, N_FACE), np.float32)
        unit, height = scales.length[block], heights_of(block)
        faces[:, :n_bands] = height[:, :n_bands]
        faces[:, n_bands : 2 * n_bands] = energy(height)[:, :n_bands]
        for column, (one, two) in enumerate(PAIRS_OF_SCALES, 2 * n_bands):
            apart = np.zeros(n, np.float32)
            for axis in range(3):
                step = normals[axis, block, one] - normals[axis, block, two]
                step *= step
                apart += step
            apart += FLOOR
            faces[:, column] = np.log(apart)
        column = 2 * n_bands + len(PAIRS_OF_SCALES)
        faces[:, column] = np.log(area[block] / (unit * unit) + np.float32(0.01))
        corners = at_faces.take(polygons.corners, axis=0)
        total = corners.reshape(len(corners), -1).sum(axis=0).reshape(-1, N_SPREAD)
        total *= np.float32(1.0 / len(corners))
        # The two second moments become deviations.
        for moment, mean in ((-2, 0), (-1, n_bands)):
            variance = total[:, moment] - total[:, mean] ** 2
            total[:, moment] = np.sqrt(np.maximum(variance, 0))
        if log_strength:
            total[:, :2] += np.float32(2 * log_strength)
            total[:, n_bands : 2 * n_bands] += np.float32(log_strength)
        faces[:, column + 1 : column + 1 + N_SPREAD] = total
        faces[:, column + 1 + N_SPREAD : -N_RESIDUAL] = (
            stronger if island is None else stronger[island[block]]
        )
        faces[:, -N_RESIDUAL:] = before[block]
        return faces

    return Features(pairs, context, island, collect, graph)


_BY_STRENGTH = np.array([2] * 6 + [0] * 3 + [1] * 6 + [0], np.float32)
"""By how much quantiles grow with the logarithm of the noise: fine jumps, heights, but no wide jumps."""


def quantiles_of(
    energies: NDArray[np.float32], is_flat: NDArray[np.bool_], n_samples: int = N_SAMPLES
) -> NDArray[np.float32]:
    """Return quantiles of energies of faces, shape (F, 8), as N_GLOBAL numbers; flat faces do not count.

    They are those of at most `n_samples` faces.
    """
    n_bands = N_SCALES - 1
    counted = np.flatnonzero(~is_flat)
    share = len(counted) / max(len(is_flat), 1)
    if not len(counted):
        counted = np.arange(min(len(is_flat), 1))
    # Evenly spread, so that the sample does not depend on chance.
    chosen = counted[np.linspace(0, len(counted) - 1, min(len(counted), n_samples)).astype(np.intp)]
    ordered = np.sort(energies[chosen][:, : 2 * n_bands], axis=0)
    last = len(ordered) - 1
    jumps = ordered[[round(q * last) for q in (0.25, 0.5, 0.75)], :n_bands]
    heights = ordered[[round(q * last) for q in (0.5, 0.9)], n_bands:]
    return np.array([*jumps.T.ravel(), *heights.T.ravel(), np.log(share + 0.01)], np.float32)
