# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Frame coefficients of a surface."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .level import Bands

if TYPE_CHECKING:
    from .frame_transform import FrameTransform


@dataclass(frozen=True, eq=False)
class FrameCoefficients:
    """Frame coefficients of a surface, in the unit of its positions.

    Attributes
    ----------
    low : ndarray, shape (N, 3)
        The low-pass of the coarsest level, a smooth surface.
    chunks : list of list of ndarray
        For each level, finest first, the high bands chunk by chunk, each of shape (3, H, n).
    transform : FrameTransform
        The transform that made them.
    """

    low: NDArray[np.floating]
    chunks: list[list[Bands]]
    transform: FrameTransform

    def __iter__(self) -> Iterator[NDArray[np.floating]]:
        return (self[place] for place in range(len(self)))

    def __len__(self) -> int:
        return 1 + len(self.chunks)

    def __getitem__(self, place: int) -> NDArray[np.floating]:
        """Return an array of coefficients, coarse to fine: the low-pass, then each level's high bands."""
        if not -len(self) <= place < len(self):
            raise IndexError(place)
        place %= len(self)
        return self.low if place == 0 else self.details(len(self.chunks) - place)

    def details(self, level: int) -> NDArray[np.floating]:
        """Return the high bands of a level as one array, shape (H, n_sites, 3).

        With masks that fit the valence, bands that a vertex does not have are zero.
        """
        stage = self.transform.levels[level]
        chunks = self.chunks[level]
        n_high = max((chunk.shape[1] for chunk in chunks), default=0)
        bands = np.zeros((n_high, stage.n_sites, 3), self.low.dtype)
        for sites, chunk in zip(stage.sites, chunks, strict=True):
            bands[: chunk.shape[1], sites] = chunk.transpose(1, 2, 0)
        return bands

    def with_details(
        self, details: Sequence[NDArray[np.floating]], low: NDArray[np.floating]
    ) -> FrameCoefficients:
        """Return coefficients with other values, given as `details` and `low` return them."""
        chunks = []
        for stage, bands, old in zip(self.transform.levels, details, self.chunks, strict=True):
            rows = [
                np.ascontiguousarray(bands[: chunk.shape[1], sites].transpose(2, 0, 1), self.low.dtype)
                for sites, chunk in zip(stage.sites, old, strict=True)
            ]
            chunks.append(rows)
        return FrameCoefficients(np.asarray(low, self.low.dtype), chunks, self.transform)

    def without_low(self) -> FrameCoefficients:
        """Return coefficients with a zero low-pass: what rebuilds from them is the details alone."""
        return FrameCoefficients(np.zeros_like(self.low), self.chunks, self.transform)

    def scaled(self, gains: Sequence[float]) -> FrameCoefficients:
        """Return coefficients with the high bands of each level multiplied by a gain."""
        chunks = [
            [chunk * self.low.dtype.type(gain) for chunk in level]
            for gain, level in zip(gains, self.chunks, strict=True)
        ]
        return FrameCoefficients(self.low, chunks, self.transform)
