# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The filter banks, by name."""

from __future__ import annotations

from importlib import import_module

from ..settings.frame_catalog import FRAME_CATALOG
from .b_spline import b_spline
from .filter_bank import FilterBank

BANKS: dict[str, FilterBank] = {
    entry.identifier: getattr(import_module(f".{entry.module}", __name__), entry.identifier)
    for entry in FRAME_CATALOG
    if entry.module
}
"""Every bank of the catalog."""

__all__ = ["BANKS", "FilterBank", "b_spline"]
