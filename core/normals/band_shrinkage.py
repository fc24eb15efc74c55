# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The second stage with gains: an undecimated multi-level transform of the normals, shrunk as by Wiener.

Averages A with weights from the pilot give the low-passes x_0 = n, x_1 = A x_0, x_2 = A x_1, x_3 = A^2 x_2,
x_4 = A^4 x_3, ...; the bands are x_j - x_(j+1), and all of them with the last low-pass sum up to n. A band is
multiplied by a gain for each face: signal over signal and noise, both of them local energies. The signal is
that of the pilot, as in empirical Wiener filtering; the noise is that of a field of noise of the measured
strength, which goes through the same averages, so that its strength is right for every band, every shape of
triangle and every weight.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .averages import Averages, Weights
from .pilot import Tick

WIDEST = 4
"""Averaging steps, at most, that smooth local energies."""


def average_steps(n_bands: int) -> int:
    """Return the number of averages that a transform with so many bands takes."""
    return 1 if n_bands < 2 else 2 ** (n_bands - 1)


def shrink_bands(
    noisy: NDArray[np.floating],
    noise: NDArray[np.floating],
    pilot: NDArray[np.floating],
    averages: Averages,
    weights: Weights,
    n_bands: int,
    caution: float,
    tick: Tick = lambda: None,
) -> NDArray[np.floating]:
    """Shrink the bands of a field of normals.

    Parameters
    ----------
    noisy, noise, pilot : ndarray, shape (3, F)
        Noisy unit normals; a sample of the noise in them; clean unit normals as far as they are known. Not
        modified.
    averages : Averages
        Neighbors.
    weights : Weights
        Weights of A.
    n_bands : int
        Number of bands.
    caution : float
        The noise counts this many times; larger removes more.
    tick : callable, optional
        Called after each band.

    Returns
    -------
    ndarray, shape (3, F)
        Clean vectors, not yet of length 1.

    Notes
    -----
    The gain of a band is E^2 / (E^2 + (caution N)^2) with the local energies E of the pilot and N of the
    noise. Squares make it steeper than Wiener's E / (E + N): bands of pure noise, where E is what the pilot
    left of it, come closer to 0.
    """
    rows = (row for field in (noisy, noise, pilot) for row in field)
    fields = averages.inward_rows(list(rows))
    shrunk = _Shrunk(averages, weights, fields, caution)
    for band in range(n_bands):
        before = fields
        for _ in range(1 if band == 0 else 2 ** (band - 1)):
            fields = shrunk.average(fields)
        fields = shrunk.take_band(before, fields, min(WIDEST, max(2, 2**band)))
        tick()
    return averages.outward(shrunk.finish(fields)).T


_N = 9  # columns of the three fields


class _Shrunk:
    """The sum of shrunk bands. Local energies of a band are smoothed while the next one is made.

    They are columns behind those of the fields, two for each band that waits: to average them along with the
    fields costs hardly more than the fields alone.
    """

    def __init__(
        self, averages: Averages, weights: Weights, fields: NDArray[np.floating], caution: float
    ) -> None:
        self._averages, self._weights = averages, weights
        self._caution = fields.dtype.type(caution)
        self._tiny = np.finfo(fields.dtype).tiny
        self._result = np.zeros((len(fields), 3), fields.dtype)
        self._waiting: list[_Band] = []  # those with fewer averages to come are first

    def average(self, fields: NDArray[np.floating]) -> NDArray[np.floating]:
        """Return the next fields and energies; what is smooth enough then is shrunk and added."""
        fields = self._averages.average(self._weights, fields)
        for band in self._waiting:
            band.steps -= 1
        while self._waiting and not self._waiting[0].steps:
            self._add(self._waiting.pop(0), fields)
        return fields

    def take_band(
        self, before: NDArray[np.floating], after: NDArray[np.floating], steps: int
    ) -> NDArray[np.floating]:
        """Let the band `before` - `after` wait, and return the fields and all energies that wait."""
        high = np.empty((len(after), 3), after.dtype)
        kept = [column for band in self._waiting for column in (band.column, band.column + 1)]
        fields = np.empty((len(after), _N + len(kept) + 2), after.dtype)

        def split(start: int, stop: int) -> None:
            part = fields[start:stop]
            part[:, :_N] = after[start:stop, :_N]
            for to, column in enumerate(kept, _N):
                part[:, to] = after[start:stop, column]
            band = before[start:stop, :_N] - part[:, :_N]
            high[start:stop] = band[:, :3]
            band *= band
            for to, begin in ((-2, 3), (-1, 6)):
                np.add(band[:, begin], band[:, begin + 1], out=part[:, to])
                part[:, to] += band[:, begin + 2]

        self._averages.for_items(split)
        self._waiting.append(_Band(steps, high))
        for index, waiting in enumerate(self._waiting):
            waiting.column = _N + 2 * index
        return fields

    def finish(self, fields: NDArray[np.floating]) -> NDArray[np.floating]:
        """Return the sum of all bands and of the last low-pass, shape (n, 3)."""
        low, energies = fields[:, :3], np.ascontiguousarray(fields[:, _N:])
        for band in self._waiting:
            band.column -= _N
        while self._waiting:
            energies = self.average(energies)
        self._result += low
        return self._result

    def _add(self, band: _Band, fields: NDArray[np.floating]) -> None:
        """Shrink a band by its energies, and add it."""

        def add(start: int, stop: int) -> None:
            part = slice(start, stop)
            signal = np.square(fields[part, band.column + 1])
            spoiled = fields[part, band.column] * self._caution
            spoiled *= spoiled
            spoiled += signal
            gain = np.divide(signal, spoiled, out=np.ones_like(signal), where=spoiled > self._tiny)
            for column in range(3):
                self._result[part, column] += gain * band.high[part, column]

        self._averages.for_items(add)


class _Band:
    """A band that waits for its energies: averages to come, its high-pass (n, 3), and where they are."""

    def __init__(self, steps: int, high: NDArray[np.floating]) -> None:
        self.steps, self.high, self.column = steps, high, 0
