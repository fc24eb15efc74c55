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
from ..learned.stillness import clean_places, flat_vertices, hardly_moved
from ..noise.field import NoiseBelief, find_belief
from ..settings import DenoiseSettings
from ..surface.connectivity import Connectivity
from ..surface.surface_mesh import SurfaceMesh

WEAKEST = 0.25
"""Strength below which results are mixed with the input instead: nothing is learned of noise that weak."""

FARTHEST = np.float32(30)
"""Displacement in local edge lengths from which a vertex stays: the tip of a spire, no spike of a scan."""

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
    is_movable = np.ones(points.shape[1], bool)
    is_movable[constraints.pinned] = False
    is_free = is_movable.copy()
    unit = np.ones(points.shape[1], np.float32)
    try:
        while n_passes < settings.passes and amount > 0.0 and is_free.any() and engine.graph.n_faces:
            taken = engine.taken(points, fitted) if n_passes else None
            scales, features = engine.describe(fitted, taken, log_strength, width)
            unit = scales.unit
            # Steps of voxels and terraces are flat and smooth as well.
            is_first = n_passes == 0 and settings.noise != "WIDE"
            if is_first:
                is_free &= ~flat_vertices(points, scales, engine.graph)
            tick()
            moved = engine.fit.fit(points, engine.normals(net, scales, features, tick), is_free)
            del scales, features
            constraints.apply(moved, points)
            if is_first:
                is_clean = clean_places(points, surface, connectivity, unit, engine.rings, blocks)
                offsets = engine.offsets(points, moved) / unit
                is_free &= ~hardly_moved(offsets, is_clean, is_free, engine.rings)
            if n_passes == 0:
                step = moved - points
                is_free &= np.sqrt((step * step).sum(axis=0)) < FARTHEST * unit
                moved[:, ~is_free] = points[:, ~is_free]
            fitted, n_passes = moved, n_passes + 1
            tick()
            tick()
    except _Stopped:
        is_stopped = True
    n_still = int(np.count_nonzero(is_movable & ~is_free))
    share_clean = n_still / max(int(np.count_nonzero(is_movable)), 1)
    belief = find_belief(points, fitted, unit, engine, edge, share_clean)
    # The displacement is added, so that what did not move keeps its bits in any precision.
    change = (fitted - points).astype(noisy.dtype)
    change *= noisy.dtype.type(amount)
    return Learned(noisy + change, n_passes, is_stopped, belief)
