# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a glTF or GLB file is made of: a JSON text and, in a GLB file, a chunk of binary data."""

from __future__ import annotations

import json
import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .mesh_file import FileError

MAGIC, JSON_CHUNK, BIN_CHUNK = b"glTF", 0x4E4F534A, 0x004E4942
COMPRESSIONS = {
    "KHR_draco_mesh_compression": "Draco",
    "EXT_meshopt_compression": "meshopt",
    "KHR_meshopt_compression": "meshopt",
}
_HEAD = 20  # bytes before the JSON text of a GLB file


class Container:
    """A file in memory, taken apart.

    Attributes
    ----------
    text : str
        The JSON text.
    content : dict
        What it says.
    chunk : bytes or None
        The binary data of a GLB file; None for a glTF file.

    Examples
    --------
    >>> container = Container(as_binary(b'{"asset":{"version":"2.0"}}', b"12345678"))
    >>> container.content["asset"]["version"], container.chunk
    ('2.0', b'12345678')
    """

    def __init__(self, data: bytes) -> None:
        self._data = data
        self._chunk_begin = self._json_size = 0
        self.chunk: bytes | None = None
        if data.startswith(MAGIC):
            self.chunk = b""
            self.text = self._take_apart()
        else:
            self.text = _decoded(data)
        try:
            self.content: dict[str, Any] = json.loads(self.text)
        except json.JSONDecodeError as error:
            raise FileError(f"The JSON text of the file is damaged in line {error.lineno}.") from error
        if not isinstance(self.content, dict) or not isinstance(self.content.get("asset"), dict):
            raise FileError("The file is no glTF file: its JSON text has no ‘asset’.")
        version = str(self.content["asset"].get("version", ""))
        if not version.startswith("2"):
            raise FileError(f"The file has the glTF version {version!r}; only version 2 can be read.")

    def _take_apart(self) -> str:
        """Return the JSON text of a GLB file, and note its binary data."""
        data, text = self._data, ""
        if len(data) < _HEAD:
            raise FileError("The file ends within its header; it was cut off.")
        version, length = struct.unpack_from("<II", data, 4)
        if version != 2:
            raise FileError(f"The file has the glTF version {version}; only version 2 can be read.")
        if length > len(data):
            raise FileError(
                f"The header speaks of {length:,} bytes, but the file has {len(data):,}; it was cut off."
            )
        at = 12
        while at + 8 <= length:
            size, kind = struct.unpack_from("<II", data, at)
            if at + 8 + size > length:
                raise FileError("A chunk is longer than the file; the file was cut off or is damaged.")
            if at == 12:
                if kind != JSON_CHUNK:
                    raise FileError("The first chunk of the file is not JSON; the file is damaged.")
                self._json_size, text = size, _decoded(data[at + 8 : at + 8 + size])
            elif kind == BIN_CHUNK and not self._chunk_begin:
                self._chunk_begin, self.chunk = at + 8, data[at + 8 : at + 8 + size]
            at += 8 + size
        return text

    def assembled(self, text: bytes, chunk: NDArray[np.uint8]) -> bytes:
        """Return the file with another JSON text, and other binary data of the same length."""
        if self.chunk is None:
            return text
        size = self._json_size
        if len(text) != size:
            bare = text.rstrip(b" ")
            text = bare + b" " * (-len(bare) % 4)
        rest = bytearray(self._data[_HEAD + size :])
        if self._chunk_begin:
            at = self._chunk_begin - _HEAD - size
            rest[at : at + len(self.chunk)] = chunk.tobytes()[: len(self.chunk)]
        length = struct.unpack_from("<I", self._data, 8)[0] + len(text) - size
        return self._data[:8] + struct.pack("<III", length, len(text), JSON_CHUNK) + text + bytes(rest)


def refuse_compression(content: dict[str, Any]) -> None:
    """Raise FileError if the JSON text of a file says that its geometry is compressed."""
    views = content.get("bufferViews", [])
    primitives = [each for mesh in content.get("meshes", []) for each in mesh.get("primitives", [])]
    for item in [*views, *primitives]:
        for name in item.get("extensions", {}):
            if name in COMPRESSIONS:
                raise FileError(
                    f"The meshes are compressed with {COMPRESSIONS[name]}; save the file without "
                    "compression first, as Blender's exporter does when its option Compression is off."
                )


def as_binary(text: bytes, chunk: bytes) -> bytes:
    """Return a GLB file of a JSON text and binary data, whose length is a multiple of four."""
    text += b" " * (-len(text) % 4)
    length = _HEAD + len(text) + 8 + len(chunk)
    head = MAGIC + struct.pack("<IIII", 2, length, len(text), JSON_CHUNK)
    return head + text + struct.pack("<II", len(chunk), BIN_CHUNK) + chunk


def _decoded(data: bytes) -> str:
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError as error:
        raise FileError("The JSON text of the file is not in UTF-8; the file is damaged.") from error
