# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Noise along the surface, which no normal tells of: vertices of a regular mesh that stand unevenly.

Positions along the surface are noise or the choice of whoever made the mesh. Where almost all vertices have
the valence of a lattice, and stand as unevenly as noise in all directions would make them, it is noise, and a
low-pass takes it away. On other meshes they stay.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..averages.means import padded
from .engine import FaceEngine
from .measured import Measured, at_faces, counted_faces, ramp
from .symmetric import ENTRIES, solved

N_AVERAGES = 3
"""Averages of the low-pass. One with more does not gain on coarse meshes, whose shape it would smooth."""

REGULAR, UNSURE_REGULAR = 0.9, 0.05
"""Share of the vertices that are regular from which a mesh is. Remeshed quads have 0.94 and more, triangles
of machine parts 0.8 and less."""

LEAST, UNSURE_LEAST, MOST, UNSURE_MOST = 0.33, 0.05, 0.75, 0.1
"""Energy that the low-pass takes from a direction along the surface, over that of the residual around along
the normals. Noise in all directions has 0.37 to 0.65, 0.44 on a perfect lattice, noise along one direction up
to 0.8. Noise along the normals has 0.28 and less; on slopes of range images the mesh itself has more."""

TAKEN = np.float32(2 / 3)
"""Share that is taken away. A mesh whose vertices were placed as unevenly as the noise is strong cannot be
told from a noisy one; with this share it is still nearer to the clean mesh than before."""

FAINT, UNSURE_FAINT = 0.08, 0.015
"""Root mean square of the residual along the normals, in local edge lengths, below which nothing is told
apart: vertices of clean regular meshes stand as unevenly."""

SPREAD = np.float32(0.07)
"""Variance of the normals around a vertex in a direction from which it does not move that way: 30 degrees
between two halves."""


def tangential_step(
    points: NDArray[np.float32],
    fitted: NDArray[np.float32],
    unit: NDArray[np.float32],
    engine: FaceEngine,
    measured: Measured | None = None,
) -> NDArray[np.float32] | None:
    """Return what to add to positions so that noise along the surface goes.

    Parameters
    ----------
    points, fitted : ndarray, shape (3, N), float32
        Noisy positions, and those after a pass.
    unit : ndarray, shape (N,), float32
        Local edge lengths.
    engine : FaceEngine
        Tables of the mesh.
    measured : Measured, optional
        Where noise is measured.

    Returns
    -------
    ndarray, shape (3, N), float32, or None
        None where nothing is to be taken away.
    """
    regular = _regular_share(engine, measured)
    if not regular.any():
        return None
    rings = engine.rings
    change = rings.low_passes(rings.inward(padded(fitted)), [N_AVERAGES])[0]
    change = np.ascontiguousarray(rings.outward(change)[:, :3].T)
    normals = engine.vertex_normals(fitted)
    along = change - normals * (normals * change).sum(axis=0)
    strength = engine.residual(points, fitted, measured).strength
    share = regular * _noise_share(along, strength, unit, engine, measured)
    if not share.any():
        return None
    step = solved(_stiffness(fitted, engine), change)
    if engine.island is not None:
        share = engine.at_vertex.outward(engine.at_vertex.mean(share[engine.island][:, None]))[:, 0]
    step *= TAKEN * share
    step[:, ~engine.is_inside] = 0  # corners of a border would be rounded
    return step


def _regular_share(engine: FaceEngine, measured: Measured | None) -> NDArray[np.float32]:
    """Return whether almost all vertices of each island are regular, shape (I,), from 0 to 1."""
    counts = at_faces(np.array((engine.is_regular, engine.is_inside), np.float32), engine.graph)
    parts = counted_faces(engine.island, measured)
    n_regular, n_inside = np.array([counts[:, own].sum(axis=1, dtype=np.float64) for own in parts]).T
    return ramp(n_regular / np.maximum(n_inside, 1.0), REGULAR, UNSURE_REGULAR)


def _noise_share(
    along: NDArray[np.float32],
    strength: NDArray[np.float32],
    unit: NDArray[np.float32],
    engine: FaceEngine,
    measured: Measured | None,
) -> NDArray[np.float32]:
    """Return whether what a low-pass changes along the surface is noise, shape (I,), from 0 to 1."""
    square = strength * strength
    energy = np.float32(0.5) * (along * along).sum(axis=0) / np.maximum(square, np.float32(1e-30))
    fields = at_faces(np.stack((energy, square / (unit * unit))), engine.graph)
    parts = counted_faces(engine.island, measured)
    # A median, as vertices at features stand unevenly in any case.
    energies = np.array([np.median(fields[0, own]) for own in parts])
    squares = np.array([fields[1, own].mean(dtype=np.float64) for own in parts])
    share = ramp(energies, LEAST, UNSURE_LEAST) - ramp(energies, MOST, UNSURE_MOST)
    return share * ramp(np.sqrt(squares), FAINT, UNSURE_FAINT)


def _stiffness(points: NDArray[np.float32], engine: FaceEngine) -> NDArray[np.float32]:
    """Return 1 + (N / SPREAD)^2, shape (6, N), with N the mean of n n^T over the faces at a vertex.

    It is large in directions in which a vertex cannot move within its faces: along the normal where the
    surface is smooth, and across a crease.
    """
    normals = engine.face_vectors(points)
    normals /= np.maximum(np.sqrt((normals * normals).sum(axis=1, keepdims=True)), np.float32(1e-30))
    products = np.stack([normals[:, i] * normals[:, j] for i, j in ENTRIES], axis=1)
    a, b, c, d, e, f = engine.at_vertex.outward(engine.at_vertex.mean(products)).T / SPREAD
    one = np.float32(1)
    return np.stack(
        (
            one + a * a + b * b + c * c,
            a * b + b * d + c * e,
            a * c + b * e + c * f,
            one + b * b + d * d + e * e,
            b * c + d * e + e * f,
            one + c * c + e * e + f * f,
        )
    )
