# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bands of positions, shrunk by the gains of an empirical Wiener filter.

The low-passes L_k of `smooth_positions`, with k = 1, 2, 4, ..., split positions into bands L_k - L_2k, which
sum up to the noisy positions with the last low-pass. A smooth shape leaves next to nothing in them, as L_k
keeps it up to the fifth power of what an average takes away; so what a band holds is detail and noise, which
can be told apart by their energies.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ..normals.means import padded
from .smooth_positions import RingAverages, low_pass_changes, often_averaged

NUMBERS = (1, 2, 4, 8, 16, 32, 64)
"""Numbers of averages of the low-passes."""

LEAST_AVERAGES = 2
"""Averages that smooth the energies of the finest band; of a wider one there are as many as made it."""


def shrink_positions(
    noisy: NDArray[np.floating],
    noise: NDArray[np.floating],
    pilot: NDArray[np.floating],
    directions: NDArray[np.floating],
    rings: RingAverages,
    caution: float,
) -> NDArray[np.floating]:
    """Shrink the bands of noisy positions.

    Parameters
    ----------
    noisy : ndarray, shape (3, N)
        Noisy positions; not modified.
    noise : ndarray, shape (N,)
        A sample of the noise along the normals.
    pilot : ndarray, shape (3, N)
        Clean positions as far as they are known; not modified.
    directions : ndarray, shape (3, N)
        Unit normals of the pilot.
    rings : RingAverages
        Vertices around vertices.
    caution : float
        The noise counts so many times; larger removes more.

    Returns
    -------
    ndarray, shape (3, N)

    Notes
    -----
    The gain of a band is E^2 / (E^2 + (caution N)^2), with the local energies E of the pilot's band along
    the normals and N of the sample's. Of the pilot only what is along the normals counts, since where the
    vertices are within the surface says nothing about the shape.
    """
    dtype = noisy.dtype
    given, of_pilot = padded(noisy), padded(pilot)
    given[:, 3] = noise
    normals = rings.inward(directions.T)
    inside = [rings.inward(given), rings.inward(of_pilot)]
    # One field after the other, each with all of its low-passes at once.
    changes = [[np.zeros_like(field), *low_pass_changes(field, rings, NUMBERS)] for field in inside]
    total = changes[0][-1].copy()
    steps = pairwise(zip(*changes, strict=True))
    for number, ((high, high_pilot), (low, low_pilot)) in zip(NUMBERS, steps, strict=True):
        band = high - low
        along = np.einsum("nc,nc->n", high_pilot[:, :3] - low_pilot[:, :3], normals)
        energies = np.stack((along * along, band[:, 3] * band[:, 3]), axis=1)
        energies = often_averaged(energies, rings, max(LEAST_AVERAGES, number))
        signal = np.square(np.maximum(energies[:, 0], 0))
        spoiled = signal + np.square(dtype.type(caution) * np.maximum(energies[:, 1], 0))
        gain = np.divide(signal, spoiled, out=np.ones_like(signal), where=spoiled > np.finfo(dtype).tiny)
        total[:, :3] += gain[:, None] * band[:, :3]
    return noisy + rings.outward(total)[:, :3].T
