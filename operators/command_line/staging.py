# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that appear whole or not at all: written elsewhere first, then moved into place."""

from __future__ import annotations

import os
import shutil
import tempfile
from contextlib import suppress
from pathlib import Path
from types import TracebackType

from .messages import CommandError


def check_folder(target: Path) -> None:
    """Raise CommandError unless a file can be written there; no long run should end with that news."""
    folder = target.parent
    if target.is_dir():
        raise CommandError(f"{target} is a folder; name a file in it.")
    if not folder.is_dir():
        raise CommandError(f"The folder {folder} does not exist; make it first.")
    if not os.access(folder, os.W_OK | os.X_OK):
        raise CommandError(f"The folder {folder} cannot be written to.")


class Staging:
    """Output files in the making; a context manager that leaves no trace of what was not published.

    A file gets its final base name in a temporary folder beside its target, so that files that name each
    other, as .obj and .mtl do, need not be changed, and moving is atomic, on the same file system.
    """

    def __init__(self) -> None:
        self._folders: list[tuple[Path, Path]] = []
        self._siblings: list[tuple[Path, Path]] = []

    def path_for(self, target: Path) -> Path:
        """Return where to write a file; what else is written into the same folder moves with it."""
        folder = self._make_folder(target)
        self._folders.append((folder, target))
        return folder / target.name

    def sibling_for(self, target: Path) -> Path:
        """Return where to write a file that holds paths relative to its own folder."""
        folder = self._make_folder(target)
        folder.rmdir()
        # Its unique name is what was needed.
        sibling = folder.with_name(folder.name + target.suffix)
        self._siblings.append((sibling, target))
        return sibling

    def publish(self) -> None:
        """Move all files into place, each target last of its folder.

        Raises
        ------
        CommandError
            If a file was not written or cannot be moved.
        """
        moves = list(self._siblings)
        for folder, target in self._folders:
            others = (path for path in sorted(folder.iterdir()) if path.name != target.name)
            moves += [(path, target.parent / path.name) for path in others]
            moves.append((folder / target.name, target))
        for source, target in moves:
            if not source.is_file() or source.stat().st_size == 0:
                raise CommandError(f"{target} could not be written; the disk may be full.")
        for source, target in moves:
            try:
                os.replace(source, target)
            except OSError as error:
                raise CommandError(f"{target} could not be written: {error.strerror}.") from error

    def __enter__(self) -> Staging:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for folder, _target in self._folders:
            shutil.rmtree(folder, ignore_errors=True)
        for sibling, _target in self._siblings:
            with suppress(OSError):
                sibling.unlink(missing_ok=True)

    @staticmethod
    def _make_folder(target: Path) -> Path:
        """Make a folder with a unique name beside a target."""
        try:
            return Path(tempfile.mkdtemp(prefix=".framelet-", dir=target.parent))
        except OSError as error:
            raise CommandError(
                f"The folder {target.parent} cannot be written to: {error.strerror}."
            ) from error
