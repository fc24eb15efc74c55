# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The position engine with other shrinkages and in several rounds, as plain as possible.

With soft shrinkage and one round it does what `denoise` does, but for the repair of folds; a test compares.
"""

from collections.abc import Sequence

import numpy as np
import position_sources  # noqa: F401
from framelet.core import (
    Connectivity,
    DenoiseSettings,
    FrameTransform,
    Prepared,
    SurfaceMesh,
    make_transform,
    prepare,
)
from framelet.core.denoising.constraints import Constraints, find_constraints
from framelet.core.denoising.shrinkage import SEPARABLE
from framelet.core.transform import choose_frame
from framelet.core.transform.level import Chunk, Level
from variants import Variant


class Problem:
    """A noisy mesh, and the transforms that were made for it."""

    def __init__(self, noisy: SurfaceMesh, connectivity: Connectivity) -> None:
        self.noisy = noisy
        self.connectivity = connectivity
        self._prepared: dict[tuple, Prepared] = {}

    def prepared(self, settings: DenoiseSettings) -> Prepared:
        """Return normalized space and the transform for some settings."""
        key = (settings.frame, settings.stencil, settings.levels, settings.shrinkage in SEPARABLE)
        if key not in self._prepared:
            self._prepared[key] = prepare(self.noisy, settings, connectivity=self.connectivity)
        return self._prepared[key]


def denoised(problem: Problem, variant: Variant, settings: DenoiseSettings) -> np.ndarray:
    """Return positions, shape (N, 3), denoised by a variant, with its settings and some λ."""
    prepared = problem.prepared(settings)
    noisy, transform = prepared.noisy, prepared.transform
    constraints = find_constraints(
        problem.noisy, problem.connectivity, settings, None, noisy.dtype, prepared.corners
    )
    points = noisy
    for number in range(variant.rounds):
        if number and variant.refreshes:
            transform = _transform_on(points, problem, settings)
        is_reweighted = number > 0 and variant.reweights
        known = transform.analyze(points.T).chunks if is_reweighted else [None] * settings.levels
        visits = [
            Shrinkage(
                level,
                settings.shrinkage,
                settings.lambda_ / settings.mu * variant.decay**index,
                variant.firm,
                known[index],
            )
            for index, level in enumerate(transform.levels)
        ]
        points = _iterate(noisy, transform, visits, constraints, settings)
    motion = (points.astype(np.float64) - noisy) * prepared.edge
    return problem.noisy.vertices + motion.T


def _transform_on(points: np.ndarray, problem: Problem, settings: DenoiseSettings) -> FrameTransform:
    """Return a transform with stencils that are chosen on some positions, shape (3, N)."""
    return make_transform(
        problem.noisy.with_vertices(np.ascontiguousarray(points.T, np.float64)),
        choose_frame(settings.frame, problem.connectivity),
        settings.stencil,
        settings.levels,
        boundary=settings.boundary,
        connectivity=problem.connectivity,
        dtype=points.dtype,
        only_used_bands=settings.shrinkage in SEPARABLE,
    )


def _iterate(
    noisy: np.ndarray,
    transform: FrameTransform,
    visits: Sequence["Shrinkage"],
    constraints: Constraints,
    settings: DenoiseSettings,
) -> np.ndarray:
    """Return the last iterate of split Bregman, shape (3, N); the first one is the noisy surface."""
    mu = noisy.dtype.type(settings.mu)
    current = noisy
    for _ in range(1, settings.iterations):
        change = transform.rebuild_changes(current, visits)
        current = (noisy + mu * (current + change)) / (1 + mu)
        constraints.apply(current, noisy)
    return current


class Shrinkage:
    """Turns the bands W S of one level into b - 2 b', where b' is the new b, and keeps that; a `Visit`.

    Parameters
    ----------
    level : Level
        Knows groups of bands, and the bands that are left alone.
    kind : {"BANDS", "VECTOR", "SCALAR"}
        What is shrunk together.
    threshold : float
        ν > 0.
    firm : float
        See `Variant`.
    known : sequence of ndarray, optional
        Bands of an earlier result, chunk by chunk: a coefficient has the threshold ν / (1 + |known| / ν), so
        that one which was as long as ν gets half of it.
    """

    def __init__(
        self,
        level: Level,
        kind: str,
        threshold: float,
        firm: float = 0.0,
        known: Sequence[Chunk] | None = None,
    ) -> None:
        self._level, self._kind, self._firm = level, kind, firm
        nu = np.float32(threshold)
        self._thresholds: list = [nu] * len(level.sites)
        if known is not None:
            lengths = [norms(chunk, kind, level.group_starts(i)) for i, chunk in enumerate(known)]
            self._thresholds = [nu / (1 + length / nu) for length in lengths]
        self._residual: list = [np.float32(0.0)] * len(level.sites)

    def __call__(self, index: int, high: Chunk) -> None:
        """Replace the high bands of one chunk, in place."""
        raised = high + self._residual[index]
        length = norms(raised, self._kind, self._level.group_starts(index))
        taken = taken_away(length, self._thresholds[index], self._firm)
        cut = raised * (taken / np.maximum(length, np.finfo(length.dtype).tiny))
        cut[:, self._level.unpenalized(index)] = 0
        high[:] = self._residual[index] - 2 * cut
        self._residual[index] = cut


def taken_away(length: np.ndarray, threshold: np.ndarray | np.floating, firm: float) -> np.ndarray:
    """Return by how much shrinkage shortens lengths: soft, or firm if `firm` is not 0.

    Firm shrinkage (Gao and Bruce 1997) takes away all up to ν and nothing from `firm` times ν on; between
    them what is left grows evenly.
    """
    if not firm:
        return np.minimum(length, threshold)
    return np.clip((firm * threshold - length) / (firm - 1), 0, length)


def norms(bands: Chunk, kind: str, group_starts: np.ndarray | None) -> np.ndarray:
    """Return the lengths of what is shrunk together, in a shape that fits the bands, (3, H, n)."""
    if kind == "SCALAR":
        return np.abs(bands)
    squares = np.square(bands).sum(axis=1 if kind == "BANDS" else 0, keepdims=True)
    if kind == "VECTOR" and group_starts is not None and bands.shape[1]:
        sizes = np.diff(group_starts, append=bands.shape[1])
        squares = np.repeat(np.add.reduceat(squares, group_starts, axis=1), sizes, axis=1)
    return np.sqrt(squares)
