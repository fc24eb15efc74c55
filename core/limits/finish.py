# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""From the displacements that a method found to the positions of the result.

The order: shifts at seams, direction along the normals, weights, offset for the volume, largest displacement,
folds. Folds come last, so that no other step makes new ones; as damping changes the volume, the offset is
then found again.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..mesh.welded_mesh import WeldedMesh
from .constraints import Constraints
from .face_flips import FaceFlips, FaceState
from .folds import damp_until_valid
from .motion import Motion
from .region import Region
from .resolved_region import ResolvedRegion
from .volume import volume_offset

VOLUME_ROUNDS = 8
"""Times that offset and folds take turns at most."""


class Finished(NamedTuple):
    """Positions of the original surface, shape (N, 3), its faces as they are now, and damped vertices."""

    vertices: NDArray[np.floating]
    flips: FaceFlips
    n_damped: int


def finish(
    found: NDArray[np.float64],
    welded: WeldedMesh,
    resolved: ResolvedRegion,
    constraints: Constraints,
    blocks: Blocks,
    known: FaceState | None,
) -> Finished:
    """Bring displacements within the limits of a region, and mend what they do.

    Parameters
    ----------
    found : ndarray, shape (3, n), float64
        Displacements of the vertices of the mesh that was worked on, in scene units; changed.
    welded : WeldedMesh
        That mesh, and the one that moves.
    resolved : ResolvedRegion
        The limits, and what they say about its vertices.
    constraints : Constraints
        Vertices that are pinned take no part in the offset for the volume.
    known : FaceState or None
        The faces of the input, if they are known already: what `flips.before` of a result was.
    """
    region = resolved.region
    motion = Motion(found, welded, region, resolved.movable, resolved.weights, constraints.pinned)
    flips = FaceFlips(welded, blocks, known)
    shares = np.ones(found.shape[1])
    vertices = _settled(motion.at(), shares, flips, region, blocks)
    if not (region.keep_volume and welded.connectivity.is_closed):
        return Finished(vertices, flips, _n_damped(motion.at(), shares))
    area = flips.area_before * motion.allow_offset(shares)

    def volume_at(offset: float) -> float:
        return flips.volume_at(welded.moved(motion.at(offset) * shares, blocks))

    offset = 0.0
    for _ in range(VOLUME_ROUNDS):
        offset = volume_offset(volume_at, flips.before.volume, area, offset)
        old_shares = shares.copy()
        vertices = _settled(motion.at(offset), shares, flips, region, blocks)
        if np.array_equal(old_shares, shares):
            break
    return Finished(vertices, flips, _n_damped(motion.at(offset), shares))


def _settled(
    displacement: NDArray[np.float64],
    shares: NDArray[np.float64],
    flips: FaceFlips,
    region: Region,
    blocks: Blocks,
) -> NDArray[np.floating]:
    """Return the positions after a displacement, with folds taken back if that is wanted."""
    if region.repair_folds:
        return damp_until_valid(flips, displacement, shares, blocks)
    vertices = flips.welded.moved(displacement, blocks)
    flips.look(vertices)
    return vertices


def _n_damped(displacement: NDArray[np.float64], shares: NDArray[np.float64]) -> int:
    """Return the number of vertices whose motion was damped."""
    some = np.flatnonzero(shares < 1.0)
    return int(np.count_nonzero(displacement[:, some].any(axis=0)))
