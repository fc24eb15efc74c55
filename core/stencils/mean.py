# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The MEAN rule at irregular vertices: every tap of a lattice orbit is the mean over that orbit (3.2)."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from ..mesh.connectivity import Connectivity
from .builder import Place, StencilBuilder


def fill_mean(
    builder: StencilBuilder,
    values: NDArray[np.int32],
    connectivity: Connectivity,
    wanted: NDArray[np.intp],
    places: Iterable[Place],
) -> NDArray[np.intp]:
    """Put the mean over the members of an orbit under all its taps.

    Parameters
    ----------
    builder : StencilBuilder
        Receives slots and means.
    values : ndarray, shape (R,), int32
        Near or far members in the layout of the one-rings.
    connectivity : Connectivity
        The one-rings.
    wanted : ndarray, shape (n,), intp
        Vertices to fill; those with fewer than two neighbors are passed over and so do not move.
    places : iterable of (row, column)
        The orbit.

    Returns
    -------
    ndarray of intp
        Those of `wanted` that have two neighbors or more but no member in this orbit.
    """
    wanted = wanted[connectivity.valence[wanted] >= 2]
    points, is_filled = builder.add_means(
        values, connectivity.ring_offset[wanted], connectivity.valence[wanted]
    )
    for place in places:
        builder.set(place, wanted[is_filled], points)
    return wanted[~is_filled]
