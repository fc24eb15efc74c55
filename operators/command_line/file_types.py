# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is known of a mesh file before Blender is asked: its type, and whether it is there."""

from __future__ import annotations

from pathlib import Path

from .messages import USAGE_ERROR, CommandError

MESH_TYPES = (".ply", ".obj", ".stl")
BLEND = ".blend"


def file_type(path: Path) -> str:
    """Return the type of a file, by its name: one of MESH_TYPES or BLEND.

    Raises
    ------
    CommandError
        If it is another type; this is a usage error.
    """
    suffix = path.suffix.lower()
    if suffix not in (*MESH_TYPES, BLEND):
        raise CommandError(f"{path} is no .ply, .obj, .stl or .blend file.", USAGE_ERROR)
    return suffix


def check_source(path: Path) -> None:
    """Raise CommandError unless the file can be opened and holds something."""
    if path.is_dir():
        raise CommandError(f"{path} is a folder; name a file.")
    if not path.exists():
        raise CommandError(f"{path} does not exist.")
    try:
        with path.open("rb") as file:
            is_empty = not file.read(1)
    except OSError as error:
        raise CommandError(f"{path} cannot be read: {error.strerror}.") from error
    if is_empty:
        raise CommandError(f"{path} is empty.")
