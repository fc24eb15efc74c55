# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The filter banks, by name."""

from __future__ import annotations

from .box_spline import BOX_SPLINE_111, BOX_SPLINE_111_CANONICAL
from .filter_bank import FilterBank

BANKS = {bank.name: bank for bank in (BOX_SPLINE_111, BOX_SPLINE_111_CANONICAL)}
"""Every named bank; the keys are the choices of the setting `frame`."""

__all__ = ["BANKS", "BOX_SPLINE_111", "BOX_SPLINE_111_CANONICAL", "FilterBank"]
