# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What every level of a transform can do, whatever its masks and stencils are."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.floating]
"""Coordinates in rows, shape (3, N)."""

Bands = NDArray[np.floating]
"""High bands of some sites, shape (3, H, n): coordinates, bands, sites."""

Sites = Sequence[NDArray[np.integer] | slice]
"""Which sites each chunk of a level holds."""

Visit = Callable[[int, Bands], None]
"""`visit(i, bands)` is called for the high bands of chunk i, on any thread, and may change them in place."""


class Level(Protocol):
    """One level W_j of a frame transform.

    The sites of a level fall into chunks: blocks of vertices or cells that have the same bands. Work is done
    chunk by chunk, so that coefficients which nobody asked for never leave the cache.

    Attributes
    ----------
    sites : sequence of ndarray or slice
        For each chunk, which sites it holds.
    n_sites, n_vertices : int
        Number of sites, which are vertices or cells, and of vertices.
    n_high : int
        Number of high bands, where it differs the largest.
    chunk_bands : list of int
        For each chunk, its number of high bands.
    is_tight : bool
        Whether the level is known to keep energy with respect to its measures.
    """

    sites: Sites
    n_sites: int
    n_vertices: int
    n_high: int
    chunk_bands: list[int]
    is_tight: bool

    def group_starts(self, chunk: int) -> NDArray[np.intp] | None:
        """Return where groups of bands begin that vector shrinkage treats as one; None for single bands."""
        ...

    def unpenalized(self, chunk: int) -> slice:
        """Return the high bands that hold first differences only, which shrinkage leaves alone."""
        ...

    def forward(
        self, low: Points, visit: Visit, *, needs_low: bool = True
    ) -> tuple[Points, NDArray[np.floating]]:
        """Analyze a surface and begin to rebuild it.

        Parameters
        ----------
        low : ndarray, shape (3, N)
            Low-pass of the level before; not modified.
        visit : callable
            Sees the high bands and may change them.
        needs_low : bool
            Whether the low-pass is wanted.

        Returns
        -------
        next_low : ndarray, shape (3, N)
            Low-pass of this level, on the vertices; `low` itself if it is not wanted.
        pending : ndarray
            What the (changed) high bands add to the rebuilt surface; for `backward`. The level may use this
            array again when the same thread calls it the next time.
        """
        ...

    def pending(self, chunks: Sequence[Bands]) -> NDArray[np.floating]:
        """Return what given high bands add to the rebuilt surface."""
        ...

    def backward(self, next_low: Points | None, pending: NDArray[np.floating]) -> Points:
        """Rebuild `low`, shape (3, N), from the low-pass of this level, or none, and pending high bands."""
        ...

    def adjoint(self, next_low: Points, chunks: Sequence[Bands]) -> Points:
        """Apply the transposed matrix of the level to its low-pass and high bands."""
        ...

    def weighted_adjoint(self, next_low: Points, chunks: Sequence[Bands]) -> Points:
        """Apply the adjoint with respect to the measures of the level's input and output."""
        ...
