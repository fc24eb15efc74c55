# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Work on a thread of its own that says how far it is and can be asked to stop. Knows no Blender."""

from __future__ import annotations

from collections.abc import Callable
from threading import Event, Thread
from typing import Generic, TypeVar

Result = TypeVar("Result")


class Worker(Generic[Result]):
    """One piece of work; it is started once and may be asked for its result once it is done.

    Parameters
    ----------
    work : callable
        `work(worker)` runs on the thread. It should ask `worker.should_stop()` often, and call
        `worker.advance` as it goes on. It must not touch Blender.
    """

    def __init__(self, work: Callable[[Worker[Result]], Result]) -> None:
        self.fraction = 0.0
        self._work = work
        self._stop, self._done = Event(), Event()
        self._result: Result | None = None
        self._error: BaseException | None = None
        self._thread = Thread(target=self._run, name="framelet run")

    def start(self) -> None:
        """Begin, and return at once."""
        self._thread.start()

    def run_here(self) -> None:
        """Do the work on the calling thread instead."""
        self._run()

    def stop(self) -> None:
        """Ask the work to stop, and return at once."""
        self._stop.set()

    def should_stop(self) -> bool:
        """Tell the work whether it was asked to stop."""
        return self._stop.is_set()

    def advance(self, fraction: float, _change: float = 0.0) -> bool:
        """Note the share of the work that is done, from 0 to 1; a `core` callback."""
        self.fraction = fraction
        return self._stop.is_set()

    @property
    def is_done(self) -> bool:
        """Whether the work has ended, in whatever way."""
        return self._done.is_set()

    def wait(self, seconds: float | None = None) -> bool:
        """Wait until the work has ended, at most so long; return whether it has."""
        return self._done.wait(seconds)

    def result(self) -> Result:
        """Return what the work gave; raises what it raised. Only once it is done."""
        if not self.is_done:
            raise RuntimeError("The work is not done yet.")
        if self._error is not None:
            raise self._error
        return self._result  # type: ignore[return-value]

    def _run(self) -> None:
        try:
            self._result = self._work(self)
        except BaseException as error:
            # Kept for the thread that asks for the result: nobody sees what a thread raises.
            self._error = error
        finally:
            self._done.set()
