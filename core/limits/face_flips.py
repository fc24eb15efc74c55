# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Watches the faces of a mesh while its vertices move: which fold, turn over or lose their area."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..mesh.corner_lists import corners_around, corners_of, face_of, faces_at, some_faces
from ..mesh.geometry import area_rows, face_tips
from ..mesh.surface_mesh import SurfaceMesh
from ..mesh.welded_mesh import WeldedMesh

DEGENERATE = 1e-6
"""Area up to which a face counts as degenerate."""

NOWHERE = 1e-6
"""Share of the areas around a face below which their sum is rounding."""

FACES_AT_ONCE = 4096
"""Faces in a block, so that what a kernel holds of them stays in the cache."""


class FaceState(NamedTuple):
    """Faces of a mesh at some positions: `areas` (3, F), `volume`, `is_folded` (F,), `is_degenerate` (F,)."""

    areas: NDArray[np.floating]
    volume: float
    is_folded: NDArray[np.bool_]
    is_degenerate: NDArray[np.bool_]


class FaceFlips:
    """Compares the faces of a mesh with those of its input.

    Normals and areas are those of the surface that moves, its faces turned back where they disagree; which
    faces are neighbors is what the mesh that was worked on says. A face is *folded* if its normal is at more
    than a right angle both to that of a face across one of its edges and to the sum of the normals, weighted
    by area, of the faces at its vertices. Neighbors that do not agree about their orientation, as on a
    surface of one side, tell nothing.

    Areas and volumes are in squared and cubed mean edge lengths.

    Parameters
    ----------
    welded : WeldedMesh
        The meshes.
    before : FaceState, optional
        The faces of the input, if they are known already: what `before` was for the same meshes.

    Attributes
    ----------
    before : FaceState
        The faces of the mesh that was worked on in the input.
    areas : ndarray, shape (3, F)
        Vector areas of the faces after the last look, in the precision of the surface.
    volume : float
        Signed volume of the surface then.
    is_folded, is_degenerate : ndarray, shape (F,), bool
        Which faces are folded then, and which have next to no area.
    n_turned : int
        Faces whose normal had turned by more than a right angle when all faces were looked at last.
    """

    def __init__(self, welded: WeldedMesh, blocks: Blocks, before: FaceState | None = None) -> None:
        self.welded = welded
        self._blocks = blocks.with_block_size(min(blocks.block_size, FACES_AT_ONCE))
        surface = welded.surface
        # Near the mesh, so that volumes of one far away lose no digits.
        self._origin = surface.vertices[surface.corner_vertex[:1]].astype(np.float64).mean(axis=0)
        self._points = np.empty((3, surface.n_vertices))
        self._across = welded.connectivity.face_across
        if not welded.connectivity.is_oriented:
            self._across = self._across.copy()
            self._across[welded.connectivity.disagreeing] = -1
        self.before = self._state(surface.vertices) if before is None else before
        self.areas, self.volume, self.is_folded, self.is_degenerate = self.before
        self._is_over = np.zeros(welded.topology.n_faces, bool)
        self.n_turned = 0

    @property
    def area_before(self) -> float:
        """Area of the faces in the input."""
        return float(np.sqrt(dots(self.before.areas, self.before.areas)).sum())

    def is_bad(self) -> NDArray[np.bool_]:
        """Return which faces are worse than they were, shape (F,): folded, degenerate, or turned over.

        Only faces that nothing can be folded against, as no neighbor agrees with them about the orientation,
        count as turned over, by more than a right angle. Elsewhere old normals tell nothing: under strong
        noise they point anywhere, and a fold or a spike that is smoothed out turns its faces.
        """
        bad = self.is_folded & ~self.before.is_folded
        bad |= self.is_degenerate & ~self.before.is_degenerate
        bad |= self._is_over
        return bad

    def look(self, vertices: NDArray[np.floating]) -> None:
        """Look at all faces at new positions, shape (N, 3)."""
        self.areas, self.volume, self.is_folded, self.is_degenerate = self._state(vertices)
        turned = self._blocks.indices(
            lambda start, stop: self._is_turned(slice(start, stop)), len(self.is_folded)
        )
        self.n_turned = len(turned)
        self._is_over = np.zeros(len(self.is_folded), bool)
        self._is_over[turned] = self._counts_as_over(turned)

    def volume_at(self, vertices: NDArray[np.floating]) -> float:
        """Return the volume at new positions, shape (N, 3). Look at all faces afterwards."""
        return self._measure(vertices)

    def look_around(self, vertices: NDArray[np.floating], changed: NDArray[np.bool_]) -> None:
        """Look again at the faces that some vertices have an influence on; the volume stays as it was.

        Parameters
        ----------
        vertices : ndarray, shape (N, 3)
            New positions; they differ from those of the last look at the changed vertices alone.
        changed : ndarray, shape (n,), bool
            The changed vertices of the mesh that was worked on.
        """
        welded, topology = self.welded, self.welded.topology
        moved = np.flatnonzero(changed if welded.vertex is None else changed[welded.vertex])
        self._points[:, moved] = (vertices[moved].T - self._origin[:, None]) / self.welded.edge
        faces = faces_at(topology, changed)
        areas = self._areas_of(faces)
        self.areas[:, faces] = areas
        self.is_degenerate[faces] = _degenerate(areas)
        self._is_over[faces] = self._is_turned(faces) & self._counts_as_over(faces)
        near = np.zeros(topology.n_vertices, bool)
        near[topology.corner_vertex[corners_of(topology, faces)[1]]] = True
        faces = faces_at(topology, near)
        self.is_folded[faces] = self._folded(self.areas, faces)

    def _state(self, vertices: NDArray[np.floating]) -> FaceState:
        """Return the faces at some positions, and keep those."""
        surface, face = self.welded.surface, self.welded.face
        areas = np.empty((3, surface.n_faces), surface.vertices.dtype)
        is_degenerate = np.empty(surface.n_faces, bool)
        volume = self._measure(vertices, areas, is_degenerate)
        if face is not None:
            areas, is_degenerate = areas[:, face], is_degenerate[face]
        return FaceState(areas, volume, self._folded(areas), is_degenerate)

    def _measure(
        self,
        vertices: NDArray[np.floating],
        areas: NDArray[np.floating] | None = None,
        is_degenerate: NDArray[np.bool_] | None = None,
    ) -> float:
        """Return the volume at some positions, and keep those; fill the areas and flags of all faces."""
        surface, points = self.welded.surface, self._points

        def move(start: int, stop: int) -> None:
            part = points[:, start:stop]
            part[:] = vertices[start:stop].T
            part -= self._origin[:, None]
            part /= self.welded.edge

        def kernel(start: int, stop: int) -> float:
            part = area_rows(points, surface, start, stop)
            if areas is not None:
                areas[:, start:stop] = part
            if is_degenerate is not None:
                is_degenerate[start:stop] = _degenerate(part)
            return float((face_tips(points, surface, start, stop) * part).sum()) / 3.0

        self._blocks.run(move, surface.n_vertices)
        return sum(self._blocks.run(kernel, surface.n_faces))

    def _areas_of(self, faces: NDArray[np.intp]) -> NDArray[np.float64]:
        """Return the vector areas of some faces of the mesh that was worked on, shape (3, n)."""
        own = faces if self.welded.face is None else self.welded.face[faces]
        part: SurfaceMesh = some_faces(self.welded.surface, own)
        return area_rows(self._points, part, 0, part.n_faces)

    def _is_turned(self, faces: NDArray[np.intp] | slice) -> NDArray[np.bool_]:
        """Return which of some faces point away from where they pointed, shape (n,), bool.

        The normal of a face that had no area was rounding, which it cannot turn from.
        """
        cosine = dots(self.areas[:, faces], self.before.areas[:, faces])
        return (cosine < 0.0) & ~self.before.is_degenerate[faces]

    def _counts_as_over(self, faces: NDArray[np.intp]) -> NDArray[np.bool_]:
        """Return which of some faces count as turned over if their normals have turned, shape (n,), bool."""
        counts, corner = corners_of(self.welded.topology, faces)
        own = np.repeat(np.arange(len(faces)), counts)
        return np.bincount(own, self._across[corner] >= 0, len(faces)) == 0.0

    def _folded(
        self, areas: NDArray[np.floating], faces: NDArray[np.intp] | None = None
    ) -> NDArray[np.bool_]:
        """Return which of some faces, by default of all, are folded, shape (n,), bool."""
        n_faces = areas.shape[1] if faces is None else len(faces)
        size = self.welded.topology.common_face_size()

        def kernel(start: int, stop: int) -> NDArray[np.bool_]:
            if faces is None and size:
                return self._neighbors_disagree(areas, start, stop, size)
            return self._disagrees(areas, np.arange(start, stop) if faces is None else faces[start:stop])

        parts = self._blocks.run(kernel, n_faces)
        folded = np.concatenate(parts) if parts else np.zeros(0, bool)
        some = np.flatnonzero(folded)

        def look_around(start: int, stop: int) -> None:
            part = some[start:stop]
            wanted = part if faces is None else faces[part]
            folded[part] = self._opposes_around(areas, wanted)

        self._blocks.run(look_around, len(some))
        return folded

    def _neighbors_disagree(
        self, areas: NDArray[np.floating], start: int, stop: int, size: int
    ) -> NDArray[np.bool_]:
        """Do what `_disagrees` does for the faces start to stop, all of them with `size` corners."""
        across = self._across[size * start : size * stop].reshape(-1, size)
        own, result = areas[:, start:stop], np.zeros(stop - start, bool)
        for corner in range(size):
            other = np.ascontiguousarray(across[:, corner], np.intp)
            result |= (dots(own, areas.take(other, axis=1, mode="clip")) < 0.0) & (other >= 0)
        return result

    def _disagrees(self, areas: NDArray[np.floating], faces: NDArray[np.intp]) -> NDArray[np.bool_]:
        """Return which of some faces are at more than a right angle to one across an edge, shape (n,)."""
        counts, corner = corners_of(self.welded.topology, faces)
        other = self._across[corner]
        own = np.repeat(np.arange(len(faces)), counts)
        mine = areas.take(faces, axis=1)
        cosine = dots(mine.take(own, axis=1), areas.take(other, axis=1, mode="clip"))
        result = np.zeros(len(faces), bool)
        result[own[(cosine < 0.0) & (other >= 0)]] = True
        return result

    def _opposes_around(self, areas: NDArray[np.floating], faces: NDArray[np.intp]) -> NDArray[np.bool_]:
        """Return which of some faces are at more than a right angle to the sum of those at their corners.

        Where these cancel out, as a face and its copy that is turned over, the sum points nowhere.
        """
        topology = self.welded.topology
        counts, corner = corners_of(topology, faces)
        wanted = topology.corner_vertex[corner]
        vertices = np.unique(wanted).astype(np.intp)
        number = np.empty(topology.n_vertices, np.int32)  # of the others nobody asks
        number[vertices] = np.arange(len(vertices), dtype=np.int32)
        near = corners_around(topology, self.welded.connectivity, vertices)
        place, face = number[topology.corner_vertex[near]], face_of(topology, near)
        own = np.repeat(np.arange(len(faces)), counts)
        there, mine = areas[:, face], areas[:, faces].astype(np.float64)
        sums = [np.bincount(place, row, len(vertices)) for row in (*there, np.sqrt(dots(there, there)))]
        sums = [np.bincount(own, row[number[wanted]], len(faces)) for row in sums]
        return dots(mine, np.stack(sums[:3])) < -NOWHERE * sums[3] * np.sqrt(dots(mine, mine))


def _degenerate(areas: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Return which vector areas, shape (3, n), are next to nothing, shape (n,), bool."""
    return dots(areas, areas) <= DEGENERATE * DEGENERATE


def dots(first: NDArray[np.floating], second: NDArray[np.floating]) -> NDArray[np.floating]:
    """Return the inner products of vectors with coordinates in rows, shape (n,)."""
    result: NDArray[np.floating] = first[0] * second[0]
    result += first[1] * second[1]
    result += first[2] * second[2]
    return result
