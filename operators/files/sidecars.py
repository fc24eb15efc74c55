# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that a mesh file refers to, as materials and buffers: kept or copied, never overwritten."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING
from urllib.parse import quote, unquote

from .gltf import GltfFile
from .mesh_file import FileError, MeshFile
from .safe_write import Outputs

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

_MAP_WORDS = ("map_", "bump", "disp", "decal", "norm", "refl")


def sidecars_of(file: MeshFile, source: Path) -> list[str]:
    r"""Return the relative paths of all files that a file refers to, be they there or not.

    Examples
    --------
    >>> from framelet.operators.files.obj import ObjFile
    >>> sidecars_of(ObjFile(b"mtllib red.mtl\nv 0 0 0\n", "point"), Path("/scans/point.obj"))
    ['red.mtl']
    """
    names = file.buffer_files() + [each for name in file.references() for each in _named(name, source.parent)]
    for name in list(names):
        if name.lower().endswith(".mtl"):
            folder = Path(name).parent
            names += [str(folder / texture) for texture in _textures(source.parent / name)]
    return list(dict.fromkeys(names))


def write_sidecars(
    file: MeshFile,
    positions: NDArray[np.floating],
    source: Path,
    target: Path,
    outputs: Outputs,
    own: Mapping[str, str],
) -> list[str]:
    """Write what belongs to a file beside its copy.

    Parameters
    ----------
    file : MeshFile
        What was read; buffers that hold coordinates get new names in it where theirs are taken.
    positions : ndarray, shape (N, 3)
        Where the vertices are now.
    source, target : Path
        The file that was read and the one that is written.
    outputs : Outputs
        Takes the files.
    own : mapping of str to str
        Absolute paths of what was written beside the target before, with their SHA-256: as long as it is
        that, it may be replaced.

    Returns
    -------
    list of str
        Sentences about what could not be copied.

    Raises
    ------
    FileError
        If a buffer would overwrite a file that does not belong to the target.
    """
    warnings: list[str] = []
    buffers = file.side_files(positions)
    if isinstance(file, GltfFile) and buffers:
        file.renames = _new_names(buffers, source, target)
        for uri, content in buffers.items():
            outputs.write(target.parent / unquote(file.renames[uri]), content)
    if _same_folder(source, target):
        return warnings
    held = set(file.buffer_files())
    for name in sidecars_of(file, source):
        if name not in held:
            warnings += _copy(name, source, target, outputs, own)
    return warnings


def _named(text: str, folder: Path) -> list[str]:
    """Return the files that a reference names: one whose name may have spaces, or else several."""
    words = text.split()
    if not (folder / text).is_file() and any((folder / word).is_file() for word in words):
        return words
    return [text]


def _new_names(buffers: Mapping[str, bytes], source: Path, target: Path) -> dict[str, str]:
    """Return the names of buffers beside the target: their own, or else that of the target."""
    names = {}
    for number, (uri, content) in enumerate(buffers.items(), 1):
        place = target.parent / unquote(uri)
        own = target.stem if len(buffers) == 1 else f"{target.stem}-{number}"
        keeps = not _leaves(unquote(uri)) or _is_same(source, target)
        if keeps and (_belongs(place, source, target, uri) or _can_be(place, content, source, uri)):
            names[uri] = uri
            continue
        new = quote(own + (Path(unquote(uri)).suffix or ".bin"))
        place = target.parent / unquote(new)
        if not _belongs(place, source, target, new) and not _can_be(place, content, source, uri):
            raise FileError(
                f"{place} would be overwritten; move it away, or choose another name for {target}."
            )
        names[uri] = new
    return names


def _leaves(name: str) -> bool:
    """Return whether a reference may lead out of the folder of its file: nothing is written there."""
    path = Path(name.replace("\\", "/"))
    return path.is_absolute() or bool(path.drive) or ".." in path.parts


def _is_same(source: Path, target: Path) -> bool:
    """Return whether a file is replaced by its own copy."""
    try:
        return source.samefile(target)
    except OSError:
        return False


def _belongs(place: Path, source: Path, target: Path, uri: str) -> bool:
    """Return whether a file at a place is the buffer of the file that is replaced, and of that alone."""
    try:
        if not place.exists() or f'"{uri}"'.encode() not in target.read_bytes():
            return False
        is_read = (source.parent / unquote(uri)).exists() and place.samefile(source.parent / unquote(uri))
        return not is_read or source.samefile(target)
    except OSError:
        return False


def _can_be(place: Path, content: bytes, source: Path, uri: str) -> bool:
    """Return whether a place is free, or has this content already, as a run leaves that was killed there."""
    try:
        if not place.parent.is_dir() or not place.exists():
            return place.parent.is_dir()
        old = source.parent / unquote(uri)
        is_read = old.exists() and place.samefile(old)
        if is_read or place.stat().st_size != len(content) or place.read_bytes() != content:
            return False
        # One that another file refers to is not shared: that file would change with this one.
        word = f'"{quote(place.name)}"'.encode()
        return not any(word in path.read_bytes() for path in place.parent.glob("*.gltf"))
    except OSError:
        return False


def _copy(name: str, source: Path, target: Path, outputs: Outputs, own: Mapping[str, str]) -> list[str]:
    """Copy a file that is referred to by a relative path; return what is to be said."""
    path = Path(name.replace("\\", "/"))
    if _leaves(name) or not name:
        return [] if path.is_absolute() else [f"{target} refers to {name}, which was not copied."]
    old, new = source.parent / path, target.parent / path
    try:
        content = old.read_bytes() if old.is_file() else None
        if content is None:
            return []  # as before: the reference leads nowhere
        if new.exists():
            there = new.read_bytes() if new.is_file() else None
            if there == content:
                return []
            if there is None or own.get(str(new.absolute())) != hashlib.sha256(there).hexdigest():
                return [f"{new} is another file than {old} and was left alone."]
        new.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        return [f"{old} could not be copied: {error.strerror or error}."]
    outputs.write(new, content)
    return []


def _textures(path: Path) -> list[str]:
    """Return the textures that a material file names."""
    try:
        lines = path.read_text("utf-8", "surrogateescape").splitlines()
    except OSError:
        return []
    found = []
    for line in lines:
        keyword, _space, rest = line.strip().partition(" ")
        rest = rest.strip()
        if not keyword.lower().startswith(_MAP_WORDS) or not rest:
            continue
        # Options come first; a name may have spaces.
        words = rest.split(" ")
        candidates = [" ".join(words[at:]) for at in range(len(words))]
        found += [name for name in candidates if (path.parent / name.replace("\\", "/")).is_file()][:1]
    return found


def _same_folder(source: Path, target: Path) -> bool:
    return os.path.realpath(source.parent) == os.path.realpath(target.parent)
