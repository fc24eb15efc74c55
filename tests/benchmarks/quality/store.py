# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The rows on disk: a run that was killed goes on where it stopped."""

import os
from collections.abc import Iterable
from pathlib import Path

import sources  # noqa: F401
from cases import CaseName, has_quads
from measuring import NOISY, Row, Task, wanted_of, written_settings
from methods import BASELINES, FRAMELET, METHODS
from records import read_records, write_records

FILES = {"baselines.csv": [NOISY, *BASELINES], "presets.csv": list(FRAMELET)}
"""Files and the methods whose rows they hold: presets change with Framelet, baselines do not."""


class Store:
    """Rows in the CSV files of a folder.

    Parameters
    ----------
    folder : Path
        Where the files are; made if it is missing.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        folder.mkdir(parents=True, exist_ok=True)
        self._rows: dict[tuple, Row] = {}
        # What this run has added or dropped; about everything else the files know better.
        self._own: set[tuple] = set()
        for name in FILES:
            self._rows.update((row.key, row) for row in self._read(name))

    @property
    def rows(self) -> list[Row]:
        """All rows, in order."""
        return sorted(self._rows.values(), key=lambda row: row.key)

    def forget(self, methods: Iterable[str], cases: Iterable[CaseName]) -> None:
        """Drop the rows of some methods on some cases."""
        names, places = set(methods), set(cases)
        dropped = {key for key, row in self._rows.items() if row.method in names and row.case in places}
        self._own |= dropped
        for key in dropped:
            del self._rows[key]

    def _read(self, name: str) -> list[Row]:
        """Return the rows of a file; none if there is no file."""
        path = self.folder / name
        return read_records(Row, path) if path.is_file() else []

    def add(self, rows: Iterable[Row]) -> None:
        """Keep rows, on disk too."""
        rows = list(rows)
        self._rows.update((row.key, row) for row in rows)
        self._own.update(row.key for row in rows)
        for name, methods in FILES.items():
            if any(row.method in methods for row in rows):
                self.write(name)

    def write(self, name: str) -> None:
        """Write a file whole, so that a run that is killed leaves the old one or the new one.

        What another run has changed since is kept.
        """
        on_disk = [row for row in self._read(name) if row.key not in self._own]
        own = [row for key, row in self._rows.items() if key in self._own and row.method in FILES[name]]
        self._rows.update((row.key, row) for row in on_disk)
        rows = sorted([*on_disk, *own], key=lambda row: row.key)
        if rows:
            unfinished = self.folder / f"{name}.{os.getpid()}.part"
            write_records(rows, unfinished)
            unfinished.replace(self.folder / name)

    def task(self, case: CaseName, methods: Iterable[str]) -> Task | None:
        """Return what is missing of a case; None if nothing is.

        A preset whose settings have changed since is missing too, methods that cannot run are not.
        """
        missing, tuned = [], []
        is_quad = has_quads(case.model)
        served = [name for name in methods if METHODS[name].is_available() and METHODS[name].serves(is_quad)]
        for name, choice in wanted_of(served):
            row = self._rows.get((case, name, choice))
            is_old = (
                row is not None
                and name in FRAMELET
                and row.settings != written_settings(FRAMELET[name].settings)
            )
            if row is None or is_old:
                missing.append((name, choice))
            best = self._rows.get((case._replace(seed=0), name, "best"))
            if choice == "best" and best is not None:
                tuned.append((name, best.settings))
        return Task(case, tuple(missing), tuple(tuned)) if missing else None
