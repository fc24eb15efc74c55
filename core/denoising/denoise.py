# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Denoise a surface: from positions and settings to clean positions and a report."""

from __future__ import annotations

from time import perf_counter

import numpy as np
from numpy.typing import DTypeLike, NDArray

from ..blocks import Blocks
from ..normals.filter import normal_filter
from ..settings import DenoiseSettings
from ..surface.checks import check_surface
from ..surface.connectivity import Connectivity, connect
from ..surface.geometry import face_area_vectors, signed_volume
from ..surface.normalization import displaced, normalize
from ..surface.surface_mesh import SurfaceMesh
from ..transform import choose_frame, make_transform
from .bilateral import bilateral_filter
from .constraints import find_constraints
from .report import Callback, DenoiseReport, DenoiseResult
from .shrinkage import SEPARABLE
from .split_bregman import split_bregman


def denoise(
    surface: SurfaceMesh,
    settings: DenoiseSettings | None = None,
    *,
    movable: NDArray[np.bool_] | None = None,
    connectivity: Connectivity | None = None,
    callback: Callback | None = None,
    dtype: DTypeLike = np.float32,
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
    connectivity : Connectivity, optional
        Neighborhoods of the mesh, if they are known already.
    callback : callable, optional
        `callback(fraction, change) -> bool` after each iteration; see `report.Callback`.
    dtype : dtype, optional
        Precision of the solver: float32 for speed, float64 for exactness.

    Returns
    -------
    DenoiseResult
        Positions in the dtype of the input; vertices that did not move have the same bits.

    Raises
    ------
    ValueError
        In one sentence, if the mesh has no faces, no size or positions that are not finite, or if `movable`
        has the wrong shape or selects nothing.

    Notes
    -----
    The solver works around the center of the mesh and in units of the mean edge length, so that results do
    not depend on where the mesh is and how large. Displacements are added to the input, not positions scaled
    back, so that no digit is lost where nothing moves.
    """
    began = perf_counter()
    settings = settings or DenoiseSettings()
    edge = check_surface(surface)
    if movable is not None:
        _check_movable(movable, surface.n_vertices)
    dtype = np.dtype(dtype)
    with Blocks(settings.threads) as blocks:
        connectivity = connectivity or connect(surface, blocks)
        normalized = normalize(surface, connectivity, edge)
        noisy = np.ascontiguousarray(normalized.T, dtype)
        constraints = find_constraints(surface, connectivity, settings, movable, dtype)
        if settings.method == "BILATERAL":
            solved = bilateral_filter(noisy, surface, connectivity, settings, constraints, blocks, callback)
        elif settings.method == "NORMALS":
            solved = normal_filter(noisy, surface, connectivity, settings, constraints, blocks, callback)
        elif settings.lambda_ == 0.0:
            solved = noisy, settings.iterations, False  # nothing is shrunk, so nothing moves
        else:
            # Chosen on the normalized surface in full precision, so that rounding decides nothing.
            transform = make_transform(
                surface.with_vertices(normalized),
                choose_frame(settings.frame, connectivity),
                settings.stencil,
                settings.levels,
                boundary=settings.boundary,
                connectivity=connectivity,
                blocks=blocks,
                dtype=dtype,
                only_used_bands=settings.shrinkage in SEPARABLE,
            )
            solved = split_bregman(noisy, transform, settings, constraints, blocks, callback)
    points, iterations, is_stopped = solved
    displacement = (points.astype(np.float64) - noisy).T * edge
    vertices = displaced(surface.vertices, displacement)
    report = _report(surface, connectivity, vertices, edge, iterations, is_stopped, began)
    return DenoiseResult(vertices, report)


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
    connectivity: Connectivity,
    vertices: NDArray[np.floating],
    edge: float,
    iterations: int,
    is_stopped: bool,
    began: float,
) -> DenoiseReport:
    """Account for a finished run."""
    result = surface.with_vertices(vertices)
    moved = np.linalg.norm(vertices.astype(np.float64) - surface.vertices, axis=1)
    areas_before, areas_after = face_area_vectors(surface), face_area_vectors(result)
    volume_change = None
    if connectivity.is_closed:
        before = signed_volume(surface, areas_before)
        volume_change = (signed_volume(result, areas_after) - before) / before if before else None
    return DenoiseReport(
        n_vertices=surface.n_vertices,
        n_faces=surface.n_faces,
        n_moved=int((moved > 0).sum()),
        iterations=iterations,
        is_stopped=is_stopped,
        mean_edge_length=edge,
        displacement_rms=float(np.sqrt(np.mean(moved**2))),
        displacement_max=float(moved.max()),
        flipped_faces=int((np.einsum("fi,fi->f", areas_before, areas_after) < 0.0).sum()),
        volume_change=volume_change,
        irregular_vertices=int(connectivity.is_irregular().sum()),
        boundary_vertices=int(connectivity.is_boundary.sum()),
        non_manifold_vertices=int(connectivity.is_non_manifold.sum()),
        loose_vertices=int(connectivity.is_loose.sum()),
        seconds=perf_counter() - began,
    )
