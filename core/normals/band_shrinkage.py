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
    noisy, noise, pilot : ndarray, shape (F, 3)
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
    ndarray, shape (F, 3)
        Clean vectors, not yet of length 1.

    Notes
    -----
    The gain of a band is E^2 / (E^2 + (caution N)^2) with the local energies E of the pilot and N of the
    noise. Squares make it steeper than Wiener's E / (E + N): bands of pure noise, where E is what the pilot
    left of it, come closer to 0.
    """
    low = averages.inward(np.concatenate((noisy, noise, pilot), axis=1))
    result = np.zeros((len(low), 3), noisy.dtype)
    tiny = np.finfo(noisy.dtype).tiny
    for band in range(n_bands):
        before = low
        for _ in range(1 if band == 0 else 2 ** (band - 1)):
            low = averages.average(weights, low)
        high = before - low
        energy = np.stack(
            (
                np.einsum("fc,fc->f", high[:, 3:6], high[:, 3:6]),
                np.einsum("fc,fc->f", high[:, 6:], high[:, 6:]),
            ),
            axis=1,
        )
        for _ in range(min(WIDEST, max(2, 2**band))):
            energy = averages.average(weights, energy)
        signal = energy[:, 1] * energy[:, 1]
        spoiled = energy[:, 0] * caution
        spoiled *= spoiled
        spoiled += signal
        gain = np.divide(signal, spoiled, out=np.ones_like(signal), where=spoiled > tiny)
        result += gain[:, None] * high[:, :3]
        tick()
    result += low[:, :3]
    return averages.outward(result)


def unit_rows(vectors: NDArray[np.floating], fallback: NDArray[np.floating]) -> NDArray[np.floating]:
    """Return vectors, shape (n, 3), scaled to length one; where there is no direction, the fallback."""
    length = np.sqrt(np.einsum("nc,nc->n", vectors, vectors))[:, None]
    good = length > np.finfo(vectors.dtype).tiny ** 0.5
    return np.where(good, vectors / np.where(good, length, 1), fallback)
