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

Chunk = NDArray[np.floating]
"""High bands of some sites, shape (3, H, n): coordinates, bands, sites."""

Visit = Callable[[int, Chunk], None]
"""`visit(i, chunk)` is called for the high bands of chunk i, on any thread, and may change them in place."""


class Level(Protocol):
    """One level W_j of a frame transform.

    The sites of a level fall into chunks: blocks of vertices or cells that have the same bands. Work is done
    chunk by chunk, so that coefficients which nobody asked for never leave the cache.
    """

    @property
    def sites(self) -> Sequence[NDArray[np.integer] | slice]:
        """For each chunk, which sites it holds."""
        ...

    @property
    def n_sites(self) -> int:
        """Number of sites: vertices or cells."""
        ...

    @property
    def n_vertices(self) -> int:
        """Number of vertices."""
        ...

    @property
    def n_high(self) -> int:
        """Number of high bands, where it differs the largest."""
        ...

    @property
    def chunk_bands(self) -> Sequence[int]:
        """For each chunk, its number of high bands."""
        ...

    @property
    def is_tight(self) -> bool:
        """Whether the level is known to keep energy with respect to its measures."""
        ...

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

    def pending(self, chunks: Sequence[Chunk]) -> NDArray[np.floating]:
        """Return what given high bands add to the rebuilt surface."""
        ...

    def backward(self, next_low: Points | None, pending: NDArray[np.floating]) -> Points:
        """Rebuild `low`, shape (3, N), from the low-pass of this level, or none, and pending high bands."""
        ...

    def adjoint(self, next_low: Points, chunks: Sequence[Chunk]) -> Points:
        """Apply the transposed matrix of the level to its low-pass and high bands."""
        ...

    def weighted_adjoint(self, next_low: Points, chunks: Sequence[Chunk]) -> Points:
        """Apply the adjoint with respect to the measures of the level's input and output."""
        ...
