# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Stencils: which points fill the taps of each vertex's mask.

A point is a vertex or a *virtual* point, a fixed affine combination of vertices (a mean, a midpoint, a
mirrored point). Virtual points are numbered behind the vertices, so that a stencil is one table of indices
and filling the data-matrix is one gather.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks


@dataclass(frozen=True, eq=False)
class Stencil:
    """Taps of every site: of every vertex, or of every cell for cell-centered masks.

    Attributes
    ----------
    n_vertices : int
        Number of vertices, N.
    slots : ndarray, shape (T, n_sites), int32
        Point under each tap. Numbers from N on are virtual points. With `is_vertex_centered`, site k is
        vertex k and tap 0 is the vertex itself.
    is_vertex_centered : bool
        True if the sites are the vertices.
    virtual_offset : ndarray, shape (X + 1,), int64
        Virtual point x combines the vertices `virtual_vertex[virtual_offset[x]:virtual_offset[x + 1]]`.
    virtual_vertex : ndarray, shape (Y,), int32
        Vertices of the combinations.
    virtual_weight : ndarray, shape (Y,), float64
        Their weights, which sum to 1 for each virtual point.
    is_irregular : ndarray, shape (n_sites,), bool
        Sites that took a rule for irregular ones, boundary ones included.
    """

    n_vertices: int
    slots: NDArray[np.int32]
    is_vertex_centered: bool
    virtual_offset: NDArray[np.int64]
    virtual_vertex: NDArray[np.int32]
    virtual_weight: NDArray[np.float64]
    is_irregular: NDArray[np.bool_]

    @property
    def n_sites(self) -> int:
        """Number of sites."""
        return self.slots.shape[1]

    @property
    def n_taps(self) -> int:
        """Number of taps, T, the vertex included."""
        return len(self.slots)

    @property
    def n_points(self) -> int:
        """Number of points, N + X: vertices, then virtual points."""
        return self.n_vertices + len(self.virtual_offset) - 1

    def fill_virtual(self, points: NDArray[np.floating], blocks: Blocks) -> None:
        """Compute the virtual points from the vertices, in place.

        Parameters
        ----------
        points : ndarray, shape (3, N + X)
            Coordinates in rows; the first N columns are read, the others are written.
        """
        offset = self.virtual_offset

        def kernel(start: int, stop: int) -> None:
            part = slice(offset[start], offset[stop])
            members = points.take(self.virtual_vertex[part], axis=1, mode="clip")
            members *= self.virtual_weight[part].astype(points.dtype)
            virtual = points[:, self.n_vertices + start : self.n_vertices + stop]
            if members.shape[1] == 2 * (stop - start) and (np.diff(offset[start : stop + 1]) == 2).all():
                np.add(members[:, 0::2], members[:, 1::2], out=virtual)  # midpoints and mirror images
            else:
                np.add.reduceat(members, offset[start:stop] - offset[start], axis=1, out=virtual)

        blocks.run(kernel, len(offset) - 1)

    def extended(self, vertices: NDArray[np.floating], blocks: Blocks | None = None) -> NDArray[np.floating]:
        """Return the coordinates of all points in rows, shape (3, N + X), from vertices of shape (N, 3)."""
        points = np.empty((3, self.n_points), vertices.dtype)
        points[:, : self.n_vertices] = vertices.T
        self.fill_virtual(points, blocks or Blocks(1))
        return points

    def gather(
        self, points: NDArray[np.floating], start: int, stop: int, out: NDArray[np.floating] | None = None
    ) -> NDArray[np.floating]:
        """Return the data-matrix of sites start to stop, shape (3, T, stop - start)."""
        if out is None:
            out = np.empty((3, self.n_taps, stop - start), points.dtype)
        if not self.is_vertex_centered:
            return _taken(points, self.slots[:, start:stop], out)
        out[:, 0] = points[:, start:stop]  # tap 0 needs no look-up
        self.gather_rings(points, start, stop, out[:, 1:])
        return out

    def gather_rings(
        self, points: NDArray[np.floating], start: int, stop: int, out: NDArray[np.floating]
    ) -> NDArray[np.floating]:
        """Write the points under all taps but the first, shape (3, T - 1, stop - start)."""
        return _taken(points, self.slots[1:, start:stop], out)

    def data_matrix(self, vertices: NDArray[np.floating]) -> NDArray[np.floating]:
        """Return the whole data-matrix D = C(S) of section 3.1, shape (T, n_sites, 3)."""
        return self.gather(self.extended(vertices), 0, self.n_sites).transpose(1, 2, 0)


def _taken(
    points: NDArray[np.floating], slots: NDArray[np.int32], out: NDArray[np.floating]
) -> NDArray[np.floating]:
    """Write the points with some numbers, shape (3, T, n)."""
    index = slots.astype(np.intp)  # once, not for each coordinate
    for row, own in zip(points, out, strict=True):
        np.take(row, index, out=own, mode="clip")
    return out
