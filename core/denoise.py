# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Denoise a surface: check, prepare, move the vertices by a method, limit and mend, report."""

from __future__ import annotations

from collections.abc import Callable
from time import perf_counter

import numpy as np
from numpy.typing import DTypeLike, NDArray

from .blocks import Stopped
from .limits.finish import finish
from .limits.region import Region
from .limits.resolved_region import resolve
from .memory import check_memory
from .mesh.connectivity import Connectivity
from .mesh.surface_mesh import SurfaceMesh
from .methods import METHODS
from .methods.problem import Callback
from .preparation_cache import PreparationCache, prepared_for
from .prepared import Prepared, check_given
from .report import DenoiseResult, account, stopped_report
from .settings import DEFAULT_PRESET, PRESETS, DenoiseSettings


def denoise(
    surface: SurfaceMesh,
    settings: DenoiseSettings | None = None,
    *,
    movable: NDArray[np.bool_] | None = None,
    region: Region | None = None,
    connectivity: Connectivity | None = None,
    callback: Callback | None = None,
    should_stop: Callable[[], bool] | None = None,
    dtype: DTypeLike = np.float32,
    prepared: Prepared | PreparationCache | None = None,
    max_bytes: int | None = None,
) -> DenoiseResult:
    """Clean a noisy surface.

    Parameters
    ----------
    surface : SurfaceMesh
        The noisy surface; not modified.
    settings : DenoiseSettings, optional
        The method and its parameters; by default those of the preset AUTO.
    movable : ndarray, shape (N,), bool, optional
        Vertices that may move; all by default. The others are used but stay where they are.
    region : Region, optional
        Weights, feature lines and other limits; by default there are none, and folds are repaired.
    connectivity : Connectivity, optional
        Neighborhoods of the mesh, if they are known already; ignored if the region welds vertices.
    callback : callable, optional
        `callback(fraction, change) -> bool` after each iteration; see `problem.Callback`.
    should_stop : callable, optional
        `should_stop() -> bool`, asked many times a second on the calling thread; True stops.
    dtype : dtype, optional
        Precision of the solver: float32 for speed, float64 for exactness.
    prepared : Prepared or PreparationCache, optional
        What `prepare` made for this mesh and the same stencils, or a cache that supplies it.
    max_bytes : int, optional
        How much memory the run may take; by default there is no limit.

    Returns
    -------
    DenoiseResult
        Positions in the dtype of the input, bit-identical where nothing moved; what was reached if `callback`
        stopped the run, the input if `should_stop` did.

    Raises
    ------
    FrameletError
        In one sentence, if the mesh cannot be denoised, if an argument is of another type or does not fit it,
        or if the run needs more than `max_bytes`.
    """
    began = perf_counter()
    check_given(surface, settings, connectivity, should_stop, callback)
    settings = settings or PRESETS[DEFAULT_PRESET].settings
    resolved = resolve(region, surface, movable)  # what the region says about each vertex
    check_memory(surface, settings, max_bytes)
    try:
        prepared = prepared_for(resolved, settings, connectivity, dtype, should_stop, prepared)
        with prepared.blocks.entered(should_stop, settings.threads) as blocks:
            resolved = resolved.renumbered(prepared.reordering)
            problem = prepared.problem(resolved, settings, blocks, callback)  # in mean edge lengths
            solution = METHODS[settings.method](problem)
            motion = prepared.motion(solution.points, blocks)  # in scene units again
            welded = resolved.welded_mesh(prepared.connectivity, prepared.edge)
            known = prepared.known_faces(resolved)
            finished = finish(motion, welded, resolved, problem.constraints, blocks, known)
            prepared.remember(resolved, finished.flips.before)
            vertices = resolved.in_given_order(finished.vertices)
            report = account(resolved, vertices, finished, problem, solution, began)
    except Stopped:
        return DenoiseResult(surface.vertices.copy(), stopped_report(surface, settings, began))
    return DenoiseResult(vertices, report)
