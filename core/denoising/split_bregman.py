# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Split Bregman on vertex positions: the paper's algorithms (4.10), (4.12), (5.10), (5.11)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..frames import BANKS
from ..frames.mask_product import MaskProduct
from ..settings import DenoiseSettings
from ..stencils import Stencil
from .constraints import Constraints
from .report import Callback
from .shrinkage import SEPARABLE, clipped


def split_bregman(
    noisy: NDArray[np.floating],
    stencil: Stencil,
    settings: DenoiseSettings,
    constraints: Constraints,
    blocks: Blocks,
    callback: Callback | None = None,
) -> tuple[NDArray[np.floating], int, bool]:
    """Minimize 1/2 |S - S~|^2 + lambda |W S|_1 (4.1), with the row v in place of the adjoint.

    Parameters
    ----------
    noisy : ndarray, shape (3, N)
        Noisy positions S~ in mean edge lengths, coordinates in rows; not modified.
    stencil : Stencil
        Frozen stencils, chosen on the noisy surface.
    settings : DenoiseSettings
        Frame, shrinkage, lambda, mu, delta, iterations, tolerance.
    constraints : Constraints
        Vertices that may not move freely.
    blocks : Blocks
        Threads to work on.
    callback : callable, optional
        See `report.Callback`.

    Returns
    -------
    points : ndarray, shape (3, N)
        Denoised positions, in the dtype of `noisy`.
    iterations : int
        Iterations that ran.
    is_stopped : bool
        True if the callback stopped the run.

    Notes
    -----
    One iteration of (4.10) is::

        S <- (S~ - c + mu v (d - b)) / (1 + mu)
        d <- T(W S + b),  b <- b + W S - d,  c <- c + delta (S - S~)

    With y = W S + b it holds that d - b = 2 d - y = y - 2 b for the new b, so that only b and S are kept. The
    low-pass is not shrunk, so its b stays zero. From the start S = S~, d = W S~, b = c = 0 the first S is S~
    itself, which is not computed.
    """
    bank = BANKS[settings.frame]
    dtype = noisy.dtype.type
    bands = bank.used_bands if settings.shrinkage in SEPARABLE else np.arange(bank.n_bands)
    product = MaskProduct(bank.masks[bands], dtype)
    row = bank.reconstruction[0, bands].astype(dtype)
    threshold = settings.lambda_ / settings.mu
    mu, delta, damping = dtype(settings.mu), dtype(settings.delta), dtype(1.0 / (1.0 + settings.mu))
    n = stencil.n_vertices

    current = np.empty((3, stencil.n_points), dtype)
    following = np.empty_like(current)
    current[:, :n] = noisy
    residual = np.zeros((3, len(bands) - 1, n), dtype)  # b of the high bands
    drift = np.zeros_like(noisy) if settings.delta > 0 else None  # c

    def kernel(start: int, stop: int) -> float:
        part = slice(start, stop)
        shrunk = product(stencil.gather(current, start, stop))  # W S, becomes y - 2 b
        high = shrunk[:, 1:]
        high += residual[:, :, part]
        cut = clipped(high, threshold, settings.shrinkage)
        residual[:, :, part] = cut
        cut += cut
        high -= cut
        moved = _weighted_sum(shrunk, row)
        moved *= mu
        moved += noisy[:, part]
        if drift is not None:
            drift[:, part] += delta * (current[:, part] - noisy[:, part])
            moved -= drift[:, part]
        moved *= damping
        following[:, part] = moved
        moved -= current[:, part]
        return float(np.einsum("cn,cn->", moved, moved, dtype=np.float64))

    for iteration in range(2, settings.iterations + 1):
        stencil.fill_virtual(current, blocks)
        squares = blocks.run(kernel, n)
        constraints.apply(following[:, :n], noisy)
        current, following = following, current
        change = float(np.sqrt(sum(squares) / max(n, 1)))
        if callback is not None and callback((iteration - 1) / (settings.iterations - 1), change):
            return current[:, :n], iteration, True
        if change < settings.tolerance:
            return current[:, :n], iteration, False
    return current[:, :n], settings.iterations, False


def _weighted_sum(bands: NDArray[np.floating], row: NDArray[np.floating]) -> NDArray[np.floating]:
    """Return v . alpha, shape (3, n), of coefficients (3, B, n), passing over zero entries of v."""
    total = bands[:, 0] * row[0]
    for band in np.flatnonzero(row[1:]) + 1:
        total += bands[:, band] if row[band] == 1 else row[band] * bands[:, band]
    return total
