# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tight frames of the bilinear spline on quad lattices.

Taps, clockwise from the left (Fig. 7): slot 0 is the vertex, odd slots are edge neighbors, even slots the far
corners of the four quads.
"""

from __future__ import annotations

from math import sqrt

import numpy as np

from .filter_bank import FilterBank

TAPS_9 = ((0, 0), (0, -1), (-1, -1), (-1, 0), (-1, 1), (0, 1), (1, 1), (1, 0), (1, -1))

_R = sqrt(2.0)
_ROWS = np.array(
    [
        (4, 2, 1, 2, 1, 2, 1, 2, 1),
        (0, 2 * _R, _R, 0, -_R, -2 * _R, -_R, 0, _R),
        (0, 0, -_R, -2 * _R, -_R, 0, _R, 2 * _R, _R),
        (4, -2, -1, 2, -1, -2, -1, 2, -1),
        (0, 0, -2, 0, 2, 0, -2, 0, 2),
        (4, 2, -1, -2, -1, 2, -1, -2, -1),
        (0, 0, _R, -2 * _R, _R, 0, -_R, 2 * _R, -_R),
        (0, 2 * _R, -_R, 0, _R, -2 * _R, _R, 0, -_R),
        (4, -2, 1, -2, 1, -2, 1, -2, 1),
    ]
)

LINEAR_SPLINE = FilterBank("LINEAR_SPLINE", "QUADS", TAPS_9, _ROWS / 16.0)
"""Example 2.1, mask-matrix (5.1): eight high-pass masks."""

LINEAR_SPLINE_REDUCED = FilterBank(
    "LINEAR_SPLINE_REDUCED",
    "QUADS",
    TAPS_9,
    np.array(
        [
            _ROWS[0],
            _ROWS[1],
            (0, 0, -2 * _R, 0, -2 * _R, 0, 2 * _R, 0, 2 * _R),
            _ROWS[3],
            (0, 0, -2 * _R, 0, 2 * _R, 0, -2 * _R, 0, 2 * _R),
            (8, 0, 0, -4, 0, 0, 0, -4, 0),
        ]
    )
    / 16.0,
)
"""(5.3), (5.4): five high-pass masks. Only (2.6) holds, which suffices without decimation."""
