# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Watches the faces of a mesh while its vertices move: which fold, turn over or lose their area."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..surface.geometry import area_rows, face_tips
from ..surface.surface_mesh import SurfaceMesh
from .carrier import Carrier
from .corner_lists import corners_of, face_of, faces_at, some_faces

DEGENERATE = 1e-6
"""Area up to which a face counts as degenerate."""


class FaceWatch:
    """Compares the faces of a mesh with those of its input.

    Normals and areas are those of the carrier's surface; which faces are neighbors is what the mesh that was
    worked on says. A face is *folded* if its normal is at more than a right angle both to that of a face
    across one of its edges and to the sum of the normals, weighted by area, of the faces at its vertices.
    Where faces do not agree about their orientation nothing counts as folded.

    Areas and volumes are in squared and cubed mean edge lengths.

    Parameters
    ----------
    carrier : Carrier
        The meshes.
    blocks : Blocks
        Threads to work on.

    Attributes
    ----------
    before, areas : ndarray, shape (3, F), float64
        Vector areas of the faces of the mesh that was worked on, in the input and after the last look.
    volume_before, volume : float
        Signed volumes of the surface, then and now.
    was_folded, is_folded : ndarray, shape (F,), bool
        Which faces are folded, then and now.
    was_degenerate, is_degenerate : ndarray, shape (F,), bool
        Which faces have next to no area, then and now.
    """

    def __init__(self, carrier: Carrier, blocks: Blocks) -> None:
        self.carrier = carrier
        self._blocks = blocks
        surface = carrier.surface
        # Near the mesh, so that volumes of one far away lose no digits.
        self._origin = surface.vertices[surface.corner_vertex[:1]].astype(np.float64).mean(axis=0)
        self._points = np.empty((3, surface.n_vertices))
        self.before, self.volume_before = self._measure(surface.vertices)
        self.was_folded = self._folded(self.before)
        self.was_degenerate = self._degenerate(self.before)
        self.areas, self.volume = self.before, self.volume_before
        self.is_folded, self.is_degenerate = self.was_folded, self.was_degenerate
        self._is_over = np.zeros(carrier.topology.n_faces, bool)
        has_other = np.flatnonzero(carrier.connectivity.face_across >= 0)
        self._is_single = np.ones(carrier.topology.n_faces, bool)
        self._is_single[face_of(carrier.topology, has_other)] = False

    @property
    def area_before(self) -> float:
        """Area of the faces in the input."""
        return float(np.sqrt(dots(self.before, self.before)).sum())

    @property
    def n_turned(self) -> int:
        """Faces whose normal has turned by more than a right angle."""
        return int(np.count_nonzero(dots(self.areas, self.before) < 0.0))

    def is_bad(self) -> NDArray[np.bool_]:
        """Return which faces are worse than they were, shape (F,): folded, degenerate, or turned over.

        Only faces that nothing can be folded against count as turned over, by more than a right angle: those
        without a face across an edge, and all where faces do not agree about their orientation. Elsewhere old
        normals tell nothing: under strong noise they point anywhere, and a fold or a spike that is smoothed
        out turns its faces.
        """
        bad = self.is_folded & ~self.was_folded
        bad |= self.is_degenerate & ~self.was_degenerate
        bad |= self._is_over
        return bad

    def look(self, vertices: NDArray[np.floating]) -> None:
        """Look at all faces at new positions, shape (N, 3)."""
        self.areas, self.volume = self._measure(vertices)
        self.is_folded = self._folded(self.areas)
        self.is_degenerate = self._degenerate(self.areas)
        self._is_over = self._over()

    def volume_at(self, vertices: NDArray[np.floating]) -> float:
        """Return the volume at new positions, shape (N, 3). Look at all faces afterwards."""
        return self._measure(vertices)[1]

    def look_around(self, vertices: NDArray[np.floating], changed: NDArray[np.bool_]) -> None:
        """Look again at the faces that some vertices have an influence on; the volume stays as it was.

        Parameters
        ----------
        vertices : ndarray, shape (N, 3)
            New positions; they differ from those of the last look at the changed vertices alone.
        changed : ndarray, shape (n,), bool
            The changed vertices of the mesh that was worked on.
        """
        carrier, topology = self.carrier, self.carrier.topology
        moved = np.flatnonzero(changed if carrier.vertex is None else changed[carrier.vertex])
        self._points[:, moved] = (vertices[moved].T - self._origin[:, None]) / self.carrier.edge
        faces = faces_at(topology, changed)
        self.areas[:, faces] = self._areas_of(faces)
        self.is_degenerate[faces] = self._degenerate(self.areas[:, faces])
        self._is_over[faces] = self._over(faces)
        near = np.zeros(topology.n_vertices, bool)
        near[topology.corner_vertex[corners_of(topology, faces)[1]]] = True
        faces = faces_at(topology, near)
        self.is_folded[faces] = self._folded(self.areas, faces)

    def _measure(self, vertices: NDArray[np.floating]) -> tuple[NDArray[np.float64], float]:
        """Return the vector areas of all faces and the volume at some positions, and keep those."""
        surface, points = self.carrier.surface, self._points
        areas = np.empty((3, surface.n_faces))

        def move(start: int, stop: int) -> None:
            part = points[:, start:stop]
            part[:] = vertices[start:stop].T
            part -= self._origin[:, None]
            part /= self.carrier.edge

        def kernel(start: int, stop: int) -> float:
            part = area_rows(points, surface, start, stop)
            areas[:, start:stop] = part
            return float((face_tips(points, surface, start, stop) * part).sum()) / 3.0

        self._blocks.run(move, surface.n_vertices)
        volume = sum(self._blocks.run(kernel, surface.n_faces))
        return (areas if self.carrier.face is None else areas[:, self.carrier.face]), volume

    def _areas_of(self, faces: NDArray[np.intp]) -> NDArray[np.float64]:
        """Return the vector areas of some faces of the mesh that was worked on, shape (3, n)."""
        own = faces if self.carrier.face is None else self.carrier.face[faces]
        part: SurfaceMesh = some_faces(self.carrier.surface, own)
        return area_rows(self._points, part, 0, part.n_faces)

    def _degenerate(self, areas: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Return which vector areas are next to nothing, shape (n,), bool."""
        return dots(areas, areas) <= DEGENERATE * DEGENERATE

    def _over(self, faces: NDArray[np.intp] | None = None) -> NDArray[np.bool_]:
        """Return which of some faces, by default of all, count as turned over, shape (n,), bool."""
        if faces is None:
            over = dots(self.areas, self.before) < 0.0
        else:
            over = dots(self.areas[:, faces], self.before[:, faces]) < 0.0
        if self.carrier.connectivity.is_oriented:
            over &= self._is_single if faces is None else self._is_single[faces]
        return over

    def _folded(self, areas: NDArray[np.float64], faces: NDArray[np.intp] | None = None) -> NDArray[np.bool_]:
        """Return which of some faces, by default of all, are folded, shape (n,), bool."""
        n_faces = areas.shape[1] if faces is None else len(faces)
        if not self.carrier.connectivity.is_oriented:
            return np.zeros(n_faces, bool)
        size = self.carrier.topology.common_face_size()

        def kernel(start: int, stop: int) -> NDArray[np.bool_]:
            if faces is None and size:
                return self._neighbors_disagree(areas, start, stop, size)
            return self._disagrees(areas, np.arange(start, stop) if faces is None else faces[start:stop])

        parts = self._blocks.run(kernel, n_faces)
        folded = np.concatenate(parts) if parts else np.zeros(0, bool)
        some = np.flatnonzero(folded)
        if len(some):
            wanted = some if faces is None else faces[some]
            folded[some] = dots(areas[:, wanted], self._around(areas, wanted)) < 0.0
        return folded

    def _neighbors_disagree(
        self, areas: NDArray[np.float64], start: int, stop: int, size: int
    ) -> NDArray[np.bool_]:
        """Do what `_disagrees` does for the faces start to stop, all of them with `size` corners."""
        across = self.carrier.connectivity.face_across[size * start : size * stop].reshape(-1, size)
        own, result = areas[:, start:stop], np.zeros(stop - start, bool)
        for corner in range(size):
            other = np.ascontiguousarray(across[:, corner], np.intp)
            result |= (dots(own, areas.take(other, axis=1, mode="clip")) < 0.0) & (other >= 0)
        return result

    def _disagrees(self, areas: NDArray[np.float64], faces: NDArray[np.intp]) -> NDArray[np.bool_]:
        """Return which of some faces are at more than a right angle to one across an edge, shape (n,)."""
        counts, corner = corners_of(self.carrier.topology, faces)
        other = self.carrier.connectivity.face_across[corner]
        own = np.repeat(np.arange(len(faces)), counts)
        mine = areas.take(faces, axis=1)
        cosine = dots(mine.take(own, axis=1), areas.take(other, axis=1, mode="clip"))
        result = np.zeros(len(faces), bool)
        result[own[(cosine < 0.0) & (other >= 0)]] = True
        return result

    def _around(self, areas: NDArray[np.float64], faces: NDArray[np.intp]) -> NDArray[np.float64]:
        """Return the sums of the vector areas around the corners of some faces, shape (3, n)."""
        topology = self.carrier.topology
        counts, corner = corners_of(topology, faces)
        wanted = topology.corner_vertex[corner]
        number = np.full(topology.n_vertices, -1, np.int32)
        number[wanted] = 0
        vertices = np.flatnonzero(number == 0)
        number[vertices] = np.arange(len(vertices), dtype=np.int32)
        place = number[topology.corner_vertex]
        near = np.flatnonzero(place >= 0)
        face = face_of(topology, near)
        own = np.repeat(np.arange(len(faces)), counts)
        sums = [np.bincount(place[near], row[face], len(vertices)) for row in areas]
        return np.stack([np.bincount(own, row[number[wanted]], len(faces)) for row in sums])


def dots(first: NDArray[np.float64], second: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the inner products of vectors with coordinates in rows, shape (n,)."""
    result: NDArray[np.float64] = first[0] * second[0]
    result += first[1] * second[1]
    result += first[2] * second[2]
    return result
