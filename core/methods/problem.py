# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What every method is given, and what it gives back."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..learned.engine import FaceEngine
from ..limits.constraints import Constraints
from ..mesh.connectivity import Connectivity
from ..mesh.surface_mesh import SurfaceMesh
from ..noise import NoiseEstimate
from ..settings import DenoiseSettings
from ..transform import FrameTransform

Callback = Callable[[float, float], bool]
"""`callback(fraction, change)`: share of the work done, 0 to 1, and rms motion of the last iteration in mean
edge lengths, NaN before the first is done; returns True to stop."""


@dataclass(frozen=True, eq=False)
class Problem:
    """A noisy surface in mean edge lengths around its center, and how to clean it.

    Attributes
    ----------
    noisy : ndarray, shape (3, N)
        Noisy positions, with feature lines smoothed; not modified.
    given : ndarray, shape (3, N)
        Noisy positions as they were given.
    surface : SurfaceMesh
        The mesh in scene units, for its faces.
    connectivity : Connectivity
        Its neighborhoods.
    edge : float
        Its mean edge length in scene units.
    settings : DenoiseSettings
        The method and its parameters.
    constraints : Constraints
        Vertices that may not move freely.
    transform : FrameTransform or None
        The frame with frozen stencils, if the method uses one.
    engine : FaceEngine or None
        Tables of faces, if the method uses them.
    callback : callable or None
        See `Callback`.
    line_vertices : int
        Number of vertices on feature lines.
    movable : ndarray, shape (N,), bool, or None
        Vertices that may move, on which noise is measured; None for all.
    """

    noisy: NDArray[np.floating]
    given: NDArray[np.floating]
    surface: SurfaceMesh
    connectivity: Connectivity
    edge: float
    settings: DenoiseSettings
    constraints: Constraints
    blocks: Blocks
    transform: FrameTransform | None = None
    engine: FaceEngine | None = None
    callback: Callback | None = None
    line_vertices: int = 0
    movable: NDArray[np.bool_] | None = None


class Solution(NamedTuple):
    """What a method found: positions, shape (3, N), in the dtype of the noisy ones, and how it got there."""

    points: NDArray[np.floating]
    iterations: int
    """Iterations or passes that ran."""
    is_stopped: bool
    """True if the callback stopped the run."""
    settings: DenoiseSettings
    """With the parameters that were chosen, if the method chooses any."""
    noise: NoiseEstimate | None = None
    """The noise, if the method measured it."""


def rms_motion(points: NDArray[np.floating], before: NDArray[np.floating], blocks: Blocks) -> float:
    """Return the root mean square distance between two sets of points, shape (3, N), in their unit."""

    def kernel(start: int, stop: int) -> float:
        step = points[:, start:stop] - before[:, start:stop]
        step *= step
        return float(step.sum())  # in pairs, so that single precision does

    return float(np.sqrt(sum(blocks.run(kernel, points.shape[1])) / points.shape[1]))
