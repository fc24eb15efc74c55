# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The filter banks, by name."""

from __future__ import annotations

from .b_spline import HIGHEST_ORDER, b_spline
from .box_spline import BOX_SPLINE_111, BOX_SPLINE_111_CANONICAL
from .filter_bank import FilterBank
from .four_direction import BOX_SPLINE_FOUR_DIRECTION
from .linear_spline import LINEAR_SPLINE, LINEAR_SPLINE_REDUCED

BANKS = {
    bank.name: bank
    for bank in (
        BOX_SPLINE_111,
        BOX_SPLINE_111_CANONICAL,
        BOX_SPLINE_FOUR_DIRECTION,
        LINEAR_SPLINE,
        LINEAR_SPLINE_REDUCED,
        *(b_spline(order) for order in range(1, HIGHEST_ORDER + 1)),
    )
}
"""Every named bank; a bank that is entered here becomes a choice of the setting `frame`."""

__all__ = [
    "BANKS",
    "BOX_SPLINE_111",
    "BOX_SPLINE_111_CANONICAL",
    "BOX_SPLINE_FOUR_DIRECTION",
    "LINEAR_SPLINE",
    "LINEAR_SPLINE_REDUCED",
    "FilterBank",
    "b_spline",
]
