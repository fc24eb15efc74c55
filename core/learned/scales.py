# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A surface at several scales: low-passes of its positions, and normals and centroids of their faces."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..averages.ring_means import RingMeans
from ..mesh.geometry import fan_areas
from .face_graph import FaceGraph, Polygons

AVERAGES = (2, 10, 48)
"""Numbers k of averages of the low-passes L_k; the surface itself is the first scale."""

N_SCALES = len(AVERAGES) + 1

LENGTH_SCALE = 2
"""The scale on which edges are measured: smooth enough that noise does not make them longer."""

LENGTH_AVERAGES = 12
"""Averages over which lengths of edges are spread, so that the unit of length is smooth."""

LEAST_LENGTH = np.float32(0.05)
"""Share of the length of the edges as they are that smooth ones count for at least."""

SHRUNK = np.float32(1e-3)
"""Share of its area below which the normal of a face that a low-pass has shrunk is not looked at."""

_TINY = 1e-30


class Scales(NamedTuple):
    """What faces look like at all scales; the last axis of the first three has one entry for each scale.

    Attributes
    ----------
    normals : ndarray, shape (3, F, S), float32
        Unit normals; zero for faces without area.
    centroids : ndarray, shape (3, F, S), float32
        Means of the corners.
    areas : ndarray, shape (F, S), float32
        Areas.
    length : ndarray, shape (F,), float32
        The local unit of length: the mean edge length around the face.
    unit : ndarray, shape (N,), float32
        The same around each vertex.
    """

    normals: NDArray[np.float32]
    centroids: NDArray[np.float32]
    areas: NDArray[np.float32]
    length: NDArray[np.float32]
    unit: NDArray[np.float32]


def find_scales(points: NDArray[np.float32], graph: FaceGraph, rings: RingMeans) -> Scales:
    """Return a surface at several scales; `points` are its positions, shape (3, N), float32."""
    scaled, unit = _planes(points, graph, rings)
    scales = Scales(
        np.empty((3, graph.n_faces, N_SCALES), np.float32),
        np.empty((3, graph.n_faces, N_SCALES), np.float32),
        np.empty((graph.n_faces, N_SCALES), np.float32),
        np.empty(graph.n_faces, np.float32),
        unit,
    )

    def kernel(faces: slice, polygons: Polygons) -> None:
        corners = [[plane.take(own, axis=0) for plane in scaled] for own in polygons.corners]
        own_length = unit.take(polygons.corners)
        share = np.float32(1.0 / len(corners))
        np.multiply(own_length.sum(axis=0), share, out=scales.length[faces])
        for axis in range(3):
            total = corners[0][axis] + corners[1][axis]
            for corner in corners[2:]:
                total += corner[axis]
            np.multiply(total, share, out=scales.centroids[axis, faces])
            for corner in corners[1:]:
                corner[axis] -= corners[0][axis]
        area = fan_areas(corners[1:])
        size = area[0] * area[0]
        size += area[1] * area[1]
        size += area[2] * area[2]
        np.sqrt(size, out=size)
        np.multiply(size, np.float32(0.5), out=scales.areas[faces])
        size += np.float32(_TINY)
        for axis in range(3):
            np.divide(area[axis], size, out=scales.normals[axis, faces])
        _keep_normals(scales, faces)

    graph.for_faces(kernel)
    return scales


def _keep_normals(scales: Scales, faces: slice) -> None:
    """Take the normal of the scale before where a low-pass has shrunk a face to a few digits."""
    areas = scales.areas[faces]
    for scale in range(1, N_SCALES):
        gone = np.flatnonzero(areas[:, scale] < SHRUNK * areas[:, 0])
        if len(gone):
            gone += faces.start
            scales.normals[:, gone, scale] = scales.normals[:, gone, scale - 1]


def _planes(
    points: NDArray[np.float32], graph: FaceGraph, rings: RingMeans
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Return the positions at all scales, shape (3, N, S), and the local unit of length, shape (N,)."""
    n_vertices = points.shape[1]
    rows = np.zeros((n_vertices, 4), np.float32)
    rows[:, :3] = rings.inward(np.ascontiguousarray(points.T))
    changes = rings.low_passes(rows, AVERAGES)
    unit = _edge_lengths(rows, changes[LENGTH_SCALE - 1], rings)
    scaled = np.empty((3, n_vertices, N_SCALES), np.float32)

    def gather(start: int, stop: int) -> None:
        place = rings.place[start:stop]
        for scale in range(N_SCALES):
            part = rows.take(place, axis=0)
            if scale:
                part += changes[scale - 1].take(place, axis=0)
            scaled[:, start:stop, scale] = part[:, :3].T

    graph.blocks.run(gather, n_vertices)
    return scaled, unit


def _edge_lengths(
    rows: NDArray[np.float32], change: NDArray[np.float32], rings: RingMeans
) -> NDArray[np.float32]:
    """Return the mean length of the edges around each vertex, shape (N,), in the mesh's numbering.

    `rows` and `change`, shape (N, 4), are positions as numbered inside `rings` and what makes them smooth.
    """
    lengths = np.ones((len(rows), 1), np.float32)

    def measure(part: slice, members: NDArray[np.int32]) -> None:
        if not len(members):
            return
        arms = rows.take(members, axis=0)
        arms -= rows[part]
        noisy = _mean_length(arms)
        arms += change.take(members, axis=0)
        arms -= change[part]
        found = np.maximum(_mean_length(arms), LEAST_LENGTH * noisy)
        lengths[part, 0] = np.where(noisy > 0, found, np.float32(1))

    rings.for_parts(measure)
    # A geometric mean: one huge edge among small ones does not set the unit of all of them.
    np.log(lengths, out=lengths)
    return np.exp(rings.outward(rings.averaged(lengths, LENGTH_AVERAGES))[:, 0])


def _mean_length(arms: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return the mean lengths, shape (n,), of vectors, shape (K, n, 4)."""
    length: NDArray[np.float32] = np.sqrt((arms * arms).sum(axis=2)).mean(axis=0)
    return length
