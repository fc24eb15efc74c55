# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a denoising run gives back: the vertices and an account of what was done."""

from __future__ import annotations

from dataclasses import dataclass
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from .limits.finish import Finished
from .limits.resolved_region import ResolvedRegion
from .mesh.surface_mesh import SurfaceMesh
from .methods.problem import Problem, Solution
from .noise import NoiseEstimate
from .settings import DenoiseSettings


@dataclass(frozen=True, kw_only=True)
class DenoiseReport:
    """An account of a run; lengths are in the units of the mesh."""

    n_vertices: int
    n_faces: int
    n_moved: int = 0
    """Vertices that moved at all."""
    iterations: int = 0
    """Iterations that ran, fewer than asked for if the tolerance was met or the run was stopped."""
    is_stopped: bool = False
    """True if the run was stopped from outside."""
    mean_edge_length: float = 0.0
    displacement_rms: float = 0.0
    displacement_max: float = 0.0
    flipped_faces: int = 0
    """Faces whose normal turned by more than a right angle, as where a fold or a spike was smoothed out."""
    volume_change: float | None = None
    """(after - before) / before; None unless the mesh is closed."""
    irregular_vertices: int = 0
    """Vertices that took the stencil's rule for irregular vertices."""
    boundary_vertices: int = 0
    non_manifold_vertices: int = 0
    loose_vertices: int = 0
    """Vertices without a face; they do not move."""
    seconds: float
    settings: DenoiseSettings
    """What was used; λ, μ and iterations are those that were chosen, where they are taken from the noise."""
    frame: str = ""
    """The frame that ran, where the settings say AUTO or a stencil replaces it, too; empty without any."""
    noise: NoiseEstimate | None = None
    """The noise, if it was measured: with the method AUTO a `NoiseBelief`, what was taken for noise."""
    folded_faces: int = 0
    folded_faces_before: int = 0
    """Faces that look against the faces around them, see `FaceFlips`, in the result and in the input."""
    degenerate_faces: int = 0
    degenerate_faces_before: int = 0
    """Faces next to without area, in the result and in the input."""
    damped_vertices: int = 0
    """Vertices that moved less than they would have, so that no face folds."""
    line_vertices: int = 0
    """Vertices on feature lines, those that stay included."""
    welded_vertices: int = 0
    """Vertices that were welded to others for the run."""


@dataclass(frozen=True, eq=False)
class DenoiseResult:
    """Denoised positions, shape (N, 3), of the input's dtype, and the report."""

    vertices: NDArray[np.floating]
    report: DenoiseReport


def stopped_report(surface: SurfaceMesh, settings: DenoiseSettings, began: float) -> DenoiseReport:
    """Return the report of a run that was stopped before anything was known: nothing moved."""
    return DenoiseReport(
        n_vertices=surface.n_vertices,
        n_faces=surface.n_faces,
        is_stopped=True,
        seconds=perf_counter() - began,
        settings=settings,
    )


def account(
    resolved: ResolvedRegion,
    vertices: NDArray[np.floating],
    finished: Finished,
    problem: Problem,
    solution: Solution,
    began: float,
) -> DenoiseReport:
    """Return the report of a finished run that began at a time of `time.perf_counter`.

    `vertices`, shape (N, 3), are the new positions of the mesh that was given.
    """
    surface, flips = resolved.original, finished.flips
    connectivity = flips.welded.connectivity

    def measure(start: int, stop: int) -> tuple[int, float, float]:
        moved = vertices[start:stop].astype(np.float64) - surface.vertices[start:stop]
        moved *= moved
        squares = moved[:, 0] + moved[:, 1] + moved[:, 2]
        return int(np.count_nonzero(squares)), float(squares.sum()), float(squares.max())

    n_moved, squares, largest = zip(*problem.blocks.run(measure, surface.n_vertices), strict=True)
    volume_change = None
    if connectivity.is_closed and flips.before.volume:
        volume_change = (flips.volume - flips.before.volume) / flips.before.volume
    return DenoiseReport(
        n_vertices=surface.n_vertices,
        n_faces=surface.n_faces,
        n_moved=sum(n_moved),
        iterations=solution.iterations,
        is_stopped=solution.is_stopped,
        mean_edge_length=flips.welded.edge,
        displacement_rms=float(np.sqrt(sum(squares) / surface.n_vertices)),
        displacement_max=float(np.sqrt(max(largest))),
        flipped_faces=flips.n_turned,
        folded_faces=int(np.count_nonzero(flips.is_folded)),
        folded_faces_before=int(np.count_nonzero(flips.before.is_folded)),
        degenerate_faces=int(np.count_nonzero(flips.is_degenerate)),
        degenerate_faces_before=int(np.count_nonzero(flips.before.is_degenerate)),
        damped_vertices=finished.n_damped,
        volume_change=volume_change,
        irregular_vertices=int(np.count_nonzero(connectivity.is_irregular())),
        boundary_vertices=int(np.count_nonzero(connectivity.is_boundary)),
        non_manifold_vertices=int(np.count_nonzero(connectivity.is_non_manifold)),
        loose_vertices=int(np.count_nonzero(connectivity.is_loose)),
        seconds=perf_counter() - began,
        settings=solution.settings,
        frame="" if problem.transform is None else problem.transform.frame,
        noise=solution.noise,
        line_vertices=problem.line_vertices,
        welded_vertices=0 if resolved.weld is None else resolved.weld.n_merged,
    )
