# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How many threads run where none are asked for.

This is the one number that the mathematics takes from its surroundings. What Python says is not always what
there is: a container may get less. Programs that know it say so by `use_processors`.
"""

from __future__ import annotations

import os

_told = 0


def use_processors(number: int) -> None:
    """Set how many threads run by default; 0 for as many as Python says there are."""
    global _told
    _told = number


def available_cores() -> int:
    """Return how many threads run by default."""
    if _told:
        return _told
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
