# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The report of a batch: one JSON object a line, appended as each file ends, and read again."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable
from pathlib import Path
from types import TracebackType
from typing import Any

from ..files.safe_write import sync_folder
from .inputs import PlanError, ReportError
from .task import Task, hash_of

DONE, FAILED = "done", "failed"
_BINARY = getattr(os, "O_BINARY", 0)  # Windows


class RowFile:
    """A report that is written to; a context manager. Each row is on the disk before the next file begins.

    Parameters
    ----------
    path : Path
        The file; it is made if it is not there, and what is in it stays.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        try:
            self._number = os.open(path, os.O_RDWR | os.O_CREAT | os.O_APPEND | _BINARY, 0o666)
        except OSError as error:
            raise ReportError(path, error) from error
        self._mend()
        sync_folder(path.parent)

    def _mend(self) -> None:
        """End a line that a run left unfinished when it was killed: the next row is one of its own."""
        size = os.fstat(self._number).st_size
        os.lseek(self._number, max(size - 1, 0), os.SEEK_SET)
        if size and os.read(self._number, 1) != b"\n":
            self._write(b"\n")

    def append(self, row: dict[str, Any]) -> None:
        """Append a row, and see that it reaches the disk."""
        # A name that is not UTF-8 is an escape that JSON knows.
        text = json.dumps(row, ensure_ascii=True, allow_nan=False) + "\n"
        self._write(text.encode("ascii"))

    def _write(self, content: bytes) -> None:
        """Write at the end, to the disk."""
        data = memoryview(content)
        try:
            while data:
                data = data[os.write(self._number, data) :]
            os.fsync(self._number)
        except OSError as error:
            raise ReportError(self.path, error) from error

    def __enter__(self) -> RowFile:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        os.close(self._number)


def read_rows(paths: Iterable[Path]) -> dict[str, dict[str, Any]]:
    """Return the last row of each result, by its name; lines that were cut off are passed over.

    Parameters
    ----------
    paths : iterable of Path
        Reports; of a result that is in several the row that was written last counts.

    Raises
    ------
    PlanError
        If a file cannot be read.
    """
    rows: dict[str, dict[str, Any]] = {}
    for path in paths:
        try:
            with path.open("rb") as file:
                for line in file:
                    row = _row(line)
                    if row is None:
                        continue
                    old = rows.pop(row["output"], None)
                    rows[row["output"]] = row if old is None or row["ended"] >= old["ended"] else old
        except OSError as error:
            raise PlanError(f"{path} cannot be read: {error.strerror or error}.") from error
    return rows


def _row(line: bytes) -> dict[str, Any] | None:
    """Return a row, if a line is one."""
    try:
        row = json.loads(line)
    except (ValueError, RecursionError):
        return None
    kinds = {"output": str, "status": str, "ended": int | float}
    is_row = isinstance(row, dict) and all(isinstance(row.get(key), kind) for key, kind in kinds.items())
    return row if is_row else None


def is_done(task: Task, row: dict[str, Any] | None) -> bool:
    """Return whether the row says that the task was done, and input, settings and result are as it says.

    What they refer to, as materials and buffers, counts as well.
    """
    return (
        row is not None
        and row["status"] == DONE
        and row.get("key") == task.key
        and row.get("input_sha256") == hash_of(task.source) is not None
        and row.get("output_sha256") == hash_of(task.target)
        and _are_as_known(task.source, row.get("beside_input"))
        and _are_as_known(task.target, row.get("beside_output"))
    )


def _are_as_known(path: str, beside: Any) -> bool:
    """Return whether files beside a file have the hashes in a row; a hash of None stands for no file."""
    folder = Path(path).parent
    return all(hash_of(folder / name) == known for name, known in (beside or {}).items())
