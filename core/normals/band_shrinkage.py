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

from collections.abc import Callable
from functools import cache
from math import comb

import numpy as np
from numpy.typing import NDArray

from .averages import Averages, Weights
from .pilot import Tick

WIDEST = 4
"""Averaging steps, at most, that smooth local energies."""


LEFT_OUT = 0.03
"""Terms of the series of a power of A that are left out sum up to less than this."""

WIDTH = 0.92
"""Mean square of the degrees of the terms that are kept, in units of the exponent."""


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
    rows = [row for field in (noisy, noise, pilot) for row in field]
    return shrink_inside(lambda: averages.inward_rows(rows), averages, weights, n_bands, caution, tick)


_N = 9  # columns of the three fields


def shrink_inside(
    make_fields: Callable[[], NDArray[np.floating]],
    averages: Averages,
    weights: Weights,
    n_bands: int,
    caution: float,
    tick: Tick = lambda: None,
) -> NDArray[np.floating]:
    """Return what `shrink_bands` returns for its three fields, shape (n, 9), numbered as inside `averages`.

    They are handed over by a function, so that their memory is free after the first band.
    Local energies of a band are smoothed while the next one is made, as two columns behind the fields: it
    costs hardly more to average them along than the fields alone.
    """
    fields = make_fields()
    result = np.zeros((len(fields), 3), fields.dtype)
    waiting: NDArray[np.floating] | None = None  # the high band whose energies are being smoothed
    to_come = 0

    def settle(energies: NDArray[np.floating]) -> None:
        """Add the band that waits for its energies."""
        nonlocal waiting
        if waiting is not None:
            _add_shrunk(result, waiting, energies, caution, averages)
        waiting = None

    for band in range(n_bands):
        before = fields
        n_steps = 1 if band == 0 else 2 ** (band - 1)
        if n_steps > WIDEST:
            fields = _averaged_often(fields, n_steps, averages, weights, settle)
        else:
            for _ in range(n_steps):
                fields = averages.average(weights, fields)
                to_come -= 1
                if waiting is not None and not to_come:
                    settle(fields[:, _N:])
        to_come = min(WIDEST, max(2, 2**band))
        high, fields = _split(before, fields, averages)
        del before
        if band + 1 < n_bands and to_come <= 2**band:
            waiting = high
        else:
            energies = _times(1.0, fields[:, _N:], averages)
            for _ in range(to_come):
                energies = averages.average(weights, energies)
            waiting = high
            settle(energies)
            fields = _times(1.0, fields[:, :_N], averages)
        tick()
    _add_times(1.0, fields[:, :3], result, averages)
    return averages.outward(result).T


def _averaged_often(
    fields: NDArray[np.floating],
    n_steps: int,
    averages: Averages,
    weights: Weights,
    settle: Callable[[NDArray[np.floating]], None] = lambda _: None,
) -> NDArray[np.floating]:
    """Return A^n of fields, shape (n, 9), nearly, in far fewer steps.

    A is similar to a symmetric matrix with eigenvalues between -1 and 1, so that A^n is a sum of Chebyshev
    polynomials T_j(A) with coefficients that fall off like a Gaussian of width sqrt(n). What is left out
    touches only what the bands before have taken away already, and constants stay as they are. Of energies in
    columns behind the fields A^`WIDEST` is on the way, and exact: `settle` is called with it.
    """
    exact, series = _power_series(WIDEST, 0.0), _power_series(n_steps, LEFT_OUT)
    total = _times(series[0], fields[:, :_N], averages)
    energies = _times(exact[0], fields[:, _N:], averages)
    before, current = fields, averages.average(weights, fields)
    _add_times(series[1], current[:, :_N], total, averages)
    _add_times(exact[1], current[:, _N:], energies, averages)
    for degree in range(2, max(len(exact), len(series))):
        following = np.empty_like(before) if degree == 2 else before

        def add(
            start: int,
            stop: int,
            degree: int = degree,
            new: NDArray[np.floating] = following,
            energies: NDArray[np.floating] = energies,
        ) -> None:
            if degree < len(series) and series[degree]:
                total[start:stop] += total.dtype.type(series[degree]) * new[start:stop, :_N]
            if degree <= WIDEST and exact[degree]:
                energies[start:stop] += total.dtype.type(exact[degree]) * new[start:stop, _N:]

        averages.go_on(weights, current, before, following, add)
        before, current = current, following
        if degree == WIDEST:
            settle(energies)
            energies = np.empty_like(energies[:0])  # so that its memory is free
    return total


def _times(factor: float, field: NDArray[np.floating], averages: Averages) -> NDArray[np.floating]:
    """Return so many times a field."""
    result = np.empty(field.shape, field.dtype)
    times = field.dtype.type(factor)

    def kernel(start: int, stop: int) -> None:
        np.multiply(times, field[start:stop], out=result[start:stop])

    averages.for_items(kernel)
    return result


def _add_times(
    factor: float, field: NDArray[np.floating], total: NDArray[np.floating], averages: Averages
) -> None:
    """Add a field to a sum, so many times."""
    times = total.dtype.type(factor)

    def kernel(start: int, stop: int) -> None:
        total[start:stop] += times * field[start:stop]

    if factor:
        averages.for_items(kernel)


@cache
def _power_series(exponent: int, left_out: float) -> list[float]:
    """Return the Chebyshev coefficients of x^n without those at the end that sum up to less, with sum 1.

    They are the chances of a random walk of n steps to end j steps from where it began. The mean square of j
    is n, and says how much is taken off fields that hardly change from face to face, where x is nearly 1. So
    those that are kept are changed by a Gaussian until it is `WIDTH` n.
    """
    found = np.zeros(exponent + 1)
    for apart in range(exponent, -1, -2):
        found[apart] = comb(exponent, (exponent - apart) // 2) / 2.0 ** (exponent - (apart > 0))
    tails = np.cumsum(found[::-1])[::-1]
    kept = found[: max(2, int(np.count_nonzero(tails > left_out)))]
    squares = np.arange(len(kept)) ** 2.0
    wanted = exponent * (WIDTH if len(kept) <= exponent else 1.0)
    low, high = -1.0 / exponent, 1.0 / exponent
    for _ in range(60):
        middle = 0.5 * (low + high)
        tilted = kept * np.exp(middle * squares)
        tilted /= tilted.sum()
        low, high = (middle, high) if tilted @ squares < wanted else (low, middle)
    return tilted.tolist()


def _split(
    before: NDArray[np.floating], after: NDArray[np.floating], averages: Averages
) -> tuple[NDArray[np.floating], NDArray[np.floating]]:
    """Return the band `before` - `after` of the first field, and `after` with the energies of the others."""
    high = np.empty((len(after), 3), after.dtype)
    fields = np.empty((len(after), _N + 2), after.dtype)

    def kernel(start: int, stop: int) -> None:
        part = fields[start:stop]
        part[:, :_N] = after[start:stop, :_N]
        band = before[start:stop, :_N] - part[:, :_N]
        high[start:stop] = band[:, :3]
        band *= band
        for to, begin in ((_N, 3), (_N + 1, 6)):
            np.add(band[:, begin], band[:, begin + 1], out=part[:, to])
            part[:, to] += band[:, begin + 2]

    averages.for_items(kernel)
    return high, fields


def _add_shrunk(
    result: NDArray[np.floating],
    high: NDArray[np.floating],
    energies: NDArray[np.floating],
    caution: float,
    averages: Averages,
) -> None:
    """Shrink a band by energies of the noise and of the pilot, and add it."""
    factor, tiny = high.dtype.type(caution), np.finfo(high.dtype).tiny

    def kernel(start: int, stop: int) -> None:
        part = slice(start, stop)
        signal = np.square(energies[part, 1])
        spoiled = energies[part, 0] * factor
        spoiled *= spoiled
        spoiled += signal
        gain = np.divide(signal, spoiled, out=np.ones_like(signal), where=spoiled > tiny)
        for column in range(3):
            result[part, column] += gain * high[part, column]

    averages.for_items(kernel)
