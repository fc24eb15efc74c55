# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Mesh files without Blender: read the surface, write a copy in which only coordinates differ.

Each format has one interface, `mesh_file.MeshFile`; `open_file` chooses among them. What a format does not
explain is copied byte for byte. Needs NumPy and nothing else.
"""

from __future__ import annotations

from .formats import PATCHED_TYPES, open_file
from .mesh_file import FileError, MeshFile, Part

__all__ = ["PATCHED_TYPES", "FileError", "MeshFile", "Part", "open_file"]
