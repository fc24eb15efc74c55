# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The multi-level tight wavelet frame transform of a surface (3.7), its inverse and its adjoint."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .coefficients import FrameCoefficients
from .level import Chunk, Level, Points, Visit


@dataclass(frozen=True, eq=False)
class FrameTransform:
    """A linear transform W with frozen stencils: levels from fine to coarse."""

    levels: tuple[Level, ...]
    dtype: np.dtype

    def analyze(self, vertices: NDArray[np.floating]) -> FrameCoefficients:
        """Decompose positions, shape (N, 3), into frame coefficients W S."""
        low = np.ascontiguousarray(np.asarray(vertices).T, self.dtype)
        chunks: list[list[Chunk]] = []
        for level in self.levels:
            kept: list[Chunk] = [low] * len(level.sites)

            def keep(index: int, chunk: Chunk, kept: list[Chunk] = kept) -> None:
                kept[index] = chunk.copy()

            low, _ = level.forward(low, keep)
            chunks.append(kept)
        return FrameCoefficients(np.ascontiguousarray(low.T), chunks, self)

    def synthesize(self, coefficients: FrameCoefficients) -> NDArray[np.floating]:
        """Rebuild positions, shape (N, 3), from frame coefficients; `synthesize(analyze(S))` is S."""
        low = np.ascontiguousarray(coefficients.low.T, self.dtype)
        for level, chunks in zip(reversed(self.levels), reversed(coefficients.chunks), strict=True):
            low = level.backward(low, level.pending(chunks))
        return np.ascontiguousarray(low.T)

    def adjoint(self, coefficients: FrameCoefficients) -> NDArray[np.floating]:
        """Apply the adjoint W', the transposed matrix, shape (N, 3): <W S, c> = <S, W' c> in every frame."""
        low = np.ascontiguousarray(coefficients.low.T, self.dtype)
        for level, chunks in zip(reversed(self.levels), reversed(coefficients.chunks), strict=True):
            low = level.adjoint(low, chunks)
        return np.ascontiguousarray(low.T)

    def weighted_adjoint(self, coefficients: FrameCoefficients) -> NDArray[np.floating]:
        """Apply the adjoint with respect to `measures`, shape (N, 3): <W S, c>_m' = <S, W* c>_m.

        With masks that fit the valence it is the inverse. In other frames all measures are 1, and it is
        the same as `adjoint`.
        """
        low = np.ascontiguousarray(coefficients.low.T, self.dtype)
        for level, chunks in zip(reversed(self.levels), reversed(coefficients.chunks), strict=True):
            low = level.weighted_adjoint(low, chunks)
        return np.ascontiguousarray(low.T)

    def measures(self) -> list[NDArray[np.floating]]:
        """Return the measures at the input of each level and at the end, L + 1 arrays of shape (N,)."""
        one = np.ones(self.levels[0].n_vertices)
        return [*(getattr(level, "measure", one) for level in self.levels), one]

    def rebuild_changes(self, low: Points, visits: Sequence[Visit]) -> Points:
        """Analyze positions, let each level's visit turn its bands into changes of them, and rebuild those.

        Parameters
        ----------
        low : ndarray, shape (3, N)
            Positions; not modified.
        visits : sequence of callable
            For each level, replaces high bands by what is to be added to them.

        Returns
        -------
        ndarray, shape (3, N)
            What is to be added to the positions: as everything is linear and the positions are rebuilt
            perfectly, they need not go all the way. Valid until this thread uses the transform again.
        """
        waiting = []
        for index, (level, visit) in enumerate(zip(self.levels, visits, strict=True), 1):
            low, pending = level.forward(low, visit, needs_low=index < len(self.levels))
            waiting.append(pending)
        change: Points | None = None
        del low, pending
        for level in reversed(self.levels):
            change = level.backward(change, waiting.pop())
        assert change is not None
        return change
