# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Learned shrinkage, the method AUTO: clean the normals of the faces, fit the vertices, do it once more.

A pass looks at the surface at several scales (`learned.scales`), describes it by numbers that do not depend
on pose, size or numbering (`learned.features`), shrinks the differences of neighboring normals by gains that
a small net makes of them (`learned.net`), and moves the vertices to where the faces have these normals
(`learned.screened_fit`). The next pass looks at the result of the one before; vertices are always fitted from
where they were, less noise along the surface (`learned.tangential_noise`). What is clean stays put
(`learned.clean_parts`).
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from ..learned.clean_parts import clean_places, flat_vertices, hardly_moved
from ..learned.engine import FaceEngine
from ..learned.measured import counted_faces
from ..learned.net import N_LAYERS, load_net
from ..learned.noise_field import find_belief
from ..learned.residual import Residual
from ..learned.tangential_noise import tangential_step
from ..learned.width import shared_share, strong_share
from ..noise import ROUNDED, find_steps, rounding_noise
from .problem import Problem, Solution, rms_motion

WEAKEST = 0.25
"""Strength below which results are mixed with the input instead: nothing is learned of noise that weak."""

TICKS = N_LAYERS + 2
"""Steps of a pass that are told: features, layers, fit."""

FARTHEST = np.float32(30)
"""Displacement in local edge lengths from which a vertex stays: the tip of a spire, no spike of a scan."""

LEAST_ROUNDING = 0.03
"""Rounding that brings less noise, in mean edge lengths, is as good as none."""

ROUNDED_SHARE = 0.45
"""Share of the noise of rounding from which a pass has found it: 0.42 to 1 on rounded shapes, 0.25 at most on
shapes whose vertices stand in steps of their own."""


class _Stopped(Exception):
    """Raised inside when the callback asks to stop."""


def shrink_normals(problem: Problem) -> Solution:
    """Clean a surface.

    Parameters
    ----------
    problem : Problem
        With the tables of faces and the settings `strength`, `noise`, `passes`.

    Returns
    -------
    Solution
        With a `NoiseBelief`. If the run was stopped in the first pass, the noisy positions.
    """
    noisy, settings, engine = problem.noisy, problem.settings, problem.engine
    assert engine is not None
    points = np.ascontiguousarray(noisy, np.float32)
    run = _Run(points, engine, problem)
    amount = min(settings.strength / WEAKEST, 1.0)
    fitted, n_passes, is_stopped = points, 0, False
    try:
        if amount > 0.0 and engine.graph.n_faces:
            # Steps of voxels and terraces, which are wide noise, are flat and smooth: nothing is still.
            fitted = run.next_pass(points) if settings.noise == "WIDE" else run.first_pass()
            n_passes = 1
            while n_passes < settings.passes and run.is_free.any():
                guide = run.evened(fitted) if n_passes == 1 else fitted
                fitted, n_passes = run.next_pass(guide), n_passes + 1
    except _Stopped:
        is_stopped = True
    if not run.is_free.any():
        n_passes = 0  # one was needed to find out that there is nothing to do
    belief = find_belief(
        points, fitted, run.unit, engine, problem.edge, run.share_clean(), measured=run.measured
    )
    belief = replace(
        belief,
        shared=run.shared,
        wide=run.wide,
        along=run.along if n_passes > 1 else 0.0,
        steps=run.steps or ("" if settings.noise == "WIDE" else find_steps(problem.surface)),
    )
    # Of a mesh that is clean already the lines, which were smoothed before, stay as well.
    start = problem.given if belief.is_clean else noisy
    # The displacement is added, so that what did not move keeps its bits in any precision.
    change = (fitted - points).astype(noisy.dtype)
    change *= noisy.dtype.type(amount)
    return Solution(start + change, n_passes, is_stopped, settings, belief)


class _Run:
    """Passes over a mesh, which of its vertices are free, and how wide the noise is at its faces."""

    def __init__(self, points: NDArray[np.float32], engine: FaceEngine, problem: Problem) -> None:
        self.points, self.engine, self._problem = points, engine, problem
        self._held = points
        self.shared, self.along, self.steps = 0.0, 0.0, ""
        self._change = math.nan  # nothing has moved yet
        self._done, self._n_left = 0.0, float(TICKS * problem.settings.passes)
        self._log_strength = math.log(max(problem.settings.strength, WEAKEST))
        self._wide = np.array([problem.settings.noise == "WIDE"], np.float32)
        self._is_movable = np.ones(points.shape[1], bool)
        self._is_movable[problem.constraints.pinned] = False
        self.is_free = self._is_movable.copy()
        self.unit = np.ones(points.shape[1], np.float32)
        self.measured = None if problem.movable is None else engine.measured(problem.movable)

    def evened(self, fitted: NDArray[np.float32]) -> NDArray[np.float32]:
        """Return the positions, shape (3, N), less noise along the surface; later passes hold vertices so."""
        step = tangential_step(self.points, fitted, self.unit, self.engine, self.measured)
        if step is None:
            return fitted
        step *= np.float32(min(math.exp(self._log_strength), 1.0))
        step[:, ~self.is_free] = 0
        self._held = self.points + step
        self.along = float(np.sqrt(np.square(step, dtype=np.float64).sum(axis=0).mean()))
        return fitted + step

    def share_clean(self) -> float:
        """Return the share of the vertices that may move and stay because they are clean."""
        n_still = int(np.count_nonzero(self._is_movable & ~self.is_free))
        return n_still / max(int(np.count_nonzero(self._is_movable)), 1)

    @property
    def wide(self) -> float:
        """The share of the faces whose noise is taken for wide."""
        return float(self._wide.mean())

    def first_pass(self) -> NDArray[np.float32]:
        """Find what is still and, with AUTO, what is wide; return the positions, shape (3, N), after a pass.

        Both are seen in passes of Strength 1, so that what noise is does not depend on how much is removed.
        """
        self._n_left += 1  # of the question whether one more pass is needed
        rounded = self._rounded() if self._problem.settings.noise == "AUTO" else None
        if rounded is not None:
            first = rounded
        else:
            first = self._passed(self.points, np.zeros(1, np.float32), is_first=True)
            if self._problem.settings.noise == "AUTO":
                first = self._with_width(first)
            first = self._still(first)
        # A pass of the strength that is wanted, by the one net that is wanted everywhere, is known already.
        is_one_net = self._wide.min() == self._wide.max() and self._wide[0] in (0, 1)
        if is_one_net and self._problem.settings.strength == 1.0:
            self._tick()
            return first
        self._n_left += TICKS
        self._tick()
        return self.next_pass(self.points)

    def next_pass(self, fitted: NDArray[np.float32]) -> NDArray[np.float32]:
        """Return the positions, shape (3, N), after a pass that is guided by fitted ones."""
        return self._passed(fitted, self._wide, self._log_strength)

    def _rounded(self) -> NDArray[np.float32] | None:
        """Return the positions, shape (3, N), after a pass for wide noise if coordinates are rounded.

        They are if it takes away as much as rounding to the steps in which they stand would have brought.
        Then nothing is still: facets of rounded places are flat.
        """
        noise = rounding_noise(self._problem.surface)
        if noise < LEAST_ROUNDING or not self._is_movable.any():
            return None
        self._n_left += TICKS
        wide = self._passed(self.points, np.ones(1, np.float32))
        taken = (wide - self.points)[:, self._is_movable]
        if not np.sqrt(np.square(taken, dtype=np.float64).sum(axis=0).mean()) > ROUNDED_SHARE * noise:
            return None
        self._wide, self.steps = np.ones(1, np.float32), ROUNDED
        return wide

    def _with_width(self, fine: NDArray[np.float32]) -> NDArray[np.float32]:
        """Find what is wide, by the positions after a pass for fine noise and, if needed, one for wide noise.

        Returned are the positions, shape (3, N), of that which fits.
        """
        engine, wide = self.engine, None
        counted = counted_faces(engine.island, self.measured)
        share = shared_share(self._residual(fine), self.unit, engine.graph, counted)
        self.shared = float(self._at_faces(share).mean())
        if share.any():
            self._n_left += TICKS
            wide = self._passed(self.points, np.ones(1, np.float32))
            share *= strong_share(self._residual(wide), self.unit, engine.graph, counted)
        self._wide = self._at_faces(share)
        return wide if wide is not None and share.any() else fine

    def _at_faces(self, share: NDArray[np.float32]) -> NDArray[np.float32]:
        """Return for the faces, shape (F,) or (1,), what holds for each island, shape (I,)."""
        return share if self.engine.island is None else share[self.engine.island]

    def _still(self, moved: NDArray[np.float32]) -> NDArray[np.float32]:
        """Find what is still, by the positions after a first pass, and put it back."""
        is_clean = clean_places(
            self.points,
            self._problem.surface,
            self._problem.connectivity,
            self.unit,
            self.engine.rings,
            self._problem.blocks,
            self.measured,
        )
        offsets = self.engine.offsets(self.points, moved) / self.unit
        self.is_free &= ~hardly_moved(
            offsets, is_clean, self.is_free, self.engine.rings, self._problem.movable
        )
        moved[:, ~self.is_free] = self.points[:, ~self.is_free]
        return moved

    def _residual(self, fitted: NDArray[np.float32]) -> Residual:
        """Return what was taken away so far."""
        return self.engine.residual(self._held, fitted, self.measured)

    def _passed(
        self,
        points: NDArray[np.float32],
        wide: NDArray[np.float32],
        log_strength: float = 0.0,
        *,
        is_first: bool = False,
    ) -> NDArray[np.float32]:
        """Return the positions, shape (3, N), after a pass; `wide`, (1,) or (F,), is that net's share."""
        residual = None if points is self.points else self._residual(points)
        scales, features = self.engine.describe(points, residual, log_strength, self.measured)
        self.unit = scales.unit
        if is_first:
            self.is_free &= ~flat_vertices(points, scales, self.engine.graph, self.measured)
        self._tick()
        fine, tick = None, self._tick
        if 0 < wide.mean() < 1:
            tick = partial(self._tick, 0.5)  # for each of the two nets
            own = scales._replace(normals=scales.normals.copy())
            fine = load_net("fine").normals(own, features, self.engine.graph, tick)
            fine *= 1 - wide
        begun = load_net("wide" if wide.any() else "fine").begun(scales, features, self.engine.graph)
        del scales, features  # a third of the memory
        normals = begun.normals(tick)
        if fine is not None:
            normals *= wide
            normals += fine
            normals /= np.sqrt((normals * normals).sum(axis=0)) + np.float32(1e-6)
        return self._fitted(normals, points)

    def _fitted(self, normals: NDArray[np.float32], guide: NDArray[np.float32]) -> NDArray[np.float32]:
        """Return the vertices, shape (3, N), whose faces have these normals, which are those of a guide."""
        moved = self.engine.fit.fit(self._held, normals, self.is_free, self.unit)
        self._problem.constraints.apply(moved, self.points)
        step = moved - self.points
        is_far = np.sqrt((step * step).sum(axis=0)) > FARTHEST * self.unit
        moved[:, is_far] = self.points[:, is_far]
        self._change = rms_motion(moved, guide, self._problem.blocks)
        self._tick()
        return moved

    def _tick(self, n_steps: float = 1.0) -> None:
        """Tell that a step, or a part of one, is done; which share it has depends on how many are left."""
        self._done += (1 - self._done) * n_steps / self._n_left
        self._n_left -= n_steps
        callback = self._problem.callback
        if callback is not None and callback(min(self._done, 1.0), self._change):
            raise _Stopped
