# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""One file of a batch: what is read, what is written, and with which settings."""

from __future__ import annotations

import hashlib
import json
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any


@dataclass(frozen=True)
class Task:
    """What is to be done with one file; plain values, so that any process can be told.

    Attributes
    ----------
    source, target : str
        The absolute paths of the file that is read and the one that is written.
    name : str
        The target below the folder of the batch, with slashes; absolute if it lies elsewhere.
    preset : str
        Key of the preset that the settings started from.
    settings, region : dict
        The fields of DenoiseSettings and of RegionOptions.
    placement : str
        Where the surface goes in a .blend file.
    error : str
        Why the task cannot be done at all, in one sentence; empty if it can.

    Examples
    --------
    >>> task = Task("/in/a.ply", "/out/a.ply", "a.ply", "AUTO", {"strength": 1.0})
    >>> task.key == Task("/b.ply", "/out/b.ply", "b.ply", "AUTO", {"strength": 1.0}).key
    True
    >>> task.key == Task("/in/a.ply", "/out/a.ply", "a.ply", "AUTO", {"strength": 2.0}).key
    False
    """

    source: str
    target: str
    name: str
    preset: str = ""
    settings: dict[str, Any] = field(default_factory=dict)
    region: dict[str, Any] = field(default_factory=dict)
    placement: str = ""
    error: str = ""

    @property
    def key(self) -> str:
        """A hash of all that decides what comes of given bytes."""
        content = [self.settings, self.region, self.placement, Path(self.target).suffix.lower()]
        return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()

    def as_dict(self) -> dict[str, Any]:
        """Return the fields, as ``Task(**fields)`` takes them."""
        return asdict(self)


def hash_of(path: str | Path) -> str | None:
    """Return the SHA-256 of a file; None if it is no file that can be read.

    Examples
    --------
    >>> hash_of("/no such file") is None
    True
    """
    try:
        if not Path(path).is_file():
            return None  # a pipe would be used up
        with open(path, "rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except OSError:
        return None
