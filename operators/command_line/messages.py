# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the command line says: calm lines, warnings, progress, and errors as one sentence."""

from __future__ import annotations

import os
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
    """Print one line on stderr, if there is one that takes it."""
    with suppress(OSError, ValueError):
        print("framelet:", " ".join(sentence.split()), file=sys.stderr, flush=True)


_failures: list[str] = []


def unprinted() -> str | None:
    """Return why what was said could not be printed; None if it was, or nobody reads it any more."""
    try:
        if sys.stdout is not None:
            sys.stdout.flush()
    except (OSError, ValueError) as error:
        _note_failure(error)
        with suppress(OSError, ValueError, AttributeError):
            # Python flushes once more as it ends, and would print a traceback.
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    reason = _failures[0] if _failures else None
    _failures.clear()
    return reason


def _note_failure(error: OSError | ValueError) -> None:
    """Keep in mind why a line could not be printed; that nobody reads any more, as `head`, is no failure."""
    if not isinstance(error, BrokenPipeError):
        _failures.append(getattr(error, "strerror", None) or str(error))


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
            try:
                print(line, flush=True)
            except (OSError, ValueError) as error:  # no reason to give up the work; it is told in the end
                _note_failure(error)

    def warn(self, sentence: str) -> None:
        """Print a warning on stderr; the command goes on."""
        if not self.is_quiet:
            complain(f"warning: {sentence}")

    def show(self, what: str, fraction: float) -> None:
        """Show a percentage, if there is a terminal to show it on; 1 clears the line."""
        if self._shows_progress:
            line = f"\r{what}: {fraction:4.0%}" if fraction < 1.0 else "\r\x1b[K"
            with suppress(OSError, ValueError):
                print(line, end="", file=sys.stderr, flush=True)

    @contextmanager
    def progress(self, what: str) -> Iterator[Callable[[float, float], bool]]:
        """Give a solver callback that shows a percentage."""

        def show(fraction: float, change: float) -> bool:
            self.show(what, min(fraction, 0.99))
            return False

        try:
            yield show
        finally:
            self.show(what, 1.0)
