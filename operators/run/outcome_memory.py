# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Remembers what the last jobs came to: what is written of it, and how much, can change at once.

A job is recognized by all that its outcome depends on, value by value.
"""

from __future__ import annotations

from dataclasses import fields, is_dataclass
from threading import Lock
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .denoise_job import DenoiseJob, DenoiseOutcome

MOST_BYTES = 250_000_000
"""What positions of outcomes may take together; the oldest are forgotten first."""

COMPARED = ("settings", "movable", "linear", "region", "surface")
"""The fields of a job on which its outcome depends, those that are compared quickly first."""

_kept: list[tuple[DenoiseJob, DenoiseOutcome]] = []
_lock = Lock()


def keep_outcome(job: DenoiseJob, outcome: DenoiseOutcome) -> None:
    """Keep what a job came to, unless it was stopped."""
    if outcome.measured.report.is_stopped:
        return
    with _lock:
        _kept[:] = [pair for pair in _kept if pair[1] is not outcome]
        _kept.append((job, outcome))
        while len(_kept) > 1 and sum(2 * kept.vertices.nbytes for _, kept in _kept) > MOST_BYTES:
            _kept.pop(0)


def known_outcome(job: DenoiseJob) -> DenoiseOutcome | None:
    """Return what the same job came to before; None if that is not known."""
    with _lock:
        for other, outcome in reversed(_kept):
            if all(_is_same(getattr(job, name), getattr(other, name)) for name in COMPARED):
                return outcome
    return None


def forget_outcomes() -> None:
    """Forget all."""
    with _lock:
        _kept.clear()


def _is_same(first: Any, second: Any) -> bool:
    """Tell whether two values are equal, arrays and what holds arrays value by value."""
    import numpy as np

    if first is second:
        return True
    if type(first) is not type(second):
        return False
    if isinstance(first, np.ndarray):
        return np.array_equal(first, second)
    if is_dataclass(first):
        return all(_is_same(getattr(first, each.name), getattr(second, each.name)) for each in fields(first))
    return bool(first == second)
