# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is known of a mesh file before it is read: its type, whether it is there, and what may be written."""

from __future__ import annotations

import os
import stat
from pathlib import Path

from ..files.formats import PATCHED_TYPES
from ..files.safe_write import check_target
from .messages import USAGE_ERROR, CommandError

BLEND = ".blend"
BLENDER_TYPES = (BLEND, ".fbx", ".usd", ".usda", ".usdc", ".usdz", ".abc")
"""What Blender alone can read and write."""

WORDS = ".ply, .obj, .stl, .glb or .gltf, or with Blender .blend, .fbx, .usd or .abc"


def file_type(path: Path) -> str:
    """Return the type of a file, by its name: one of PATCHED_TYPES or BLENDER_TYPES.

    Raises
    ------
    CommandError
        If it is another type; this is a usage error.
    """
    suffix = path.suffix.lower()
    if suffix not in (*PATCHED_TYPES, *BLENDER_TYPES):
        raise CommandError(f"{path} is no mesh file; its name must end in {WORDS}.", USAGE_ERROR)
    return suffix


def needs_blender(*paths: Path) -> bool:
    """Return whether one of some files is for Blender alone."""
    return any(file_type(path) in BLENDER_TYPES for path in paths)


def check_source(path: Path) -> None:
    """Raise CommandError unless the file can be opened and holds something."""
    try:
        mode = os.stat(path).st_mode
        if stat.S_ISDIR(mode):
            raise CommandError(f"{path} is a folder; name a file.")
        if stat.S_ISREG(mode):
            with path.open("rb") as file:
                if not file.read(1):
                    raise CommandError(f"{path} is empty.")
        elif not stat.S_ISFIFO(mode):
            raise CommandError(f"{path} is a device; name a file.")
    except FileNotFoundError as error:
        raise CommandError(f"{path} does not exist.") from error
    except OSError as error:
        raise CommandError(f"{path} cannot be read: {error.strerror or error}.") from error


def check_output(source: Path, target: Path, *, may_replace: bool) -> None:
    """Raise CommandError or FileError unless OUT can be written, and is not IN without being asked for."""
    if not may_replace and is_same_file(source, target):
        raise CommandError(
            f"{target} is the file that is read; name another one, or add --in-place to replace it.",
            USAGE_ERROR,
        )
    check_target(target)


def is_same_file(first: Path, second: Path) -> bool:
    """Return whether two names lead to one file."""
    try:
        return os.path.samefile(first, second)
    except OSError:
        return False
