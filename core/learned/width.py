# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether noise is wide: shared by neighbors, as scanners and voxels make it, or new at each vertex.

Fine relief and wide noise look alike, and one net for both is too timid for the one or too bold for the
other. So there are two. Which one a connected part needs is seen in what first passes take away. Of white
noise a pass for fine noise takes away what is white; what neighbors share is wide noise or relief. A pass for
wide noise tells these apart: it takes away more of noise than of relief.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .face_graph import FaceGraph
from .measured import at_faces, ramp
from .residual import Residual

SHARED, UNSURE_SHARED = 0.015, 0.01
"""Correlation with the mean of the ring from which neighbors share the residual of a pass for fine noise.

It is below 0 for white noise, as a pass takes less of what is smooth, and 0.025 and more for noise that was
averaged with the ring once. So far away both nets have a share, so that rounding decides nothing.
"""

STRONG, UNSURE_STRONG = 0.045, 0.005
"""Root mean square of the residual of a pass for wide noise, in local edge lengths, from which it is noise.

It is 0.02 to 0.04 for relief of clean meshes, and 0.05 and more for scans.
"""


def shared_share(
    residual: Residual,
    unit: NDArray[np.float32],
    graph: FaceGraph,
    counted: Sequence[slice | NDArray[np.intp]],
) -> NDArray[np.float32]:
    """Return how much of the residual of a pass for fine noise neighbors share, shape (I,), from 0 to 1.

    Parameters
    ----------
    residual : Residual
        What the pass took away. Its correlation counts by its strength.
    unit : ndarray, shape (N,), float32
        Local edge lengths.
    graph : FaceGraph
        Faces.
    counted : sequence of slice or ndarray
        Which faces of each island say something about it.
    """
    strength = residual.strength / unit
    shared, total = _sums(np.stack((strength * residual.correlation, strength)), graph, counted)
    return ramp(shared / np.maximum(total, 1e-30), SHARED, UNSURE_SHARED)


def strong_share(
    residual: Residual,
    unit: NDArray[np.float32],
    graph: FaceGraph,
    counted: Sequence[slice | NDArray[np.intp]],
) -> NDArray[np.float32]:
    """Return whether a pass for wide noise took away noise, shape (I,), from 0 to 1; see `shared_share`."""
    square = (residual.strength / unit) ** 2
    total, n_corners = _sums(np.stack((square, np.ones_like(square))), graph, counted)
    return ramp(np.sqrt(total / np.maximum(n_corners, 1)), STRONG, UNSURE_STRONG)


def _sums(
    fields: NDArray[np.float32], graph: FaceGraph, counted: Sequence[slice | NDArray[np.intp]]
) -> NDArray[np.float64]:
    """Return sums over faces of means at their corners, shape (n, I), of fields at vertices, shape (n, N)."""
    means = at_faces(fields, graph)
    return np.stack([means[:, own].sum(axis=1, dtype=np.float64) for own in counted], axis=1)
