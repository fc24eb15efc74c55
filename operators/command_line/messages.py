# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the command line says: calm lines, warnings, progress, and errors as one sentence."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

USAGE_ERROR = 2
FAILURE = 1
INTERRUPTED = 130  # as shells report it: 128 + SIGINT


class CommandError(Exception):
    """Why the command could not be carried out, in one sentence for people."""

    def __init__(self, sentence: str, exit_code: int = FAILURE) -> None:
        super().__init__(sentence)
        self.exit_code = exit_code


def complain(sentence: str) -> None:
    """Print one line on stderr."""
    print("framelet:", " ".join(sentence.split()), file=sys.stderr, flush=True)


class Messages:
    """Lines for people: what happened on stdout, warnings and progress on stderr.

    Parameters
    ----------
    is_quiet : bool
        True prints none of them.
    """

    def __init__(self, is_quiet: bool = False) -> None:
        self.is_quiet = is_quiet
        self._shows_progress = not is_quiet and sys.stderr is not None and sys.stderr.isatty()

    def say(self, line: str) -> None:
        """Print a line on stdout."""
        if not self.is_quiet:
            # A reader that has gone away, as `head` does, is no reason to give up the work.
            with suppress(BrokenPipeError):
                print(line, flush=True)

    def warn(self, sentence: str) -> None:
        """Print a warning on stderr; the command goes on."""
        if not self.is_quiet:
            complain(f"warning: {sentence}")

    @contextmanager
    def progress(self, what: str) -> Iterator[Callable[[float, float], bool]]:
        """Give a solver callback that shows a percentage, if there is a terminal to show it on."""

        def show(fraction: float, change: float) -> bool:
            if self._shows_progress:
                print(f"\r{what}: {fraction:4.0%}", end="", file=sys.stderr, flush=True)
            return False

        try:
            yield show
        finally:
            if self._shows_progress:
                print("\r\x1b[K", end="", file=sys.stderr, flush=True)
