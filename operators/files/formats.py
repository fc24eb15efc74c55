# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which format a file has, and the class that reads it."""

from __future__ import annotations

import stat
import struct
from typing import TYPE_CHECKING

from .gltf import GltfFile
from .mesh_file import FileError, MeshFile, stem_of
from .obj import ObjFile
from .ply import PlyFile
from .stl import StlFile

if TYPE_CHECKING:
    from pathlib import Path

PATCHED_TYPES = (".ply", ".obj", ".stl", ".glb", ".gltf")
"""Suffixes, in lower case, of the files that are read and written without Blender."""

_DAMAGES = (ValueError, LookupError, TypeError, AttributeError, OverflowError, struct.error, RecursionError)


def open_file(path: Path) -> MeshFile:
    """Read a mesh file.

    Parameters
    ----------
    path : Path
        A file whose name ends in one of `PATCHED_TYPES`, in any case.

    Returns
    -------
    MeshFile
        The surface, and all bytes of the file.

    Raises
    ------
    FileError
        In one sentence, if the file cannot be read, is damaged, or holds what is not understood.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> path = Path(tempfile.mkdtemp()) / "triangle.obj"
    >>> _ = path.write_text("v 0 0 0\\nv 1 0 0\\nv 0 1 0\\nf 1 2 3\\n")
    >>> file = open_file(path)
    >>> file.positions.shape, file.n_faces
    ((3, 3), 1)
    >>> file.positions[1, 0] = 1.5
    >>> file.positions.dtype
    dtype('float64')
    """
    data, name, kind = _read(path), stem_of(path), path.suffix.lower()
    try:
        if kind == ".ply":
            return PlyFile(data, name)
        if kind == ".obj":
            return ObjFile(data, name)
        if kind == ".stl":
            return StlFile(data, name)
        if kind in (".glb", ".gltf"):
            return GltfFile(data, name, path.parent)
    except FileError as error:
        raise FileError(f"{path}: {error}") from error
    except _DAMAGES as error:
        # What a header says may be wrong in more ways than there are checks.
        raise FileError(f"{path} is damaged or no {kind} file ({type(error).__name__}).") from error
    raise FileError(f"{path} is no {', '.join(PATCHED_TYPES[:-1])} or {PATCHED_TYPES[-1]} file.")


def _read(path: Path) -> bytes:
    """Return the bytes of a file or of a pipe."""
    try:
        mode = path.stat().st_mode
        if stat.S_ISDIR(mode):
            raise FileError(f"{path} is a folder; name a file.")
        if not (stat.S_ISREG(mode) or stat.S_ISFIFO(mode)):
            raise FileError(f"{path} is a device; name a file.")
        data = path.read_bytes()
    except FileNotFoundError as error:
        raise FileError(f"{path} does not exist.") from error
    except OSError as error:
        raise FileError(f"{path} cannot be read: {error.strerror or error}.") from error
    if not data:
        raise FileError(f"{path} is empty.")
    return data
