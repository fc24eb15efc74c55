# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What many steps of a vertex fit are in few: a series, and constraints as projections."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from ..denoising.constraints import Constraints
from .means import padded

LEFT_OUT = 1e-3
"""Terms of the series of a fit that are left out sum up to less than this, in units of the first step."""


@cache
def step_series(n_steps: int) -> list[float]:
    """Return the Chebyshev coefficients, in 2 x - 1, of the sum of x^j for j < n, without the small ones."""
    if n_steps < 1:
        return [0.0]

    def total(y: Any) -> Any:
        return ((0.5 * (1.0 + y)) ** np.arange(n_steps)[:, None]).sum(axis=0)

    series = chebyshev.chebinterpolate(total, max(n_steps - 1, 1))
    left_out = np.cumsum(np.abs(series[::-1]))[::-1]
    return [float(value) for value in series[left_out > LEFT_OUT]]


def share_of_step(n_all: int, step: int, n_steps: int) -> int:
    """Return how many of all things belong to a step of 1 to `n_steps`, so that they are spread evenly."""
    return n_all * step // n_steps - n_all * (step - 1) // n_steps


class Held:
    """Constraints as projections of displacements, for vertices as they are numbered inside the means."""

    def __init__(self, constraints: Constraints | None, place: NDArray[np.int32], dtype: np.dtype) -> None:
        self._pinned = self._railed = np.zeros(0, np.int32)
        self._rail = np.zeros((0, 4), dtype)
        if constraints is not None:
            self._pinned, self._railed = place[constraints.pinned], place[constraints.railed]
            self._rail = padded(constraints.rail.astype(dtype, copy=False))

    def __bool__(self) -> bool:
        return bool(len(self._pinned) or len(self._railed))

    def project(self, rows: NDArray[np.floating]) -> None:
        """Take away what the constraints do not allow, in place."""
        if len(self._railed):
            along = (rows[self._railed] * self._rail).sum(axis=1, keepdims=True)
            rows[self._railed] = along * self._rail
        rows[self._pinned] = 0
