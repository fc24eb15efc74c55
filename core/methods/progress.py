# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How far an iteration moved the surface, the measure of convergence."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks


def rms_motion(points: NDArray[np.floating], before: NDArray[np.floating], blocks: Blocks) -> float:
    """Return the root mean square distance between two sets of points, shape (3, N), in their unit."""

    def kernel(start: int, stop: int) -> float:
        step = points[:, start:stop] - before[:, start:stop]
        step *= step
        return float(step.sum())  # in pairs, so that single precision does

    return float(np.sqrt(sum(blocks.run(kernel, points.shape[1])) / points.shape[1]))
