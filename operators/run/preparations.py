# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Remembers what runs have prepared, so that changing a value of the last run is answered quickly.

A mesh is recognized by its arrays, value by value: after any edit it is prepared anew.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import Lock
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ...core import PreparationCache

WAITING_STEP = 0.05
"""Seconds between two looks at whether a run that waits is still wanted."""

_cache: PreparationCache | None = None
_lock = Lock()


def preparations() -> PreparationCache:
    """Return the cache that all runs in Blender share."""
    global _cache
    if _cache is None:
        from ...core import PreparationCache

        _cache = PreparationCache()
    return _cache


@contextmanager
def borrowed_preparations(should_stop: Callable[[], bool] | None = None) -> Iterator[PreparationCache]:
    """Give the cache to one run at a time: a run writes to what was prepared, so that others have to wait.

    Parameters
    ----------
    should_stop : callable, optional
        Asked while waiting. A run that is to stop gets an empty cache at once, as it will not use it.
    """
    while not _lock.acquire(timeout=WAITING_STEP):
        if should_stop is not None and should_stop():
            from ...core import PreparationCache

            yield PreparationCache()
            return
    try:
        yield preparations()
    finally:
        _lock.release()


def forget_preparations() -> None:
    """Drop what was prepared."""
    global _cache
    _cache = None
