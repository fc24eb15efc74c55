# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Signals that end a run: turned into exceptions, or put off while files are moved."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType
from typing import Any


class Interrupted(KeyboardInterrupt):
    """A signal that came while files were moved into place; `published` are those that were.

    The moves are finished first, so that files that belong together fit together.
    """

    def __init__(self, published: list[Path], exit_code: int) -> None:
        super().__init__()
        self.published = published
        self.exit_code = exit_code


class Terminated(KeyboardInterrupt):
    """The signal SIGTERM, or SIGHUP, which ends a run as Ctrl-C does."""

    def __init__(self, number: int) -> None:
        super().__init__()
        self.exit_code = 128 + number


@contextmanager
def signals_as_interrupts() -> Iterator[None]:
    """Let SIGTERM and SIGHUP raise `Terminated`, so that a run ends as by Ctrl-C, and cleans up."""

    def end(number: int, _frame: FrameType | None) -> None:
        raise Terminated(number)

    with _handlers(end, ("SIGTERM", "SIGHUP")):
        yield


@contextmanager
def deferred_signals() -> Iterator[list[int]]:
    """Note signals that would end the run instead of acting on them, for a short while."""
    noted: list[int] = []
    with _handlers(lambda number, _frame: noted.append(number), ("SIGINT", "SIGTERM", "SIGHUP")):
        yield noted


@contextmanager
def _handlers(handler: Any, names: tuple[str, ...]) -> Iterator[None]:
    """Handle signals for a while; only the main thread can."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = {}
    for name in names:
        number = getattr(signal, name, None)
        # What a parent told us to ignore, as nohup does, goes on being ignored.
        if number is not None and signal.getsignal(number) not in (signal.SIG_IGN, None):
            before[number] = signal.signal(number, handler)
    try:
        yield
    finally:
        for number, old in before.items():
            signal.signal(number, old)
