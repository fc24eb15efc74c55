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

N_BANDS = N_SCALES - 1
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
    pairs, jumps = _pair_features(scales, graph)
    energies, is_flat = _energies(scales, graph, jumps)
    counted = counted_faces(island, measured)
    quantiles = np.array([quantiles_of(energies[own], is_flat[own]) for own in counted])
    quantiles += np.float32(log_strength) * _BY_STRENGTH
    before = _before(scales, graph, residual)
    means = np.array([before[own].sum(axis=0) / max(len(is_flat[own]), 1) for own in counted], np.float32)
    around = rings.inward(at_vertex.outward(at_vertex.mean(energies)))
    around = rings.outward(rings.averaged(around, SPREAD_AVERAGES))

    def block(faces: slice, polygons: Polygons) -> NDArray[np.float32]:
        result = np.empty((faces.stop - faces.start, N_FACE), np.float32)
        end = N_FACE - N_SPREAD - N_GLOBAL - N_RESIDUAL
        _face_scalars(scales, faces, result[:, :end])
        result[:, end : end + N_SPREAD] = _spread(around, polygons, log_strength)
        of_island = quantiles if island is None else quantiles[island[faces]]
        result[:, end + N_SPREAD : -N_RESIDUAL] = of_island
        result[:, -N_RESIDUAL:] = before[faces]
        return result

    return Features(pairs, np.concatenate((quantiles, means), axis=1), island, block, graph)


def _pair_features(scales: Scales, graph: FaceGraph) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Return the inputs of pairs (P + 1, N_EDGE), and their jump energies, shape (P + 1, 4)."""
    pairs = np.zeros((graph.n_pairs + 1, N_EDGE), np.float32)
    jumps = np.empty((graph.n_pairs + 1, 4), np.float32)  # the last column makes looking up faster
    jumps[-1] = np.log(FLOOR)
    jumps[:, 3] = 0
    normals, centroids = scales.normals, scales.centroids
    area = scales.areas[:, 0].copy()  # `take` would copy all of a strided array for every block

    def kernel(start: int, stop: int) -> None:
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
        jumps[start:stop, :N_BANDS] = jump[:, :N_BANDS]
        # Faces in the same place, as doubled ones are, lie in no direction from each other.
        np.maximum(distance, (np.float32(1e-3) * unit[:, None]) ** 2 + np.float32(1e-20), out=distance)
        np.sqrt(distance, out=distance)
        bend /= distance
        part = pairs[start:stop]
        ratio = np.log((area.take(one) + FLOOR) / (area.take(two) + FLOOR))
        part[:, 0] = np.log(distance[:, 0] / unit + np.float32(0.01))
        part[:, 1] = np.abs(ratio, out=ratio)
        part[:, 2 : 2 + N_BANDS] = bend[:, :N_BANDS]
        part[:, 2 + N_BANDS :] = energy(offset[:, :2] / unit[:, None])

    graph.for_pairs(kernel)
    return pairs, jumps


def _heights(scales: Scales, faces: slice) -> NDArray[np.float32]:
    """Return <V_(s+1), c_s - c_(s+1)> of some faces in local units, shape (n, S); 0 for the widest scale."""
    height = np.zeros((faces.stop - faces.start, N_SCALES), np.float32)
    for axis in range(3):
        center = scales.centroids[axis, faces]
        step = np.zeros_like(height)
        step[:, :-1] = center[:, :-1] - center[:, 1:]
        step[:, :-1] *= scales.normals[axis, faces, 1:]
        height += step
    height /= scales.length[faces, None]
    return height


def _energies(
    scales: Scales, graph: FaceGraph, jumps: NDArray[np.float32]
) -> tuple[NDArray[np.float32], NDArray[np.bool_]]:
    """Return energies of faces, and which faces are flat, shape (F,).

    The energies, shape (F, N_SPREAD), are those of jumps, of heights, and squares of the finest of both.
    """
    energies = np.empty((graph.n_faces, N_SPREAD), np.float32)
    is_flat = np.empty(graph.n_faces, bool)

    def kernel(faces: slice, polygons: Polygons) -> None:
        height = _heights(scales, faces)
        around = jumps.take(polygons.pairs, axis=0)
        mean = around.reshape(len(around), -1).sum(axis=0).reshape(-1, 4)
        mean *= np.float32(1.0 / len(around))
        heights = energy(height)
        own = energies[faces]
        own[:, :N_BANDS] = mean[:, :N_BANDS]
        own[:, N_BANDS : 2 * N_BANDS] = heights[:, :N_BANDS]
        own[:, -2] = mean[:, 0] ** 2
        own[:, -1] = heights[:, 0] ** 2
        is_flat[faces] = (around[..., 0].max(axis=0) < np.log(2 * FLOOR)) & (
            np.abs(height[:, 0]) < np.float32(1e-3)
        )

    graph.for_faces(kernel)
    return energies, is_flat


def _before(scales: Scales, graph: FaceGraph, residual: Residual | None) -> NDArray[np.float32]:
    """Return what the pass before took away around each face, shape (F, N_RESIDUAL); 0 in a first pass."""
    before = np.zeros((graph.n_faces, N_RESIDUAL), np.float32)
    if residual is None:
        return before

    def kernel(faces: slice, polygons: Polygons) -> None:
        strength = residual.strength.take(polygons.corners).mean(axis=0) / scales.length[faces]
        before[faces, 0] = energy(strength) / 4 + 1  # 0, as in a first pass, for a usual strength
        before[faces, 1] = 2 * residual.correlation.take(polygons.corners).mean(axis=0)

    graph.for_faces(kernel)
    return before


def _face_scalars(scales: Scales, faces: slice, out: NDArray[np.float32]) -> None:
    """Write heights, energies of them and of V_a - V_b for pairs of scales, and the logarithm of the area."""
    unit, height, normals = scales.length[faces], _heights(scales, faces), scales.normals
    out[:, :N_BANDS] = height[:, :N_BANDS]
    out[:, N_BANDS : 2 * N_BANDS] = energy(height)[:, :N_BANDS]
    for column, (one, two) in enumerate(PAIRS_OF_SCALES, 2 * N_BANDS):
        apart = np.zeros(len(out), np.float32)
        for axis in range(3):
            step = normals[axis, faces, one] - normals[axis, faces, two]
            step *= step
            apart += step
        apart += FLOOR
        out[:, column] = np.log(apart)
    out[:, -1] = np.log(scales.areas[faces, 0] / (unit * unit) + np.float32(0.01))


def _spread(around: NDArray[np.float32], polygons: Polygons, log_strength: float) -> NDArray[np.float32]:
    """Return energies of the surroundings of some faces, shape (n, N_SPREAD), by those at their corners."""
    corners = around.take(polygons.corners, axis=0)
    total = corners.reshape(len(corners), -1).sum(axis=0).reshape(-1, N_SPREAD)
    total *= np.float32(1.0 / len(corners))
    # The two second moments become deviations.
    for moment, mean in ((-2, 0), (-1, N_BANDS)):
        variance = total[:, moment] - total[:, mean] ** 2
        total[:, moment] = np.sqrt(np.maximum(variance, 0))
    if log_strength:
        total[:, :2] += np.float32(2 * log_strength)
        total[:, N_BANDS : 2 * N_BANDS] += np.float32(log_strength)
    return total


_BY_STRENGTH = np.array([2] * 6 + [0] * 3 + [1] * 6 + [0], np.float32)
"""By how much quantiles grow with the logarithm of the noise: fine jumps, heights, but no wide jumps."""


def quantiles_of(
    energies: NDArray[np.float32], is_flat: NDArray[np.bool_], n_samples: int = N_SAMPLES
) -> NDArray[np.float32]:
    """Return quantiles of energies of faces, shape (F, 8), as N_GLOBAL numbers; flat faces do not count.

    They are those of at most `n_samples` faces.
    """
    counted = np.flatnonzero(~is_flat)
    share = len(counted) / max(len(is_flat), 1)
    if not len(counted):
        counted = np.arange(min(len(is_flat), 1))
    # Evenly spread, so that the sample does not depend on chance.
    chosen = counted[np.linspace(0, len(counted) - 1, min(len(counted), n_samples)).astype(np.intp)]
    ordered = np.sort(energies[chosen][:, : 2 * N_BANDS], axis=0)
    last = len(ordered) - 1
    jumps = ordered[[round(q * last) for q in (0.25, 0.5, 0.75)], :N_BANDS]
    heights = ordered[[round(q * last) for q in (0.5, 0.9)], N_BANDS:]
    return np.array([*jumps.T.ravel(), *heights.T.ravel(), np.log(share + 0.01)], np.float32)
