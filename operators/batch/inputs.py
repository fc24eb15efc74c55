# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which files are meant by files, patterns and folders."""

from __future__ import annotations

import glob
import os
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

from ...core.errors import FrameletError


class ReportError(FrameletError):
    """The report cannot be written, so that the run ends; what was done before is in it, and stays."""

    def __init__(self, path: Path | str, error: OSError) -> None:
        super().__init__(
            f"{path} cannot be written: {error.strerror or error}; the run ends here, and a rerun goes on."
        )


class PlanError(FrameletError):
    """What is asked of a batch contradicts itself, in one sentence for people."""


class Found(NamedTuple):
    """A file, and its name below what it was found by."""

    source: Path
    name: Path


def find_files(words: Sequence[str], suffixes: Iterable[str], left_out: Path) -> list[Found]:
    """Return the files that are meant, each once, in the order of the words and then by name.

    Parameters
    ----------
    words : sequence of str
        Files, folders, which are searched to their depth, and patterns, in which ``**`` stands for any depth.
    suffixes : iterable of str
        What names in folders end in, in lower case. A file that is named is taken whatever its name.
    left_out : Path
        A folder that is not searched: results are no inputs of the next run.

    Returns
    -------
    list of Found
        Names below a folder or a pattern keep the folders in between.

    Raises
    ------
    PlanError
        If a pattern or a folder holds no file.

    Examples
    --------
    >>> import tempfile
    >>> folder = Path(tempfile.mkdtemp())
    >>> (folder / "b").mkdir()
    >>> for name in ("a.ply", "notes.txt", "b/c.PLY"):
    ...     (folder / name).touch()
    >>> [found.name.as_posix() for found in find_files([str(folder)], [".ply"], folder / "out")]
    ['a.ply', 'b/c.PLY']
    """
    endings = tuple(suffixes)
    found: dict[str, Found] = {}
    for word in words:
        path = Path(word)
        if path.is_dir():
            files = [Found(each, each.relative_to(path)) for each in _in_folder(path, endings, left_out)]
        elif glob.has_magic(word) and not path.exists():
            files = _matches(word, endings, left_out)
        else:
            files = [Found(path, Path(path.name))]
        if not files:
            raise PlanError(f"{word} holds no mesh file; name files, folders or patterns that do.")
        for each in files:
            found.setdefault(os.path.realpath(each.source), each)
    return list(found.values())


def _matches(pattern: str, endings: tuple[str, ...], left_out: Path) -> list[Found]:
    """Return the mesh files that a pattern matches, named below its part without wildcards."""
    parts = Path(pattern).parts
    plain = next(number for number, part in enumerate(parts) if glob.has_magic(part))
    root = Path(*parts[:plain])
    files = sorted(Path(match) for match in glob.glob(pattern, recursive=True))
    return [
        Found(file, file.relative_to(root))
        for file in files
        if file.suffix.lower() in endings and file.is_file() and not _is_below(file, left_out)
    ]


def _in_folder(folder: Path, endings: tuple[str, ...], left_out: Path) -> list[Path]:
    """Return the mesh files below a folder; links to folders are not followed, hidden names left out."""
    files = []
    for place, folders, names in os.walk(folder):
        here = Path(place)
        folders[:] = [
            name for name in folders if not name.startswith(".") and not _is_below(here / name, left_out)
        ]
        files += [here / name for name in names if name.lower().endswith(endings) and name[0] != "."]
    files = [file for file in files if not file.is_fifo()]  # a pipe that nobody writes to would stop all
    return sorted(files) if not _is_below(folder, left_out) else []


def _is_below(path: Path, folder: Path) -> bool:
    """Return whether a path is a folder or lies in it, links followed."""
    return Path(os.path.realpath(path)).is_relative_to(os.path.realpath(folder))
