# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tight frames of the linear box spline with directions (1, 0), (0, 1), (1, 1) on triangle lattices.

Taps, clockwise (Fig. 1): slot 0 is the vertex; slots 1-6 its one-ring; opposite pairs (1, 4), (2, 5), (3, 6).
"""

from __future__ import annotations

from math import sqrt

from .filter_bank import FilterBank

TAPS_7 = ((0, 0), (-1, -1), (-1, 0), (0, 1), (1, 1), (1, 0), (0, -1))

_S2 = sqrt(2.0)
_S3 = 2.0 * sqrt(3.0) / 3.0
_S6 = sqrt(6.0) / 3.0
_SHARED = (
    (2, 1, 1, 1, 1, 1, 1),
    (2, -1, -1, 1, -1, -1, 1),
    (2, 1, -1, -1, 1, -1, -1),
    (2, -1, 1, -1, -1, 1, -1),
)


def _eighths(*rows: tuple[float, ...]) -> list[list[float]]:
    return [[value / 8.0 for value in row] for row in rows]


BOX_SPLINE_111 = FilterBank(
    "BOX_SPLINE_111",
    "TRIANGLES",
    TAPS_7,
    _eighths(
        *_SHARED,
        (0, -_S3, -_S3, -_S3, _S3, _S3, _S3),
        (0, _S6, _S6, -2 * _S6, -_S6, -_S6, 2 * _S6),
        (0, _S2, -_S2, 0, -_S2, _S2, 0),
    ),
)
"""Example 2.2, mask-matrix (3.5): six high-pass masks."""

BOX_SPLINE_111_CANONICAL = FilterBank(
    "BOX_SPLINE_111_CANONICAL",
    "TRIANGLES",
    TAPS_7,
    _eighths(
        *_SHARED,
        (0, 1, -1, 1, -1, 1, -1),
        (0, -1, -1, -1, 1, 1, 1),
        (0, -1, 1, 1, 1, -1, -1),
        (0, 1, 1, -1, -1, -1, 1),
    ),
)
"""Example 3.1, mask-matrix (3.8): the canonical choice of seven high-pass masks."""
