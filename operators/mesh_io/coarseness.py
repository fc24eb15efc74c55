# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How coarse the positions of a mesh are: the farther from zero, the more its precision rounds them."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

VISIBLE = 0.01
"""Share of an edge from which on steps can be seen: a surface looks like noise of a fourth of it."""


def coarse_step(positions: NDArray[np.floating], edge: float) -> float:
    """Return the distance between neighboring coordinates, in mean edge lengths; 0 if it cannot be seen.

    Parameters
    ----------
    positions : ndarray, shape (N, 3), float32 or float64
        The mesh, in its own precision.
    edge : float
        Its mean edge length.

    Examples
    --------
    >>> import numpy as np
    >>> near = np.float32([[0, 0, 0], [1, 0, 0], [0, 1, 0]])
    >>> coarse_step(near, 1.0), round(coarse_step(near + np.float32(5e6), 1.0), 3)
    (0.0, 0.5)
    """
    import numpy as np

    if not len(positions) or not edge > 0.0:
        return 0.0
    largest = max(abs(positions.min()), abs(positions.max()))
    if not np.isfinite(largest):
        return 0.0
    with np.errstate(over="ignore"):  # beside the largest number, whose step is infinite
        step = float(np.spacing(largest)) / edge
    return step if VISIBLE < step < float("inf") else 0.0  # else the run says what is wrong
