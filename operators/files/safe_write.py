# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that appear whole or not at all: written beside their places, checked, then moved there."""

from __future__ import annotations

import os
import re
import secrets
import shutil
import socket
import stat
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import NamedTuple

from .mesh_file import FileError
from .signals import Interrupted, deferred_signals

PREFIX = ".framelet-"
_LEFT_OVER = re.compile(re.escape(PREFIX) + r"(?P<host>[0-9A-Za-z.-]+)_(?P<pid>\d+)_[0-9a-f]+(\.\w+)?")
_CHUNK = 2**22
_LEAST_ROOM = 2**16  # bytes; a disk with less is full


class _Move(NamedTuple):
    """A file in the making, where it goes, and the name by which the user knows that place."""

    source: Path
    place: Path
    target: Path


def check_target(target: Path) -> None:
    """Raise FileError, in one sentence, unless a file can be written; no long run should end with that news.

    Parameters
    ----------
    target : Path
        A file, a link to one, a pipe or a device; a file need not be there yet.

    Examples
    --------
    >>> try:
    ...     check_target(Path("/no such folder/out.ply"))
    ... except FileError as error:
    ...     print(error)
    The folder /no such folder does not exist; make it first.
    """
    mode = _mode(target)
    if mode is not None and stat.S_ISDIR(mode):
        raise FileError(f"{target} is a folder; name a file in it.")
    if mode is not None and not stat.S_ISREG(mode):
        return
    place = _place(target)
    folder = place.parent
    try:
        if not folder.is_dir():
            raise FileError(f"The folder {folder} does not exist; make it first.")
    except OSError as error:
        raise FileError(f"{target} cannot be written: {error.strerror or error}.") from error
    if not os.access(folder, os.W_OK | os.X_OK):
        raise FileError(f"The folder {folder} cannot be written to.")
    if mode is not None and not os.access(place, os.W_OK):
        raise FileError(f"{target} is read-only; name another file, or allow writing to it.")


def remove_leftovers(folder: Path) -> None:
    """Remove what runs that were killed left in a folder; those of runs that go on stay."""
    try:
        found = [(path, _LEFT_OVER.fullmatch(path.name)) for path in folder.iterdir()]
    except OSError:
        return
    for path, match in found:
        if match and match["host"] == _host() and not _is_alive(int(match["pid"])):
            if path.is_dir() and not path.is_symlink():
                shutil.rmtree(path, ignore_errors=True)
            else:
                with suppress(OSError):
                    path.unlink()


class Outputs:
    """Files in the making; a context manager that leaves no trace of what was not published.

    Each file gets its final name in a folder of its own beside its place, so that it can be moved there in
    one step. A link stays, and what it leads to is replaced; a file that is replaced hands down its mode.

    Examples
    --------
    >>> import tempfile
    >>> target = Path(tempfile.mkdtemp()) / "out.txt"
    >>> with Outputs() as outputs:
    ...     outputs.write(target, b"all or nothing")
    ...     before = target.exists()
    ...     _ = outputs.publish()
    >>> before, target.read_bytes()
    (False, b'all or nothing')
    """

    def __init__(self) -> None:
        self._folders: list[Path] = []
        self._siblings: list[Path] = []
        self._moves: list[_Move] = []
        self._backups: list[tuple[Path, Path]] = []
        self._direct: list[tuple[Path, bytes]] = []

    def write(self, target: Path, data: bytes) -> None:
        """Write the bytes of a file, and check that they are there.

        Raises
        ------
        FileError
            In one sentence, if they cannot be written or read again.
        """
        mode = _mode(target)
        if mode is not None and not stat.S_ISREG(mode) and not stat.S_ISDIR(mode):
            self._direct.append((target, data))  # a pipe or a device holds nothing that could be lost
            return
        path = self.path_for(target)
        try:
            with path.open("wb") as file:
                file.write(data)
                file.flush()
                os.fsync(file.fileno())
        except OSError as error:
            raise FileError(f"{target} could not be written: {error.strerror or error}.") from error
        if not _holds(path, data):
            raise FileError(f"{target} could not be written: what was written cannot be read again.")

    def path_for(self, target: Path) -> Path:
        """Return where another program is to write a file; see `check_written`."""
        place = _place(target)
        remove_leftovers(place.parent)
        folder = place.with_name(_unique_name())
        try:
            folder.mkdir(mode=0o700)
        except OSError as error:
            raise FileError(f"The folder {place.parent} cannot be written to: {error.strerror}.") from error
        self._folders.append(folder)
        self._moves.append(_Move(folder / place.name, place, target))
        return folder / place.name

    def sibling_for(self, target: Path) -> Path:
        """Return where another program is to write a file that holds paths relative to its own folder."""
        place = _place(target)
        remove_leftovers(place.parent)
        path = place.with_name(_unique_name() + place.suffix)
        self._siblings.append(path)
        self._moves.append(_Move(path, place, target))
        return path

    def forget(self, path: Path) -> None:
        """Take back a file that `path_for` gave and that was not needed."""
        self._moves = [move for move in self._moves if move.source != path]

    def take(self, source: Path, target: Path) -> None:
        """Take a file that another program wrote, for another target."""
        self._moves.append(_Move(source, _place(target), target))

    def take_siblings(self, path: Path) -> None:
        """Take along what another program wrote beside a file that `path_for` gave.

        Raises
        ------
        FileError
            If one of them would overwrite a file.
        """
        known = {move.source for move in self._moves}
        target = next((move.target for move in self._moves if move.source == path), None)
        if target is None:
            return
        for other in sorted(each for each in path.parent.rglob("*") if each.is_file() and each not in known):
            place = target.parent / other.relative_to(path.parent)
            if place.exists() and not target.exists():
                raise FileError(
                    f"{place} would be overwritten; move it away, or choose another name for {target}."
                )
            place.parent.mkdir(parents=True, exist_ok=True)
            self._moves.insert(0, _Move(other, _place(place), place))

    def check_written(self) -> None:
        """Raise FileError if a file is missing or empty, or the disk is full, after another program wrote."""
        for move in self._moves:
            try:
                with move.source.open("rb") as file:
                    os.fsync(file.fileno())
                size = move.source.stat().st_size
                room = shutil.disk_usage(move.source.parent).free
            except OSError as error:
                raise FileError(f"{move.target} could not be written: {error.strerror or error}.") from error
            if not size or room < _LEAST_ROOM:
                raise FileError(f"{move.target} could not be written: the disk is full.")

    def keep_backups(self) -> list[Path]:
        """Keep all files that are replaced under names that are free, and return these names."""
        for move in self._moves:
            if not move.place.exists():
                continue
            backup, number = move.place.with_name(move.place.name + ".bak"), 1
            while os.path.lexists(backup):
                number += 1
                backup = move.place.with_name(f"{move.place.name}.bak{number}")
            self._backups.append((move.place, backup))
        return [backup for _place, backup in self._backups]

    def publish(self) -> list[Path]:
        """Move all files into place, in the order in which they were named.

        Returns
        -------
        list of Path
            What was written.

        Raises
        ------
        FileError
            If a file cannot be moved; the sentence names those that were before it.
        Interrupted
            If a signal came meanwhile; all files are in place.
        """
        done: list[Path] = []
        code = 0
        with deferred_signals() as signals:
            for place, backup in self._backups:
                _keep(place, backup)
            for move in self._moves:
                _take_over_mode(move)
                try:
                    os.replace(move.source, move.place)
                except KeyboardInterrupt:
                    code = 130
                    if move.source.exists():
                        os.replace(move.source, move.place)
                except OSError as error:
                    also = f" {', '.join(map(str, done))} was written before." if done else ""
                    raise FileError(
                        f"{move.target} could not be written: {error.strerror or error}.{also}"
                    ) from error
                done.append(move.target)
            for folder in {move.place.parent for move in self._moves}:
                sync_folder(folder)
            for target, data in self._direct:
                try:
                    with target.open("wb") as file:
                        file.write(data)
                except OSError as error:
                    raise FileError(f"{target} could not be written: {error.strerror or error}.") from error
                done.append(target)
        self._moves.clear()
        if signals:
            code = 128 + signals[0]
        if code:
            raise Interrupted(done, code)
        return done

    def __enter__(self) -> Outputs:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        with deferred_signals():
            for folder in self._folders:
                shutil.rmtree(folder, ignore_errors=True)
            for path in self._siblings:
                with suppress(OSError):
                    path.unlink(missing_ok=True)


def _mode(target: Path) -> int | None:
    """Return the mode of what is there, links followed; None for nothing."""
    try:
        return os.stat(target).st_mode
    except FileNotFoundError:
        return None
    except OSError as error:
        raise FileError(f"{target} cannot be written: {error.strerror or error}.") from error


def _place(target: Path) -> Path:
    """Return the file that a name leads to."""
    return Path(os.path.realpath(target))


def _host() -> str:
    """Return the name of this computer, as far as it can be part of a file name."""
    return re.sub(r"[^0-9A-Za-z.-]", "-", socket.gethostname())[:40] or "computer"


def _unique_name() -> str:
    """Return a name that tells which process it belongs to."""
    return f"{PREFIX}{_host()}_{os.getpid()}_{secrets.token_hex(4)}"


def _is_alive(pid: int) -> bool:
    """Return whether a process of this computer goes on; True where that cannot be told."""
    if os.name == "nt":
        return True
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except (OSError, OverflowError):
        return True
    return True


def _holds(path: Path, data: bytes) -> bool:
    """Return whether a file has these bytes."""
    view = memoryview(data)
    try:
        with path.open("rb") as file:
            for begin in range(0, len(data), _CHUNK):
                if file.read(_CHUNK) != view[begin : begin + _CHUNK]:
                    return False
            return not file.read(1)
    except OSError:
        return False


def _keep(place: Path, backup: Path) -> None:
    """Give a file a second name, or copy it where that is not possible."""
    try:
        try:
            os.link(place, backup)
        except OSError:
            shutil.copy2(place, backup)
    except OSError as error:
        raise FileError(f"The backup {backup} could not be written: {error.strerror or error}.") from error


def _take_over_mode(move: _Move) -> None:
    """Give a new file mode and owner of the file that it replaces."""
    with suppress(OSError):
        old = os.stat(move.place)
        os.chmod(move.source, stat.S_IMODE(old.st_mode))
        if hasattr(os, "chown") and os.stat(move.source).st_uid != old.st_uid:
            os.chown(move.source, old.st_uid, old.st_gid)


def sync_folder(folder: Path) -> None:
    """Put a folder's names onto the disk, where the system can."""
    with suppress(OSError):
        number = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(number)
        finally:
            os.close(number)
