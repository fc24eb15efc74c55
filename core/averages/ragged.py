# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of different lengths, and the faces at vertices as such."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..mesh.connectivity import Connectivity
from ..mesh.surface_mesh import SurfaceMesh


class Ragged(NamedTuple):
    """Rows of different lengths: row i is `items[offset[i]:offset[i + 1]]`."""

    offset: NDArray[np.int64]
    items: NDArray[np.int32]


def faces_of_vertices(surface: SurfaceMesh, connectivity: Connectivity | None = None) -> Ragged:
    """Return the faces at each vertex; a face that names a vertex twice counts twice.

    They are ascending; on manifold meshes with `connectivity`, which is many times faster, in ring order.
    """
    if connectivity is not None and not connectivity.is_non_manifold.any():
        corner, offset = connectivity.ring_corner, connectivity.ring_offset
        is_there = corner >= 0
        if not is_there.all():
            offset = np.concatenate(([0], np.cumsum(is_there)))[offset]
            corner = corner[is_there]
        size = surface.common_face_size()
        if size:
            return Ragged(offset, corner // np.int32(size))
        own = np.repeat(np.arange(surface.n_faces, dtype=np.int32), surface.face_sizes())
        return Ragged(offset, own[corner])
    order = np.argsort(surface.corner_vertex, kind="stable")
    own = np.repeat(np.arange(surface.n_faces, dtype=np.int32), surface.face_sizes())
    counts = np.bincount(surface.corner_vertex, minlength=surface.n_vertices)
    return Ragged(np.concatenate(([0], np.cumsum(counts))), own[order])
