# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Automatic denoising: noise, choice, run."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..denoising.constraints import Constraints
from ..denoising.report import Callback
from ..noise import NoiseEstimate, estimate_noise
from ..settings import DenoiseSettings
from ..surface.connectivity import Connectivity
from ..surface.surface_mesh import SurfaceMesh
from .choose import choose_recipes
from .patches import WHOLE
from .problem import NormalProblem
from .recipes import RECIPES
from .run_choice import n_ticks, run_choice

LEAST_NOISE = 0.004
"""Noise in mean edge lengths below which a mesh counts as clean and is left alone."""

CHOOSING_TIME = 3.0 * len(RECIPES)
RUNNING_TIME = 4.0
"""Time for each face that is tried, and for each face of the mesh, in about the time of a recipe."""

LARGEST_SHARE = 0.9
"""Of the progress, for choosing."""

LARGEST_RATIO = 1.4
"""Of impulsive noise the root mean square counts, up to so many times the noise of the quieter places: on
coarse machine parts it is uncertain."""

CLEAN = "Clean already"


class Automatic(NamedTuple):
    """What automatic denoising gives back: positions (3, N), and how it went."""

    points: NDArray[np.floating]
    iterations: int
    is_stopped: bool
    noise: NoiseEstimate
    recipe: str


class _Stopped(Exception):
    """Raised inside when the callback asks to stop."""


def automatic_filter(
    noisy: NDArray[np.floating],
    surface: SurfaceMesh,
    connectivity: Connectivity,
    edge: float,
    settings: DenoiseSettings,
    constraints: Constraints,
    blocks: Blocks,
    callback: Callback | None = None,
) -> Automatic:
    """Measure the noise, choose a recipe, and run it.

    Parameters
    ----------
    noisy : ndarray, shape (3, N)
        Noisy positions in mean edge lengths; not modified.
    surface : SurfaceMesh
        The mesh, with its positions in scene units.
    connectivity : Connectivity
        Its neighborhoods.
    edge : float
        Mean edge length in scene units.
    settings : DenoiseSettings
        `strength`.
    constraints : Constraints
        Vertices that may not move freely.
    blocks : Blocks
        Threads to work on.
    callback : callable, optional
        See `report.Callback`.

    Returns
    -------
    Automatic
        If the run was stopped, or the mesh is clean, the noisy positions.
    """
    noise = estimate_noise(surface, connectivity, blocks)
    level = noise.sigma
    if noise.is_impulsive:
        level = min(noise.rms, LARGEST_RATIO * noise.sigma) if noise.sigma > 0 else noise.rms
    sigma = settings.strength * level / edge
    if sigma < LEAST_NOISE:
        return Automatic(noisy, 0, False, noise, CLEAN)
    done = 0.0
    choosing = choosing_share(surface.n_faces)

    def advance(share: float, change: float = 0.0) -> None:
        nonlocal done
        done = min(done + share, 1.0)
        if callback is not None and callback(done, change):
            raise _Stopped

    try:
        choice = choose_recipes(
            noisy,
            surface,
            sigma,
            blocks,
            lambda share: advance(choosing * share),
            strength=settings.strength,
            is_impulsive=noise.is_impulsive,
            connectivity=connectivity,
        )
        step = (1.0 - choosing) / n_ticks(choice)
        problem = NormalProblem(noisy, surface, connectivity, choice.sigma or sigma, blocks)
        points = run_choice(problem, choice, constraints, lambda change: advance(step, change))
    except _Stopped:
        return Automatic(noisy, 0, True, noise, "")
    return Automatic(points, choice.vertex_steps, False, noise, choice.label)


def choosing_share(n_faces: int) -> float:
    """Return the share of the progress that choosing takes: large meshes are tried in part only."""
    choosing = CHOOSING_TIME * min(n_faces, WHOLE)
    return min(LARGEST_SHARE, choosing / max(choosing + RUNNING_TIME * n_faces, 1.0))
