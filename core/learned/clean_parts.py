# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is clean and stays put, bit for bit: a rule outside of the net, which moves everything a little.

Two things never come out of noise: many faces side by side that are coplanar to the last digit,
and places where cubic polynomials fit two-rings to within `CLEAN` local edge lengths. The first stay flat.
Where the second are frequent, vertices stay
that a pass would hardly move: creases of clean meshes, but not noise that begins beside them.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..averages.ring_means import RingMeans
from ..blocks import Blocks
from ..mesh.connected_components import connected_components
from ..mesh.connectivity import Connectivity
from ..mesh.ragged import Ragged
from ..mesh.surface_mesh import SurfaceMesh
from ..noise.estimate import LEAST_DEGREES_OF_FREEDOM
from ..noise.fits import fit_heights
from ..noise.patches import find_patches, local_adjacency, spread_sample
from .face_graph import FaceGraph, Polygons
from .measured import Measured
from .scales import Scales

ROUNDING = 4.0
"""Units of rounding of the coordinates by which the corners of coplanar faces may miss their plane."""

LEAST_HEIGHT = 16
"""Height of a face, in what its corners may miss, from which its normal says something."""

FLAT_FACES, FLAT_SHARE = 30, 0.02
"""Triangles in one plane from which they are flat, and the share of all that suffices. Plateaus of a scan in
steps of height are smaller."""

MOSTLY_FLAT = 0.5
"""Share of all triangles that are flat from which two in one plane are flat, too."""

CLEAN = 0.004
"""Residuals of the fits, in local edge lengths, below which a two-ring is clean."""

FEW, MANY = 600, 8192
"""Two-rings that are looked at on any mesh, and on one that has clean ones among those."""

SOME_CLEAN = 0.03
"""Share of clean two-rings from which a mesh may have clean parts."""

MOSTLY_CLEAN = 0.25
"""Share of clean two-rings around a vertex from which it stays: fits fail at creases of clean meshes too."""

LEAST_KNOWN = 0.2
"""Share of two-rings that have to be known around a vertex."""

HARDLY, WIDE = 0.03, 0.3
"""Displacements in local edge lengths: their root mean square around a vertex, and its own, up to which a
pass hardly moves it."""

CUT_OFF = 0.1
"""What one vertex counts for at most among those around it: a spike says nothing of its neighbors."""

FEW_LEFT = 0.05
"""Share of the vertices up to which those that are left on a clean mesh may move twice as much and stay."""

NEAR = 4
"""Averages over the vertices around."""

NO_NOISE = 0.01
"""Root mean square of all displacements up to which there is no noise at all."""


def flat_vertices(
    points: NDArray[np.float32], scales: Scales, graph: FaceGraph, measured: Measured | None = None
) -> NDArray[np.bool_]:
    """Return the vertices of exactly flat parts, shape (N,), of positions (3, N).

    How much of the mesh is flat is asked where something is `measured`; None for everywhere.
    """
    result = np.zeros(points.shape[1], bool)
    is_flat = _flat_faces(points, scales, graph, slice(None) if measured is None else measured.faces)
    for group in graph.groups:
        result[group.corners[:, is_flat[group.begin : group.end]]] = True
    return result


def hardly_moved(
    offsets: NDArray[np.float32],
    is_clean: NDArray[np.bool_],
    is_free: NDArray[np.bool_],
    rings: RingMeans,
    movable: NDArray[np.bool_] | None = None,
) -> NDArray[np.bool_]:
    """Return vertices that a pass hardly moved and that stay therefore, shape (N,).

    Parameters
    ----------
    offsets : ndarray, shape (N,), float32
        Displacements along the normals, in local edge lengths.
    is_clean : ndarray, shape (N,), bool
        Vertices in clean places, see `clean_places`.
    is_free : ndarray, shape (N,), bool
        Vertices that may move.
    rings : RingMeans
        Rings.
    movable : ndarray, shape (N,), bool, or None
        Vertices of which shares are counted; None for all.
    """
    squares = np.square(offsets)
    around = rings.averaged(rings.inward(np.minimum(squares, CUT_OFF**2)[:, None]), NEAR)
    is_calm = (rings.outward(around)[:, 0] < HARDLY**2) & (squares < WIDE**2)
    still = is_clean & is_calm
    rest = is_free & ~still
    if not rest.any():
        return still
    strength = np.sqrt(squares[rest].mean(dtype=np.float64))
    n_vertices = len(is_clean)
    if movable is not None:
        n_vertices, is_clean = int(np.count_nonzero(movable)), is_clean & movable
    is_mostly_clean = np.count_nonzero(is_clean) > MOSTLY_CLEAN * n_vertices
    cut = np.sqrt(np.minimum(squares[rest], CUT_OFF**2).mean(dtype=np.float64))
    limit = HARDLY if np.count_nonzero(rest) > FEW_LEFT * n_vertices else 2 * HARDLY
    if strength < NO_NOISE or (is_mostly_clean and cut < limit):
        still = still | (squares < WIDE**2)
    return still


def _flat_faces(
    points: NDArray[np.float32], scales: Scales, graph: FaceGraph, counted: slice | NDArray[np.bool_]
) -> NDArray[np.bool_]:
    """Return faces of flat parts, which are connected and in one plane, shape (F,).

    Polygons count as the triangles that they are made of. Shares are those of the `counted` faces.
    """
    # Whole arrays: `take` would copy all of a strided one for every block.
    normals = np.ascontiguousarray(scales.normals[..., 0])
    height = scales.areas[:, 0] / scales.length  # about the heights of the faces
    rounding = np.float32(ROUNDING) * np.spacing(np.abs(points).max(initial=np.float32(1)))
    n_triangles = np.ones(graph.n_faces, np.int32)
    is_pair = np.zeros(graph.n_pairs, bool)

    def compare(start: int, stop: int) -> None:
        one, two = graph.first[start:stop], graph.second[start:stop]
        apart = normals.take(two, axis=1) - normals.take(one, axis=1)
        lower = np.minimum(height.take(one), height.take(two))
        is_pair[start:stop] = (apart * apart).sum(axis=0) * lower * lower < rounding * rounding
        # The normal of a face next to without area is nothing but rounding.
        is_pair[start:stop] &= lower > LEAST_HEIGHT * rounding

    def count(faces: slice, polygons: Polygons) -> None:
        center = scales.centroids[:, faces, 0]
        own = normals[:, faces]
        for corners in polygons.corners[3:]:
            away = points.take(corners, axis=1) - center
            n_triangles[faces] += np.abs((away * own).sum(axis=0)) < rounding

    graph.for_pairs(compare)
    graph.for_faces(count)
    pairs = np.flatnonzero(is_pair)
    part = connected_components(graph.n_faces, graph.first[pairs], graph.second[pairs])
    sizes = np.bincount(part, n_triangles, graph.n_faces)
    is_flat: NDArray[np.bool_] = sizes[part] >= min(
        FLAT_FACES, max(2.0, FLAT_SHARE * n_triangles[counted].sum())
    )
    if (n_triangles * is_flat)[counted].sum() > MOSTLY_FLAT * n_triangles[counted].sum():
        is_flat |= sizes[part] >= 2  # planes are what this mesh is made of, and some are small
    return is_flat


def clean_places(
    points: NDArray[np.float32],
    surface: SurfaceMesh,
    connectivity: Connectivity,
    unit: NDArray[np.float32],
    rings: RingMeans,
    blocks: Blocks,
    measured: Measured | None = None,
) -> NDArray[np.bool_]:
    """Return vertices in places where two-rings are often clean, shape (N,).

    Parameters
    ----------
    points : ndarray, shape (3, N), float32
        Positions.
    surface, connectivity : SurfaceMesh, Connectivity
        The mesh, for its faces and rings.
    unit : ndarray, shape (N,), float32
        Local edge lengths.
    rings : RingMeans
        Rings.
    measured : Measured, optional
        Where two-rings are looked at; by default everywhere.
    """
    n_vertices = points.shape[1]
    positions = np.ascontiguousarray(points.T, np.float64)
    is_used = ~connectivity.is_loose
    if measured is not None:
        is_used &= measured.vertices
        n_vertices = int(np.count_nonzero(measured.vertices))
    used = np.flatnonzero(is_used)
    for n_samples in (FEW, MANY):
        centers = spread_sample(positions, used, n_samples)
        adjacency = local_adjacency(surface, connectivity, centers)

        def look(
            start: int, stop: int, centers: NDArray[np.intp] = centers, adjacency: Ragged = adjacency
        ) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
            own = centers[start:stop]
            found = fit_heights(positions, find_patches(adjacency, own))
            is_known = found.degrees_of_freedom >= LEAST_DEGREES_OF_FREEDOM
            return is_known, is_known & (found.variance < (CLEAN * unit[own]) ** 2)

        parts = blocks.with_block_size(256).run(look, len(centers))
        is_known, is_quiet = (np.concatenate(part) for part in zip(*parts, strict=True))
        if is_quiet.sum() < SOME_CLEAN * max(is_known.sum(), 1):
            return np.zeros(points.shape[1], bool)
    counts = np.zeros((points.shape[1], 2), np.float32)
    counts[centers, 0] = is_known
    counts[centers, 1] = is_quiet
    n_averages = int(64 * max(1, n_vertices // len(centers)))
    around = rings.outward(rings.averaged(rings.inward(counts), min(n_averages, 1024)))
    # Where hardly a two-ring is known nothing is said to be clean.
    is_known = around[:, 0] > LEAST_KNOWN * len(centers) / n_vertices
    return is_known & (around[:, 1] > MOSTLY_CLEAN * around[:, 0])
