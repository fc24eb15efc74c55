# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The tight frame of the box spline with directions (1, 0), (0, 1), (1, 1), (1, -1), Example 3.2.

Its masks are cell-centered, on 4x4 places without the corners; they serve quads and pairs of triangles.
"""

from __future__ import annotations

from math import sqrt

import numpy as np

from .filter_bank import CELL_CORNERS, FilterBank

# Each line is a mask on the 4x4 places, rows -1 to 2, without its four corners: 2 + 4 + 4 + 2 numbers.
_SIXTEENTHS = """
 1  1   1  2  2  1   1  2  2  1   1  1
 1 -1   1 -2  2 -1  -1  2 -2  1  -1  1
-1 -1  -1  2  2 -1  -1  2  2 -1  -1 -1
-1  1  -1 -2  2  1   1  2 -2 -1   1 -1
-1 -1  -1 -2 -2 -1   1  2  2  1   1  1
-1  1  -1  2 -2  1  -1  2 -2  1  -1  1
 1  1   1 -2 -2  1  -1  2  2 -1  -1 -1
 1 -1   1  2 -2 -1   1  2 -2 -1   1 -1
"""
_SQRT_2_SIXTEENTHS = """
 1 -1  -1  0  0  1   1  0  0 -1  -1  1
-1 -1   1  0  0  1   1  0  0  1  -1 -1
 1 -1  -1  0  0  1  -1  0  0  1   1 -1
-1 -1   1  0  0  1  -1  0  0 -1   1  1
"""
_PLACES = [
    (row, column)
    for row in range(-1, 3)
    for column in range(-1, 3)
    if {row, column} not in ({-1}, {2}, {-1, 2})
]


def _table(text: str) -> np.ndarray:
    return np.array([line.split() for line in text.strip().splitlines()], float)


def _make() -> FilterBank:
    masks = np.concatenate((_table(_SIXTEENTHS) / 16.0, _table(_SQRT_2_SIXTEENTHS) * (sqrt(2.0) / 16.0)))
    taps = [*CELL_CORNERS, *(place for place in _PLACES if place not in CELL_CORNERS)]
    order = [_PLACES.index(place) for place in taps]
    return FilterBank("BOX_SPLINE_FOUR_DIRECTION", "ANY", taps, masks[:, order])


BOX_SPLINE_FOUR_DIRECTION = _make()
"""Example 3.2: eleven high-pass masks."""
