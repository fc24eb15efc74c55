# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Learned shrinkage, the method AUTO: clean the normals of the faces, fit the vertices, do it once more.

A pass looks at the surface at several scales (`learned.scales`), describes it by numbers that do not depend
on pose, size or numbering (`learned.features`), shrinks the differences of neighboring normals by gains that
a small net makes of them (`learned.net`), and moves the vertices to where the faces have these normals
(`learned.screened_fit`). The next pass looks at the result of the one before; vertices are always fitted from
where they were. What is clean stays put (`learned.stillness`).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..denoising.constraints import Constraints
from ..denoising.report import Callback
from ..learned.engine import FaceEngine
from ..learned.net import REPEATS, load_net
from ..noise.field import NoiseBelief, find_belief
from ..settings import DenoiseSettings
from ..surface.connectivity import Connectivity
from ..surface.surface_mesh import SurfaceMesh

WEAKEST = 0.25
"""Strength below which results are mixed with the input instead: nothing is learned of noise that weak."""

LEAST_NOISE = 0.01
"""Rms displacement along the normals, in local edge lengths, up to which a pass found no noise."""

LEAST_BESIDE_CLEAN, CLEAN_SHARE = 0.03, 0.25
"""The same where at least such a share of the vertices is clean: the rest are creases."""

WIDTHS = {"AUTO": 0.0, "FINE": -1.0, "WIDE": 1.0}


class Learned(NamedTuple):
    """What learned shrinkage gives back: positions (3, N), passes that ran, and what it took for noise."""

    points: NDArray[np.floating]
    iterations: int
    is_stopped: bool
    belief: NoiseBelief


class _Stopped(Exception):
    """Raised inside when the callback asks to stop."""


def learned_shrinkage(
    noisy: NDArray[np.floating],
    surface: SurfaceMesh,
    connectivity: Connectivity,
    engine: FaceEngine,
    edge: float,
    settings: DenoiseSettings,
    constraints: Constraints,
    blocks: Blocks,
    callback: Callback | None = None,
) -> Learned:
    """Clean a surface.

    Parameters
    ----------
    noisy : ndarray, shape (3, N)
        Noisy positions in mean edge lengths; not modified.
    surface : SurfaceMesh
        The mesh, for its faces.
    connectivity : Connectivity
        Its neighborhoods.
    engine : FaceEngine
        Its tables.
    edge : float
        Mean edge length in scene units.
    settings : DenoiseSettings
        `strength`, `noise`, `passes`.
    constraints : Constraints
        Vertices that may not move freely.
    blocks : Blocks
        Threads to work on.
    callback : callable, optional
        See `report.Callback`.

    Returns
    -------
    Learned
        If the run was stopped in the first pass, the noisy positions.
    """
    points = np.ascontiguousarray(noisy, np.float32)
    total, done = settings.passes * (len(REPEATS) + 3), 0

    def tick() -> None:
        nonlocal done
        done += 1
        if callback is not None and callback(min(done / total, 1.0), 0.0):
            raise _Stopped

    net = load_net()
    amount = min(settings.strength / WEAKEST, 1.0)
    log_strength = math.log(max(settings.strength, WEAKEST))
    width = WIDTHS[settings.noise]
    fitted, n_passes, is_stopped = points, 0, False
    is_free = np.ones(points.shape[1], bool)
    is_free[constraints.pinned] = False
    share_clean, unit = 0.0, np.ones(points.shape[1], np.float32)
    try:
        while n_passes < settings.passes and amount > 0.0 and engine.graph.n_faces:
            scales, features = engine.describe(fitted, log_strength, width)
            tick()
            # Steps of voxels and terraces are flat and smooth as well.
            if n_passes == 0 and settings.noise != "WIDE":
                is_still = engine.find_still(points, surface, connectivity, scales, blocks)
                is_free &= ~is_still
                share_clean = float(is_still[~connectivity.is_loose].mean())
                if not is_free.any():
                    break
            moved = engine.fit.fit(points, engine.normals(net, scales, features, tick), is_free)
            unit = scales.unit
            del scales, features
            constraints.apply(moved, points)
            if n_passes == 0 and settings.noise != "WIDE":
                offsets = (engine.offsets(points, moved) / unit)[is_free]
                least = LEAST_BESIDE_CLEAN if share_clean >= CLEAN_SHARE else LEAST_NOISE
                if np.sqrt(np.mean(np.square(offsets, dtype=np.float64))) < least:
                    share_clean = 1.0
                    break
            fitted, n_passes = moved, n_passes + 1
            tick()
            tick()
    except _Stopped:
        is_stopped = True
    belief = find_belief(points, fitted, unit, engine, edge, share_clean)
    # The displacement is added, so that what did not move keeps its bits in any precision.
    change = (fitted - points).astype(noisy.dtype)
    change *= noisy.dtype.type(amount)
    return Learned(noisy + change, n_passes, is_stopped, belief)
