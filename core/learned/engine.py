# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the net and the fit need of a mesh besides its positions, made once."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ..averages.means import Means
from ..averages.ragged import Ragged, faces_of_vertices
from ..averages.ring_means import RingMeans
from ..blocks import Blocks
from ..surface.connectivity import Connectivity
from ..surface.surface_mesh import SurfaceMesh
from .face_graph import FaceGraph
from .features import Features, find_features
from .islands import find_islands
from .net import Net
from .scales import Scales, find_scales
from .screened_fit import ScreenedFit, fan_areas
from .stillness import find_still


class FaceEngine:
    """Tables of a mesh: pairs of faces, rings, faces at vertices, islands.

    Parameters
    ----------
    surface : SurfaceMesh
        The mesh; its positions are not looked at.
    connectivity : Connectivity
        Its neighborhoods.
    blocks : Blocks
        Threads to work on.
    """

    def __init__(self, surface: SurfaceMesh, connectivity: Connectivity, blocks: Blocks) -> None:
        self.graph = FaceGraph(surface, connectivity, blocks)
        self.rings = RingMeans(surface, connectivity, blocks)
        at_vertex = faces_of_vertices(surface, connectivity)
        if self.graph.order is not None:
            number = np.full(surface.n_faces, -1, np.int32)
            number[self.graph.order] = np.arange(self.graph.n_faces, dtype=np.int32)
            items = number[at_vertex.items]
            is_there = items >= 0
            offset = np.concatenate(([0], np.cumsum(is_there)))[at_vertex.offset]
            at_vertex = Ragged(offset, items[is_there])
        self.at_vertex = Means(at_vertex, blocks, is_square=False)
        self.fit = ScreenedFit(self.graph, self.at_vertex, self.rings)
        self.island = find_islands(self.graph)

    def describe(
        self, points: NDArray[np.float32], log_strength: float = 0.0, width: float = 0.0
    ) -> tuple[Scales, Features]:
        """Return scales and features of positions, shape (3, N), float32."""
        scales = find_scales(points, self.graph, self.rings)
        return scales, find_features(
            scales, self.graph, self.rings, self.at_vertex, self.island, log_strength, width
        )

    def find_still(
        self,
        points: NDArray[np.float32],
        surface: SurfaceMesh,
        connectivity: Connectivity,
        scales: Scales,
        blocks: Blocks,
    ) -> NDArray[np.bool_]:
        """Return the vertices that are clean and stay, shape (N,)."""
        return find_still(points, surface, connectivity, scales, self.graph, self.rings, blocks)

    def normals(
        self, net: Net, scales: Scales, features: Features, tick: Callable[[], None] = lambda: None
    ) -> NDArray[np.float32]:
        """Return clean unit normals of the faces of the graph, shape (3, F)."""
        return net.normals(scales, features, self.graph, tick)

    def vertex_normals(self, points: NDArray[np.float32]) -> NDArray[np.float32]:
        """Return unit vertex normals, shape (3, N): area-weighted means of the faces around a vertex."""
        areas = np.zeros((self.graph.n_faces, 4), np.float32)
        self.graph.for_faces(
            lambda faces, polygons: np.copyto(
                areas[faces, :3], fan_areas([points.take(own, axis=1) for own in polygons.corners]).T
            )
        )
        means = self.at_vertex.outward(self.at_vertex.mean(areas))[:, :3].T
        return means / np.maximum(np.sqrt((means * means).sum(axis=0)), np.float32(1e-30))

    def offsets(self, before: NDArray[np.float32], after: NDArray[np.float32]) -> NDArray[np.float32]:
        """Return displacements along the normals of the positions after, shape (N,): what was taken away."""
        step = before - after
        step *= self.vertex_normals(after)
        return step.sum(axis=0)
