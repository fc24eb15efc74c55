# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The tight wavelet frame transform of a surface: analysis (3.6) and reconstruction (4.8)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .blocks import Blocks
from .frames import FilterBank
from .frames.mask_product import MaskProduct
from .stencils import Stencil


def analyze(
    vertices: NDArray[np.floating], stencil: Stencil, bank: FilterBank, blocks: Blocks | None = None
) -> NDArray[np.floating]:
    """Decompose a surface into the coefficients of one level, alpha = M C(S).

    Parameters
    ----------
    vertices : ndarray, shape (N, 3), float32 or float64
        Positions, in any unit; not modified.
    stencil : Stencil
        Points under the masks.
    bank : FilterBank
        The masks.
    blocks : Blocks, optional
        Threads to work on.

    Returns
    -------
    ndarray, shape (B, N, 3), dtype of `vertices`
        Band 0 is the low-pass, a smoother surface; the others are the details.

    Raises
    ------
    ValueError
        If stencil and bank have different numbers of taps, or the positions do not fit the stencil.
    """
    if stencil.n_taps != bank.n_taps:
        raise ValueError(f"The stencil has {stencil.n_taps} taps, but {bank.name} has {bank.n_taps}.")
    if vertices.shape != (stencil.n_vertices, 3):
        raise ValueError(f"The positions have shape {vertices.shape}; expected {(stencil.n_vertices, 3)}.")
    blocks = blocks or Blocks(1)
    points = stencil.extended(vertices, blocks)
    product = MaskProduct(bank.masks, points.dtype)
    coefficients = np.empty((bank.n_bands, stencil.n_vertices, 3), points.dtype)

    def kernel(start: int, stop: int) -> None:
        coefficients[:, start:stop] = product(stencil.gather(points, start, stop)).transpose(1, 2, 0)

    blocks.run(kernel, stencil.n_vertices)
    return coefficients


def reconstruct(coefficients: NDArray[np.floating], bank: FilterBank) -> NDArray[np.floating]:
    """Rebuild the surface from its coefficients by the row v; perfect on every mesh and stencil.

    Parameters
    ----------
    coefficients : ndarray, shape (B, N, 3)
        As `analyze` returns them.
    bank : FilterBank
        The masks that made them.

    Returns
    -------
    ndarray, shape (N, 3)
        Positions.

    Raises
    ------
    ValueError
        If the number of bands is not the bank's.
    """
    if len(coefficients) != bank.n_bands:
        raise ValueError(f"There are {len(coefficients)} bands, but {bank.name} has {bank.n_bands}.")
    row = bank.reconstruction[0].astype(coefficients.dtype)
    return np.einsum("b,bnc->nc", row, coefficients)
