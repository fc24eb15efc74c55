# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How far a batch is, and how long it will take."""

from __future__ import annotations

import time
from collections.abc import Callable


class TimeLeft:
    """The time that is left, by the files that were done so far.

    Parameters
    ----------
    total : int
        How many files there are.
    clock : callable
        Returns seconds.

    Examples
    --------
    >>> seconds = iter([0.0, 30.0])
    >>> left = TimeLeft(4, clock=lambda: next(seconds))
    >>> left.one_more()
    '[1/4], 2 min left'
    """

    def __init__(self, total: int, clock: Callable[[], float] = time.monotonic) -> None:
        self._total, self._clock = total, clock
        self._done, self._began = 0, clock()

    def one_more(self) -> str:
        """Count a file, and say where the batch is."""
        self._done += 1
        left = (self._clock() - self._began) / self._done * (self._total - self._done)
        return f"[{self._done}/{self._total}]" + (
            f", {duration(left)} left" if self._done < self._total else ""
        )


def duration(seconds: float) -> str:
    """Return a time for people.

    Examples
    --------
    >>> [duration(seconds) for seconds in (0.4, 89, 90, 9000)]
    ['1 s', '89 s', '2 min', '2.5 h']
    """
    if seconds < 90:
        return f"{max(1, round(seconds))} s"
    return f"{round(seconds / 60)} min" if seconds < 5400 else f"{seconds / 3600:.1f} h"
