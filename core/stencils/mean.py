# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The MEAN rule at irregular vertices: every tap of a lattice orbit is the mean over that orbit (3.2)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..surface.connectivity import Connectivity
from .stencil import StencilBuilder


def fill_mean(builder: StencilBuilder, connectivity: Connectivity, wanted: NDArray[np.intp]) -> None:
    """Fill all six slots of vertices with the mean of their one-ring.

    Parameters
    ----------
    builder : StencilBuilder
        Receives slots and means.
    connectivity : Connectivity
        One-rings.
    wanted : ndarray, shape (n,), intp
        Vertices to fill; those with fewer than two neighbors are passed over and so do not move.
    """
    wanted = wanted[connectivity.valence[wanted] >= 2]
    counts = connectivity.valence[wanted].astype(np.int64)
    begin = np.repeat(connectivity.ring_offset[wanted] - (np.cumsum(counts) - counts), counts)
    members = connectivity.ring[begin + np.arange(len(begin))]
    builder.slots[:, wanted] = builder.add_ragged(members, counts)
