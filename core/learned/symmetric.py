# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Symmetric 3 x 3 matrices by the six entries that differ, for all vertices at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

ENTRIES = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))
"""Rows and columns of the six entries."""

ROWS = ((0, 1, 2), (1, 3, 4), (2, 4, 5))
"""Where the entries of each row are."""


def solved(matrix: NDArray[np.float32], right: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return x of M x = b, shape (3, n), for M of shape (6, n) and b of shape (3, n), by cofactors."""
    a, b, c, d, e, f = matrix
    cofactors = (d * f - e * e, c * e - b * f, b * e - c * d, a * f - c * c, b * c - a * e, a * d - b * b)
    determinant = a * cofactors[0] + b * cofactors[1] + c * cofactors[2]
    return (
        np.stack([sum(cofactors[k] * own for k, own in zip(row, right, strict=True)) for row in ROWS])
        / determinant
    )
