# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which results a run may write that were not there before it: what is there later is then its own."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

from ..files.safe_write import sync_folder


class Begun:
    """Names that are on the disk before the first of them is written, so that a run that is killed between a
    result and its row knows the result for its own when it is started again.

    Parameters
    ----------
    report : Path
        The report; the names are beside it until a run comes to its end.
    """

    def __init__(self, report: Path) -> None:
        self._path = report.with_name(report.name + ".begun")

    def names(self) -> set[str]:
        """Return the names that runs before this one wrote down."""
        found: set[str] = set()
        with suppress(OSError), self._path.open("rb") as file:
            for line in file:
                with suppress(ValueError, RecursionError):  # cut off
                    found.add(str(json.loads(line)))
        return found

    def add(self, names: Iterable[str]) -> None:
        """Write names down."""
        lines = "".join("\n" + json.dumps(name) for name in names)
        with self._path.open("ab") as file:
            file.write(lines.encode("ascii"))
            file.flush()
            os.fsync(file.fileno())
        sync_folder(self._path.parent)

    def forget(self) -> None:
        """Remove the names: rows say the same now."""
        with suppress(OSError):
            self._path.unlink()
