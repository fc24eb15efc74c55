# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The normal-field engine: pilot, second stage, vertex update."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..denoising.constraints import Constraints
from ..denoising.report import Callback
from ..memory import give_back
from ..settings import DenoiseSettings
from ..surface.connectivity import Connectivity
from ..surface.surface_mesh import SurfaceMesh
from .face_averages import face_averages
from .neighbors import Ragged, edge_neighbors, faces_of_vertices
from .noise_sample import area_vectors
from .pilot import ITERATIONS, Tick, n_rounds, pilot_normals, unit_columns
from .vertex_fit import VertexFit


class _Stopped(Exception):
    """Raised inside when the callback asks to stop."""


def normal_filter(
    noisy: NDArray[np.floating],
    surface: SurfaceMesh,
    connectivity: Connectivity,
    settings: DenoiseSettings,
    constraints: Constraints,
    blocks: Blocks,
    callback: Callback | None = None,
) -> tuple[NDArray[np.floating], int, bool]:
    """Clean the normals of the faces, then move the vertices until they fit.

    Parameters
    ----------
    noisy : ndarray, shape (3, N)
        Noisy positions in mean edge lengths, coordinates in rows; not modified.
    surface : SurfaceMesh
        The mesh, for its faces.
    connectivity : Connectivity
        Its neighborhoods.
    settings : DenoiseSettings
        `normal_threshold`, `sharpness`, `sigma_n`, `average_steps`, `passes`, `vertex_steps`.
    constraints : Constraints
        Vertices that may not move freely.
    blocks : Blocks
        Threads to work on.
    callback : callable, optional
        See `report.Callback`; the change is 0 until the vertices move.

    Returns
    -------
    points : ndarray, shape (3, N)
        Denoised positions. If the run was stopped before the vertices moved, the noisy ones.
    iterations : int
        Vertex steps that ran.
    is_stopped : bool
        True if the callback stopped the run.
    """
    averages = settings.passes * settings.average_steps
    total = n_rounds(settings.sharpness) * ITERATIONS + averages + settings.vertex_steps
    done = 0

    def tick(change: float = 0.0) -> None:
        nonlocal done
        done += 1
        if callback is not None and callback(done / total, change):
            raise _Stopped

    points = noisy
    steps = 0
    try:
        at_vertex = faces_of_vertices(surface, connectivity)
        normals = _filtered_normals(noisy, surface, connectivity, at_vertex, settings, blocks, tick)
        fit = VertexFit(surface, at_vertex, blocks).steps(noisy, normals)
        for moved, change in fit.points(settings.vertex_steps, constraints):
            points, steps = moved, steps + 1
            tick(change)
    except _Stopped:
        return points, steps, True
    return points, steps, False


def _filtered_normals(
    noisy: NDArray[np.floating],
    surface: SurfaceMesh,
    connectivity: Connectivity,
    at_vertex: Ragged,
    settings: DenoiseSettings,
    blocks: Blocks,
    tick: Tick,
) -> NDArray[np.floating]:
    """Return clean unit normals, shape (3, F)."""
    neighbors = edge_neighbors(surface, connectivity)
    vectors = area_vectors(noisy, surface, blocks)
    areas = np.sqrt((vectors * vectors).sum(axis=0))
    noisy_normals = unit_columns(vectors, np.zeros_like(vectors))
    normals = pilot_normals(
        noisy_normals, neighbors, settings.normal_threshold, settings.sharpness, blocks, tick
    )
    if not settings.average_steps:
        return normals
    del vectors
    averages = face_averages(noisy, surface, at_vertex, neighbors, areas, blocks)
    del neighbors
    give_back(surface.n_faces)
    for _ in range(settings.passes):
        normals = averages.smooth(
            noisy_normals, averages.weights(normals, settings.sigma_n), settings.average_steps, tick
        )
    return normals
