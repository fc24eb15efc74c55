# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where results go: names made by a template, within one folder, and never onto an input."""

from __future__ import annotations

import os
import re
import sys
import unicodedata
from collections.abc import Iterable
from pathlib import Path

from .inputs import PlanError
from .task import Task

DEFAULT_TEMPLATE = "{folder}{stem}{suffix}"
_FIELD = re.compile(r"\{([^{}]*)\}")


def named(template: str, name: Path, suffix: str, number: int, preset: str) -> str:
    """Return the name of a result.

    Parameters
    ----------
    template : str
        Words with fields: ``{folder}``, which ends in a slash if it is not empty, ``{stem}``, ``{suffix}``,
        ``{preset}``, and ``{number}``, or ``{number:5}`` with five digits.
    name : Path
        The name of the input below the folder that was searched.
    suffix : str
        What the name of the result ends in.
    number : int
        The number of the input in the batch, from 1.
    preset : str
        The word for the preset.

    Raises
    ------
    PlanError
        If the template has a field that is not known.

    Examples
    --------
    >>> named("{folder}{stem}_clean{suffix}", Path("left/ear.obj"), ".ply", 1, "auto")
    'left/ear_clean.ply'
    >>> named("{number:4}{suffix}", Path("ear.obj"), ".obj", 12, "auto")
    '0012.obj'
    """
    folder = name.parent.as_posix()
    values = {
        "folder": "" if folder == "." else folder + "/",
        "stem": name.stem,
        "suffix": suffix,
        "preset": preset,
        "number": str(number),
    }

    def value_of(match: re.Match[str]) -> str:
        word, _colon, width = match[1].partition(":")
        if word not in values or (width and not (word == "number" and width.isdecimal() and len(width) < 3)):
            raise PlanError(
                f"The name {template} has the field {match[0]}; known are "
                f"{', '.join('{' + key + '}' for key in values)}, and {{number:5}} with five digits."
            )
        return values[word].zfill(int(width)) if width else values[word]

    result = _FIELD.sub(value_of, template)
    # A name that is absolute would leave the folder by accident.
    return result.lstrip("/") if not os.path.isabs(template) else result


def place_in(folder: Path, name: str, may_leave: bool) -> Path:
    """Return the absolute path of a result.

    Raises
    ------
    PlanError
        If it lies outside the folder, links followed, and may not.

    Examples
    --------
    >>> place_in(Path("/out"), "a/../b.ply", False).as_posix()
    '/out/b.ply'
    >>> try:
    ...     place_in(Path("/out"), "../b.ply", False)
    ... except PlanError as error:
    ...     print(error)
    ../b.ply leaves the folder /out; add --allow-outside if it may.
    """
    target = Path(os.path.normpath(os.path.join(os.path.abspath(folder), name)))
    root = os.path.realpath(folder)
    if not may_leave and not Path(os.path.realpath(target)).is_relative_to(root):
        raise PlanError(f"{name} leaves the folder {folder}; add --allow-outside if it may.")
    return target


def check_collisions(tasks: Iterable[Task]) -> None:
    """Raise PlanError if two results have one place, or one has that of an input."""
    able = [task for task in tasks if not task.error]
    sources = {_same(task.source): task.source for task in able}
    targets: dict[str, str] = {}
    buffers: dict[str, str] = {}
    for task in able:
        place = _same(task.target)
        if place.lower().endswith(".gltf"):
            # Files of different folders may name their buffers alike.
            folder = os.path.dirname(_same(task.source))
            if buffers.setdefault(os.path.dirname(place), folder) != folder:
                raise PlanError(
                    f"{task.source} would be written beside a .gltf file of another folder, where their "
                    "buffers may meet; keep {folder} in --name, or write .glb."
                )
        if place in sources:
            raise PlanError(
                f"{task.target} is read and would be written; choose another --out, or another --name."
            )
        if place in targets:
            raise PlanError(
                f"{targets[place]} and {task.source} would both be written to {task.target}; tell them apart "
                "with {folder}, {suffix} or {number} in --name."
            )
        targets[place] = task.source


def _same(path: str) -> str:
    """Return what is the same for all names of a file."""
    place = os.path.normcase(os.path.realpath(path))
    # Disks of a Mac take letters for the same, capital or not, and however their accents are stored.
    return unicodedata.normalize("NFC", place).casefold() if sys.platform == "darwin" else place
