# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A lock on a report, which one run at a time may write: it ends with its process, however that ends."""

from __future__ import annotations

import contextlib
import json
import os
import socket
import sys
import time
from pathlib import Path
from types import TracebackType
from typing import Any

from .inputs import PlanError, ReportError


class ReportLock:
    """The lock; a context manager. The system holds it for the process, so that none is ever left behind.

    The file says who has it, since when: that is for people, and the file stays.

    Parameters
    ----------
    path : Path
        The report; the lock is beside it.

    Raises
    ------
    PlanError
        If another run has it.
    ReportError
        If it cannot be written.
    """

    def __init__(self, path: Path) -> None:
        self._report, self.path = path, path.with_name(path.name + ".lock")
        self._file: Any = None

    def __enter__(self) -> ReportLock:
        try:
            self._file = self.path.open("a+", encoding="utf-8")
        except OSError as error:
            raise ReportError(self.path, error) from error
        try:
            _lock(self._file)
        except OSError as error:
            self._file.close()
            raise PlanError(
                f"{self._report} is being written by {_owner(self.path)}; wait for it."
            ) from error
        self._file.truncate(0)
        json.dump({"host": socket.gethostname(), "pid": os.getpid(), "since": time.time()}, self._file)
        self._file.flush()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        # Removed, it could be locked by one who has it open and made anew by another.
        with contextlib.suppress(OSError):
            self._file.truncate(0)
        self._file.close()


def _lock(file: Any) -> None:
    """Lock a file for this process, or raise OSError at once."""
    if sys.platform == "win32":
        import msvcrt

        file.seek(2**30)  # beyond what is written, or others could not read it
        msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
    else:
        import fcntl

        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)


def _owner(path: Path) -> str:
    """Say who has a lock, and for how long."""
    try:
        owner = json.loads(path.read_text("utf-8"))
        age = max(0.0, time.time() - owner["since"])
        return f"process {owner['pid']} on {owner['host']}, since {age:,.0f} s"
    except (OSError, ValueError, RecursionError, KeyError, TypeError):
        return "another run"
