# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is said while a batch goes on: a bar on a terminal, or else a line a file."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from types import TracebackType
from typing import Any

from ..batch.progress import TimeLeft
from ..batch.rows import DONE
from .messages import Messages, complain


class BatchProgress:
    """A context manager that says what came of each file.

    On a terminal, where tqdm is installed, a bar shows how far the batch is and the time left, and only files
    that failed get a line.

    Parameters
    ----------
    total : int
        How many files there are.
    messages : Messages
        Print the lines.
    is_verbose : bool
        Whether each file gets lines in any case, with times and warnings.
    """

    def __init__(self, total: int, messages: Messages, is_verbose: bool = False) -> None:
        self._messages, self._is_verbose = messages, is_verbose
        self._left, self._bar = TimeLeft(total), _bar(total, messages)
        self._n_failed = 0

    def say(self, row: dict[str, Any]) -> None:
        """Say what came of a file."""
        where = self._left.one_more()
        with self._above_the_bar():
            if row["status"] != DONE:
                named = "" if row["input"] in row["error"] else f"{row['input']}: "
                complain(f"{where}: {named}{row['error']}")
            elif self._bar is None or self._is_verbose:
                self._say_done(row, where)
        if self._bar is not None:
            self._n_failed += row["status"] != DONE
            if self._n_failed:
                self._bar.set_postfix_str(f"{self._n_failed:,} failed", refresh=False)
            self._bar.update()

    def _say_done(self, row: dict[str, Any], where: str) -> None:
        seconds = sum(row["seconds"].values())
        self._messages.say(
            f"{where}: {row['output']} in {seconds:.2f} s, {row['n_vertices']:,} vertices, moved by "
            f"{row['displacement_max_edges']:.2g} edges at most, {row['folded_faces']:,} folded faces."
        )
        if self._is_verbose:
            stages = ", ".join(f"{name} {value:.2f} s" for name, value in row["seconds"].items())
            self._messages.say(f"  {stages}")
            for sentence in row["warnings"]:
                self._messages.warn(sentence)

    @contextmanager
    def _above_the_bar(self) -> Iterator[None]:
        """Take the bar away for a while, so that lines stay lines."""
        with nullcontext() if self._bar is None else self._bar.external_write_mode(sys.stderr):
            yield

    def __enter__(self) -> BatchProgress:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._bar is not None:
            self._bar.close()


def _bar(total: int, messages: Messages) -> Any:
    """Return a bar, or None where there is no terminal, or no tqdm."""
    if messages.is_quiet or sys.stderr is None or not sys.stderr.isatty():
        return None
    try:
        from tqdm import tqdm
    except ImportError:
        return None
    return tqdm(total=total, unit="file", file=sys.stderr, dynamic_ncols=True)
