# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Denoise a surface: from positions and settings to clean positions and a report."""

from __future__ import annotations

from collections.abc import Callable
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

from .blocks import Blocks, Stopped
from .limits.constraints import find_constraints
from .limits.finish import Finished, finish
from .limits.lines import find_lines, smoothing_of
from .limits.placed import Placed, place
from .limits.region import Region
from .memory import check_memory
from .mesh.connectivity import Connectivity
from .mesh.surface_mesh import SurfaceMesh
from .methods.bilateral import bilateral_filter
from .methods.learned_shrinkage import learned_shrinkage
from .methods.split_bregman import split_bregman
from .methods.tuning import tuned
from .noise import NoiseEstimate, estimate_noise
from .preparation_cache import PreparationCache
from .prepared import Prepared, prepare
from .report import Callback, DenoiseReport, DenoiseResult, stopped_report
from .settings import DEFAULT_PRESET, PRESETS, DenoiseSettings
from .transform import choose_frame


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
) -> DenoiseResult:
    """Clean a noisy surface.

    Parameters
    ----------
    surface : SurfaceMesh
        The noisy surface; not modified.
    settings : DenoiseSettings, optional
        The algorithm and its parameters; by default those of the preset AUTO.
    movable : ndarray, shape (N,), bool, optional
        Vertices that may move; all by default. The others are used but stay where they are.
    region : Region, optional
        Weights, feature lines and other limits; by default there are none, and folds are repaired.
    connectivity : Connectivity, optional
        Neighborhoods of the mesh, if they are known already; not looked at if the region welds vertices.
    callback : callable, optional
        `callback(fraction, change) -> bool` after each iteration; see `report.Callback`.
    should_stop : callable, optional
        `should_stop() -> bool`, asked many times a second on the calling thread, also while the mesh is
        prepared and the noise measured; True stops.
    dtype : dtype, optional
        Precision of the solver: float32 for speed, float64 for exactness.
    prepared : Prepared or PreparationCache, optional
        What `prepare` made for this mesh and the same stencils, so that runs with other λ, μ and the like
        need not make it again; or a cache that sees to it.

    Returns
    -------
    DenoiseResult
        Positions in the dtype of the input; vertices that did not move have the same bits. If `callback`
        stopped the run they are what was reached, if `should_stop` did, the input.

    Raises
    ------
    ValueError
        In one sentence, if the mesh has no faces, no size or positions that are not finite, if `movable`
        has the wrong shape or selects nothing, if the region does not fit the mesh, if `prepared` is for
        another mesh or other stencils, or if the run needs more memory than there is.

    Notes
    -----
    The solver works around the center of the mesh and in units of the mean edge length, so that results do
    not depend on where the mesh is and how large. Displacements are added to the input, not positions scaled
    back, so that no digit is lost where nothing moves.
    """
    began = perf_counter()
    settings = settings or PRESETS[DEFAULT_PRESET].settings
    if movable is not None:
        _check_movable(movable, surface.n_vertices)
    region = region or Region()
    placed = place(region, surface, movable)
    dtype = np.dtype(dtype)
    check_memory(surface.n_vertices, surface.n_corners, settings)
    try:
        return _denoise(placed, settings, region, connectivity, callback, should_stop, dtype, prepared, began)
    except Stopped:
        return DenoiseResult(
            surface.vertices.copy(), stopped_report(surface, settings, perf_counter() - began)
        )


def _denoise(
    placed: Placed,
    settings: DenoiseSettings,
    region: Region,
    connectivity: Connectivity | None,
    callback: Callback | None,
    should_stop: Callable[[], bool] | None,
    dtype: np.dtype,
    prepared: Prepared | PreparationCache | None,
    began: float,
) -> DenoiseResult:
    """Denoise with checked arguments; raises `Stopped` where `should_stop` says so."""
    surface = placed.surface
    if placed.weld is not None:
        connectivity = None
    if isinstance(prepared, PreparationCache):
        prepared = prepared.prepare(surface, settings, dtype, should_stop)
    elif prepared is None:
        prepared = prepare(surface, settings, connectivity=connectivity, dtype=dtype, should_stop=should_stop)
    elif not prepared.fits(surface, settings, dtype):
        raise ValueError("This was prepared for another mesh or other stencils; prepare it again.")
    ordered, noisy, connectivity = prepared.ordered, prepared.noisy, prepared.connectivity
    placed = placed.renumbered(prepared.reordering)
    with prepared.blocks.with_threads(settings.threads).stopped_by(should_stop) as blocks:
        constraints = find_constraints(
            ordered, connectivity, settings, placed.movable, dtype, prepared.corners
        )
        n_line_vertices = 0
        if placed.feature_edges is not None:
            lines = find_lines(noisy, placed.feature_edges, constraints.pinned)
            noisy = noisy.copy()
            noisy[:, lines.inner] += smoothing_of(prepared.noisy, lines, _line_strength(settings)).astype(
                dtype
            )
            constraints = constraints.with_pinned(lines.vertices)
            n_line_vertices = len(lines.vertices)
        noise: NoiseEstimate | None = None
        if settings.method == "POSITIONS" and settings.tuning == "NOISE":
            noise = estimate_noise(ordered, connectivity, blocks)
            settings = tuned(settings, choose_frame(settings.frame, connectivity), noise)
        if settings.method == "AUTO":
            assert prepared.engine is not None
            found = learned_shrinkage(
                noisy,
                ordered,
                connectivity,
                prepared.engine,
                prepared.edge,
                settings,
                constraints,
                blocks,
                callback,
            )
            noise = found.belief
            # Of a mesh that is clean already the lines, which were smoothed before, stay as well.
            points = prepared.noisy if found.belief.is_clean else found.points
            solved = points, found.iterations, found.is_stopped
        elif settings.method == "BILATERAL":
            solved = bilateral_filter(noisy, ordered, connectivity, settings, constraints, blocks, callback)
        elif settings.lambda_ == 0.0:
            solved = noisy, settings.iterations, False  # nothing is shrunk, so nothing moves
        else:
            assert prepared.transform is not None
            solved = split_bregman(noisy, prepared.transform, settings, constraints, blocks, callback)
        points, iterations, is_stopped = solved
        motion = _motion(points, prepared, blocks)
        carrier = placed.carrier(connectivity, prepared.edge)
        # What is known of the faces is known of a mesh that moves as it is.
        faces = prepared.faces if placed.weld is None else []
        finished = finish(
            motion,
            carrier,
            region,
            placed.movable,
            placed.weights,
            constraints.pinned,
            blocks,
            faces[0] if faces else None,
        )
        faces[:] = [finished.watch.before]
        vertices = placed.in_given_order(finished.vertices)
        report = _report(
            placed.original,
            vertices,
            finished,
            blocks,
            iterations=iterations,
            is_stopped=is_stopped,
            began=began,
            settings=settings,
            noise=noise,
            line_vertices=n_line_vertices,
            welded_vertices=0 if placed.weld is None else placed.weld.n_merged,
        )
    return DenoiseResult(vertices, report)


def _motion(points: NDArray[np.floating], prepared: Prepared, blocks: Blocks) -> NDArray[np.float64]:
    """Return the displacements, shape (3, N), in scene units, to points of normalized space."""
    motion = np.empty(points.shape)

    def kernel(start: int, stop: int) -> None:
        part = motion[:, start:stop]
        part[:] = points[:, start:stop]
        part -= prepared.noisy[:, start:stop]
        part *= prepared.edge

    blocks.run(kernel, points.shape[1])
    return motion


def _line_strength(settings: DenoiseSettings) -> float:
    """Return how much of the noise on feature lines is removed: nothing where nothing else is."""
    if settings.method == "AUTO":
        return settings.strength
    if settings.method == "POSITIONS" and settings.tuning == "GIVEN" and settings.lambda_ == 0.0:
        return 0.0
    return 1.0


def _check_movable(movable: NDArray[np.bool_], n_vertices: int) -> None:
    """Raise ValueError unless the mask fits the mesh and selects something."""
    if movable.shape != (n_vertices,) or movable.dtype != bool:
        raise ValueError(
            f"The mask of movable vertices is {movable.dtype} of shape {movable.shape}; "
            f"expected bool ({n_vertices},)."
        )
    if not movable.any():
        raise ValueError("No vertex may move; select at least one.")


def _report(
    surface: SurfaceMesh,
    vertices: NDArray[np.floating],
    finished: Finished,
    blocks: Blocks,
    *,
    began: float,
    **known: Any,
) -> DenoiseReport:
    """Account for a finished run; `known` are fields of the report."""
    watch = finished.watch
    connectivity = watch.carrier.connectivity

    def measure(start: int, stop: int) -> tuple[int, float, float]:
        moved = vertices[start:stop].astype(np.float64) - surface.vertices[start:stop]
        moved *= moved
        squares = moved[:, 0] + moved[:, 1] + moved[:, 2]
        return int(np.count_nonzero(squares)), float(squares.sum()), float(squares.max())

    n_moved, squares, largest = zip(*blocks.run(measure, surface.n_vertices), strict=True)
    volume_change = None
    if connectivity.is_closed and watch.before.volume:
        volume_change = (watch.volume - watch.before.volume) / watch.before.volume
    return DenoiseReport(
        n_vertices=surface.n_vertices,
        n_faces=surface.n_faces,
        n_moved=sum(n_moved),
        mean_edge_length=watch.carrier.edge,
        displacement_rms=float(np.sqrt(sum(squares) / surface.n_vertices)),
        displacement_max=float(np.sqrt(max(largest))),
        flipped_faces=watch.n_turned,
        folded_faces=int(np.count_nonzero(watch.is_folded)),
        folded_faces_before=int(np.count_nonzero(watch.before.is_folded)),
        degenerate_faces=int(np.count_nonzero(watch.is_degenerate)),
        degenerate_faces_before=int(np.count_nonzero(watch.before.is_degenerate)),
        damped_vertices=finished.n_damped,
        volume_change=volume_change,
        irregular_vertices=int(np.count_nonzero(connectivity.is_irregular())),
        boundary_vertices=int(np.count_nonzero(connectivity.is_boundary)),
        non_manifold_vertices=int(np.count_nonzero(connectivity.is_non_manifold)),
        loose_vertices=int(np.count_nonzero(connectivity.is_loose)),
        seconds=perf_counter() - began,
        **known,
    )
