# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Remembers what runs have prepared, so that changing a value of the last run is answered quickly.

A mesh is recognized by its arrays, value by value: after any edit it is prepared anew.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..core import PreparationCache

_cache: PreparationCache | None = None


def preparations() -> PreparationCache:
    """Return the cache that all runs in Blender share."""
    global _cache
    if _cache is None:
        from ..core import PreparationCache

        _cache = PreparationCache()
    return _cache


def forget_preparations() -> None:
    """Drop what was prepared."""
    global _cache
    _cache = None
