# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How many threads run where none are asked for: one, unless the program knows how many processors it has."""

from __future__ import annotations

_default = 1


def set_default_threads(number: int) -> None:
    """Set how many threads run by default, at least 1. The package itself does so when it is imported."""
    global _default
    _default = max(number, 1)


def default_threads() -> int:
    """Return how many threads run by default."""
    return _default
