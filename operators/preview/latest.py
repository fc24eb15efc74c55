# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A thread that answers the latest of many requests and skips those before it. Knows no Blender."""

from __future__ import annotations

from collections.abc import Callable
from threading import Condition, Thread
from time import monotonic
from typing import Generic, NamedTuple, TypeVar

Request = TypeVar("Request")
Result = TypeVar("Result")

PATIENCE = 0.5
"""Seconds that a computation may take although a newer request waits. One that is quicker is finished and
shown, as otherwise nothing would be shown while a slider moves; one that is slower is stopped."""


class Answer(NamedTuple, Generic[Request, Result]):
    """What came of a request: a result or an error."""

    request: Request
    result: Result | None
    error: Exception | None


class Latest(Generic[Request, Result]):
    """Computes one request at a time; of those that come meanwhile only the last one is kept.

    Parameters
    ----------
    compute : callable
        `compute(request, should_stop, show)` runs on the thread; it should ask `should_stop()` often, and
        what it returns once that was True is dropped. `show(result)` gives an answer before the last one. It
        must not touch Blender.
    """

    def __init__(
        self, compute: Callable[[Request, Callable[[], bool], Callable[[Result], None]], Result]
    ) -> None:
        self._compute = compute
        self._changed = Condition()
        self._waiting: list[Request] = []  # one at most
        self._answers: list[Answer[Request, Result]] = []  # one at most
        self._began: float | None = None
        self._is_closed = False
        self._thread = Thread(target=self._serve, name="framelet preview")
        self._thread.start()

    def request(self, request: Request) -> None:
        """Ask for an answer, in the place of any that has not begun yet."""
        with self._changed:
            self._waiting = [request]
            self._changed.notify_all()

    def take(self) -> Answer[Request, Result] | None:
        """Return the newest answer, once; None if there is no new one."""
        with self._changed:
            return self._answers.pop() if self._answers else None

    @property
    def is_busy(self) -> bool:
        """Whether an answer is still to come."""
        with self._changed:
            return bool(self._waiting) or self._began is not None

    def wait(self, seconds: float) -> bool:
        """Wait until no answer is to come, at most so long; return whether that is so."""
        with self._changed:
            return self._changed.wait_for(lambda: not self._waiting and self._began is None, seconds)

    def close(self) -> None:
        """Drop all requests; the thread ends as soon as its computation has stopped."""
        with self._changed:
            self._is_closed = True
            self._waiting.clear()
            self._changed.notify_all()

    @property
    def has_ended(self) -> bool:
        """Whether the thread has ended."""
        return not self._thread.is_alive()

    def join(self) -> None:
        """Wait until the thread has ended; after `close`."""
        self._thread.join()

    def _should_stop(self) -> bool:
        """Tell a computation that it is not wanted any more."""
        began = self._began
        is_late = began is not None and monotonic() - began > PATIENCE
        return self._is_closed or (bool(self._waiting) and is_late)

    def _serve(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._waiting or self._is_closed)
                if self._is_closed:
                    return
                request = self._waiting.pop()
                self._began = monotonic()
            is_stopped = False

            def should_stop() -> bool:
                nonlocal is_stopped
                is_stopped = is_stopped or self._should_stop()
                return is_stopped

            def show(result: Result, request: Request = request) -> None:
                if not should_stop():
                    with self._changed:
                        self._answers = [Answer(request, result, None)]

            result, error = None, None
            try:
                result = self._compute(request, should_stop, show)
            except Exception as failure:
                error = failure
            with self._changed:
                self._began = None
                if not is_stopped:
                    self._answers = [Answer(request, result, error)]
                self._changed.notify_all()
