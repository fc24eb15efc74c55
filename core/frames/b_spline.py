# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tensor-product tight frames of B-splines on quad lattices: (5.14), (5.15)."""

from __future__ import annotations

from functools import cache
from math import comb, sqrt

import numpy as np

from ..errors import FrameError
from .filter_bank import CELL_CORNERS, FilterBank
from .linear_spline import TAPS_9

HIGHEST_ORDER = 6


@cache
def b_spline(order: int) -> FilterBank:
    """Make the frame of the tensor-product B-spline of an order.

    Parameters
    ----------
    order : int
        1 to 6. Masks have order + 1 taps a side; an even order is vertex-centered, an odd one cell-centered.
        Order 1 is Haar, order 2 `LINEAR_SPLINE` up to signs.

    Returns
    -------
    FilterBank
        Named ``B_SPLINE_<order>``, with (order + 1)^2 bands.

    Raises
    ------
    FrameError
        If the order is not 1 to 6.
    """
    if order not in range(1, HIGHEST_ORDER + 1):
        raise FrameError(f"The B-spline order is {order!r}; it must be 1 to {HIGHEST_ORDER}.")
    filters = np.array([_filter(order, n) for n in range(order + 1)])
    first = -(order // 2)
    places = [(first + row, first + column) for row in range(order + 1) for column in range(order + 1)]
    masks = np.array([np.outer(rows, columns).ravel() for rows in filters for columns in filters])
    central = CELL_CORNERS if order % 2 else TAPS_9
    taps = [*central, *(place for place in places if place not in central)]
    lattice = "ANY" if order % 2 else "QUADS"
    return FilterBank(f"B_SPLINE_{order}", lattice, taps, masks[:, [places.index(tap) for tap in taps]])


def _filter(order: int, n: int) -> np.ndarray:
    """Return the univariate filter sqrt(C(p, n)) 2^-p (1, -1)^n * (1, 1)^(p - n), * being convolution."""
    taps = np.ones(1)
    for step in range(order):
        taps = np.convolve(taps, (1.0, -1.0) if step < n else (1.0, 1.0))
    return sqrt(comb(order, n)) / 2.0**order * taps


B_SPLINE_1, B_SPLINE_2, B_SPLINE_3, B_SPLINE_4, B_SPLINE_5, B_SPLINE_6 = (
    b_spline(order) for order in range(1, HIGHEST_ORDER + 1)
)
