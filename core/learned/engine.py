# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the net and the fit need of a mesh besides its positions, made once."""

from __future__ import annotations

from copy import copy

import numpy as np
from numpy.typing import NDArray

from ..averages.means import Means
from ..averages.ring_means import RingMeans
from ..blocks import Blocks
from ..mesh.connectivity import Connectivity
from ..mesh.corner_lists import faces_of_vertices
from ..mesh.geometry import fan_areas
from ..mesh.ragged import Ragged
from ..mesh.surface_mesh import SurfaceMesh
from .face_graph import FaceGraph, Polygons
from .features import Features, find_features
from .islands import LEAST_ISLAND, find_islands
from .measured import Measured, find_measured
from .residual import Residual, find_residual
from .scales import Scales, find_scales
from .screened_fit import ScreenedFit

LONG = 8.0
"""Length in mean lengths of the edges at its ends from which an edge is long."""


def long_edges(surface: SurfaceMesh, connectivity: Connectivity) -> NDArray[np.bool_]:
    """Return edges that are long beside the others at one of their ends, shape (E,), bool."""
    one, two = surface.edges.T
    step = surface.vertices[one].astype(np.float64) - surface.vertices[two]
    length = np.sqrt((step * step).sum(axis=1))
    has_face = connectivity.edge_face_count > 0
    # Means of logarithms: the long edges themselves hardly count.
    logarithm = np.where(has_face, np.log(np.maximum(length, 1e-300)), 0.0)
    total = np.bincount(one, logarithm, surface.n_vertices) + np.bincount(two, logarithm, surface.n_vertices)
    mean = total / np.maximum(connectivity.valence, 1)
    return has_face & (logarithm - np.minimum(mean[one], mean[two]) > np.log(LONG))


class FaceEngine:
    """Tables of a mesh: pairs of faces, rings, faces at vertices, islands.

    Edges that are many times as long as those around one of their ends make no neighbors in rings: the far
    end of a huge triangle says nothing about what is here.

    Parameters
    ----------
    surface : SurfaceMesh
        The mesh; of its positions only which edges are long counts.
    connectivity : Connectivity
        Its neighborhoods.
    blocks : Blocks
        Threads to work on.
    faces_at_once : int, optional
        Faces or pairs in a block; see `FaceGraph`.
    least_island : int, optional
        Faces from which a connected part is an island of its own.
    """

    def __init__(
        self,
        surface: SurfaceMesh,
        connectivity: Connectivity,
        blocks: Blocks,
        faces_at_once: int = 0,
        least_island: int = LEAST_ISLAND,
    ) -> None:
        self.graph = FaceGraph(surface, connectivity, blocks, faces_at_once)
        self._blocks, self._is_long = blocks, long_edges(surface, connectivity)
        self.rings = RingMeans(surface, connectivity, blocks, self._is_long)
        at_vertex = faces_of_vertices(surface, connectivity)
        if self.graph.order is not None:
            number = np.full(surface.n_faces, -1, np.int32)
            number[self.graph.order] = np.arange(self.graph.n_faces, dtype=np.int32)
            items = number[at_vertex.items]
            at_vertex = Ragged(at_vertex.offset, items).kept(items >= 0)
        self.at_vertex = Means(at_vertex, blocks, is_square=False)
        self.fit = ScreenedFit(self.graph, self.at_vertex, self.rings)
        self.island = find_islands(self.graph, least_island)
        self.is_inside = ~connectivity.is_boundary & ~connectivity.is_loose
        self.is_regular = self.is_inside & ~connectivity.is_irregular()

    def for_positions(self, surface: SurfaceMesh, connectivity: Connectivity) -> FaceEngine:
        """Return the engine for other positions of the same mesh: this one, unless other edges are long."""
        is_long = long_edges(surface, connectivity)
        if np.array_equal(self._is_long, is_long):
            return self
        other = copy(self)
        other._is_long = is_long
        other.rings = RingMeans(surface, connectivity, self._blocks, is_long)
        other.fit = ScreenedFit(self.graph, self.at_vertex, other.rings)
        return other

    def describe(
        self,
        points: NDArray[np.float32],
        residual: Residual | None = None,
        log_strength: float = 0.0,
        measured: Measured | None = None,
    ) -> tuple[Scales, Features]:
        """Return scales and features of positions, shape (3, N), float32; see `find_features`."""
        scales = find_scales(points, self.graph, self.rings)
        return scales, find_features(
            scales, self.graph, self.rings, self.at_vertex, self.island, residual, log_strength, measured
        )

    def measured(self, movable: NDArray[np.bool_]) -> Measured | None:
        """Return where noise is measured if these vertices may move, shape (N,); None for everywhere."""
        return find_measured(movable, self.graph, self.island)

    def residual(
        self, before: NDArray[np.float32], after: NDArray[np.float32], measured: Measured | None = None
    ) -> Residual:
        """Return what was taken away between two positions, shape (3, N)."""
        movable = None if measured is None else measured.movable
        return find_residual(self.offsets(before, after), self.rings, movable)

    def face_vectors(self, points: NDArray[np.float32]) -> NDArray[np.float32]:
        """Return normals of the faces of the graph times their areas, shape (F, 4); the fourth is 0."""
        areas = np.zeros((self.graph.n_faces, 4), np.float32)

        def measure(faces: slice, polygons: Polygons) -> None:
            first, *others = (points.take(own, axis=1) for own in polygons.corners)
            for axis, area in enumerate(fan_areas([other - first for other in others])):
                areas[faces, axis] = area

        self.graph.for_faces(measure)
        return areas

    def vertex_normals(self, points: NDArray[np.float32]) -> NDArray[np.float32]:
        """Return unit vertex normals, shape (3, N): area-weighted means of the faces around a vertex."""
        means = self.at_vertex.outward(self.at_vertex.mean(self.face_vectors(points)))[:, :3].T
        return means / np.maximum(np.sqrt((means * means).sum(axis=0)), np.float32(1e-30))

    def offsets(self, before: NDArray[np.float32], after: NDArray[np.float32]) -> NDArray[np.float32]:
        """Return displacements along the normals of the positions after, shape (N,): what was taken away."""
        step = before - after
        step *= self.vertex_normals(after)
        return step.sum(axis=0)
