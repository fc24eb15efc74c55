# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which faces are near each face, and the patches of guided filtering; depends on the topology alone."""

from functools import cached_property
from typing import NamedTuple

import numpy as np

FACES_AT_ONCE = 8192
"""Faces in a block, for whose tables there is always memory."""


class Rows(NamedTuple):
    """Rows of different lengths, none of them empty: row i is `items[offset[i]:offset[i + 1]]`."""

    offset: np.ndarray
    items: np.ndarray

    @property
    def counts(self):
        """Length of each row."""
        return np.diff(self.offset)

    def reduce(self, ufunc, values):
        """Reduce values, shape (..., len(items)), over each row."""
        return ufunc.reduceat(values, self.offset[:-1], axis=-1)

    def spread(self, values):
        """Repeat values, shape (..., n), once for each item of their row."""
        return np.repeat(values, self.counts, axis=-1)


def join(parts):
    """Return parts of rows, each as (counts, items), as one."""
    counts = np.concatenate([part[0] for part in parts])
    offset = np.concatenate(([0], np.cumsum(counts, dtype=np.int64)))
    return Rows(offset, np.concatenate([part[1] for part in parts]).astype(np.int32))


def chosen(rows, wanted):
    """Return the rows with the given numbers, one after the other, and the number of each item's place."""
    counts = rows.counts[wanted]
    begin = np.cumsum(counts) - counts
    place = np.arange(counts.sum()) + np.repeat(rows.offset[wanted] - begin, counts)
    return np.repeat(np.arange(len(wanted)), counts), rows.items[place]


def unique_pairs(row, item, n_items):
    """Return pairs in ascending order, each once."""
    return np.divmod(np.unique(row.astype(np.int64) * n_items + item), n_items)


class FaceGraph:
    """Neighborhoods of the faces of a mesh whose vertices and faces are all used.

    Parameters
    ----------
    surface : SurfaceMesh
        The mesh; its positions do not matter. Each face needs a corner.
    """

    def __init__(self, surface):
        self.n_faces = surface.n_faces
        self.n_vertices = surface.n_vertices
        self.sizes = surface.face_sizes()
        if not self.n_faces or self.sizes.min() < 1:
            raise ValueError("The mesh has no faces, or faces without corners; filters of normals need them.")
        self.corners = Rows(surface.face_offset.astype(np.int64), surface.corner_vertex)
        self._surface = surface

    @cached_property
    def table(self):
        """Corners of the faces, shape (k, F), if all have the same number k; else None."""
        size = int(self.sizes[0])
        if (self.sizes != size).any():
            return None
        return np.ascontiguousarray(self.corners.items.reshape(-1, size).T)

    @cached_property
    def at_vertex(self):
        """Vertices that have faces, shape (V,), and the faces at each of them as rows."""
        face = np.repeat(np.arange(self.n_faces, dtype=np.int32), self.sizes)
        counts = np.bincount(self.corners.items, minlength=self.n_vertices)
        used = np.flatnonzero(counts)
        return used, join([(counts[used], face[np.argsort(self.corners.items, kind="stable")])])

    @cached_property
    def adjacent(self):
        """Pairs of faces that share an edge with no third face, shape (2, E)."""
        edge = self._surface.corner_edge
        face = np.repeat(np.arange(self.n_faces), self.sizes)
        order = np.argsort(edge, kind="stable")
        counts = np.bincount(edge, minlength=self._surface.n_edges)
        first = (np.cumsum(counts) - counts)[counts == 2]
        pairs = face[order[np.stack((first, first + 1))]]
        return pairs[:, pairs[0] != pairs[1]].astype(np.int32)

    @cached_property
    def touching(self):
        """Faces that share a vertex with each face, itself included, ascending."""
        used, faces = self.at_vertex
        row_of = np.zeros(self.n_vertices, np.int64)
        row_of[used] = np.arange(len(used))
        at_corner = Rows(self.corners.offset, row_of[self.corners.items])
        return self._expand(at_corner, faces)

    @cached_property
    def two_rings(self):
        """Faces that touch a face that touches each face, itself included, ascending."""
        return self._expand(self.touching, self.touching)

    def _expand(self, rows, further):
        """Return, for each face, the items of the further rows that its items name."""
        parts = []
        for start in range(0, self.n_faces, FACES_AT_ONCE):
            block = np.arange(start, min(start + FACES_AT_ONCE, self.n_faces))
            row, item = chosen(rows, block)
            place, face = chosen(further, item)
            row, face = unique_pairs(row[place], face, self.n_faces)
            parts.append((np.bincount(row, minlength=len(block)), face))
        return join(parts)

    @cached_property
    def patch_pairs(self):
        """All pairs of faces within each patch `touching`.

        Returns
        -------
        pairs : ndarray, shape (2, P), int32
            Pairs of faces that are together in a patch, each once; the last one is face 0 with itself.
        rows : Rows
            Numbers of the pairs in each patch; a patch of one face has the last one.
        """
        parts, keys = [], []
        for start in range(0, self.n_faces, FACES_AT_ONCE):
            block = np.arange(start, min(start + FACES_AT_ONCE, self.n_faces))
            row, face = chosen(self.touching, block)
            counts = self.touching.counts[block]
            end = np.cumsum(counts)
            after = end[row] - np.arange(len(face)) - 1
            first = np.repeat(np.arange(len(face)), after)
            step = np.arange(len(first)) - np.repeat(np.cumsum(after) - after, after)
            second = first + 1 + step
            n_pairs = np.bincount(row[first], minlength=len(block))
            parts.append((n_pairs, face[first].astype(np.int64) * self.n_faces + face[second]))
            keys.append(np.unique(parts[-1][1]))
        known = np.unique(np.concatenate(keys))
        numbered = []
        for counts, keys_of_block in parts:
            numbers = np.searchsorted(known, keys_of_block)
            at = (np.cumsum(counts) - counts)[counts == 0]
            numbered.append((np.maximum(counts, 1), np.insert(numbers, at, len(known))))
        pairs = np.stack(np.divmod(np.append(known, 0), self.n_faces)).astype(np.int32)
        return pairs, join(numbered)

    @cached_property
    def patch_edges(self):
        """Numbers of the edges of `adjacent` with both faces in each patch; one more number stands for none.

        A patch without an inner edge has the number of edges, so that no row is empty.
        """
        first, second = self.adjacent
        n_edges = len(first)
        # A patch holds an edge if its central face touches both faces of the edge.
        parts = []
        of_face = self._edges_of_faces()
        for start in range(0, self.n_faces, FACES_AT_ONCE):
            block = np.arange(start, min(start + FACES_AT_ONCE, self.n_faces))
            row, face = chosen(self.touching, block)
            inside = row * self.n_faces + face  # ascending
            place, edge = chosen(of_face, face)
            is_own = edge < n_edges
            place, edge = place[is_own], edge[is_own]
            row, other = row[place], second[edge]
            key = row * self.n_faces + other
            found = np.minimum(np.searchsorted(inside, key), len(inside) - 1)
            is_inside = inside[found] == key
            row, edge = row[is_inside], edge[is_inside]
            counts = np.bincount(row, minlength=len(block))
            at = (np.cumsum(counts) - counts)[counts == 0]
            parts.append((np.maximum(counts, 1), np.insert(edge, at, n_edges)))
        return join(parts)

    def _edges_of_faces(self):
        """Return the edges of which each face is the first one; the number of edges where there are none."""
        first = self.adjacent[0]
        counts = np.bincount(first, minlength=self.n_faces)
        at = (np.cumsum(counts) - counts)[counts == 0]
        return join([(np.maximum(counts, 1), np.insert(np.argsort(first, kind="stable"), at, len(first)))])
