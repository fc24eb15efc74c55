# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The residual of a pass, what it took away: how strong it is around each vertex, how alike at neighbors."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..averages.ring_means import RingMeans

SPREAD_AVERAGES = 64
"""Averages over which squares are spread: about six rings."""


LEAST_SHARE = np.float32(0.02)
"""Share of the vertices around one that has to be movable to say what was taken there."""


class Residual(NamedTuple):
    """Root mean square of displacements around vertices, and correlation with the ring, shape (N,)."""

    strength: NDArray[np.float32]
    correlation: NDArray[np.float32]


def find_residual(
    offsets: NDArray[np.float32], rings: RingMeans, movable: NDArray[np.bool_] | None = None
) -> Residual:
    """Return strength and correlation of displacements along the normals, shape (N,).

    Only vertices that are `movable`, shape (N,), count; None for all.
    """
    offset = rings.inward(offsets[:, None])
    mean = rings.mean(offset)
    moments = np.concatenate((offset * offset, offset * mean), axis=1)
    if movable is not None:
        moments = np.concatenate((moments, rings.inward(movable[:, None].astype(np.float32))), axis=1)
    moments = rings.outward(rings.averaged(moments, SPREAD_AVERAGES))
    square = np.maximum(moments[:, 0], 0)
    correlation = moments[:, 1] / np.maximum(square, np.float32(1e-20))
    if movable is not None:
        # The others did not move, whatever their noise.
        square /= np.maximum(moments[:, 2], LEAST_SHARE)
    return Residual(np.sqrt(square), np.clip(correlation, -1, 1, out=correlation))
