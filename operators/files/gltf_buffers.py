# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The numbers of a glTF file: buffers one after the other, and the accessors that lead into them."""

from __future__ import annotations

import base64
import binascii
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import numpy as np
from numpy.typing import NDArray

from .mesh_file import FileError, doubles

COMPONENTS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}

MOST_ELEMENTS = (4, 2**19)
"""Elements of accessors, and corners, for each byte and beside: a small file must not fill the memory.

Files that share have few more elements than bytes.
"""


@dataclass(frozen=True, eq=False)
class Stored:
    """Where the values of an accessor are.

    Attributes
    ----------
    at : ndarray, shape (n,), int64
        Byte of each element, counted over all buffers; negative for zeros that are stored nowhere.
    dtype : dtype
        Type of each component.
    width : int
        Components of each element.
    is_normalized : bool
        Whether whole numbers stand for fractions.
    """

    at: NDArray[np.int64]
    dtype: np.dtype
    width: int
    is_normalized: bool

    @property
    def size(self) -> int:
        """Bytes of an element."""
        return self.dtype.itemsize * self.width

    @property
    def scale(self) -> float:
        """What a stored number is divided by."""
        return float(np.iinfo(self.dtype).max) if self.is_normalized and self.dtype.kind != "f" else 1.0


class Buffers:
    """All buffers of a file, one after the other, so that a byte has one number.

    Parameters
    ----------
    content : dict
        The JSON text of the file.
    chunk : bytes or None
        The buffer without a name, of a GLB file.
    folder : Path
        Where the files of other buffers are.
    """

    def __init__(self, content: dict[str, Any], chunk: bytes | None, folder: Path) -> None:
        self._json = content
        self.uris: list[str | None] = []
        buffers = []
        for number, buffer in enumerate(content.get("buffers", [])):
            uri, size = buffer.get("uri"), as_count(buffer["byteLength"])
            if uri is None:
                if number or chunk is None:
                    raise FileError(f"Buffer {number} names no file; the file is damaged.")
                found = chunk
            else:
                found = _content(uri, folder)
            if len(found) < size:
                raise FileError(
                    f"Buffer {number} has {len(found):,} bytes, but {size:,} are spoken of; it was cut off."
                )
            self.uris.append(uri)
            buffers.append(found)
        sizes = [len(found) for found in buffers]
        self.begin = np.concatenate(([0], np.cumsum(sizes))).astype(np.int64)
        self.bytes = np.frombuffer(b"".join(buffers), np.uint8)
        self._stored: dict[int, Stored] = {}
        self._n_elements = 0

    def stored(self, number: Any) -> Stored:
        """Find out where the values of an accessor are; the same object whenever it is asked for."""
        if as_count(number) not in self._stored:
            found = self._find(number)
            self._n_elements += len(found.at)
            self.check_size(self._n_elements, "elements")
            self._stored[number] = found
        return self._stored[number]

    def _find(self, number: int) -> Stored:
        accessor = self._json["accessors"][number]
        count, dtype = as_count(accessor["count"]), np.dtype(COMPONENTS[accessor["componentType"]])
        width = WIDTHS[accessor["type"]]
        size = dtype.itemsize * width
        if "bufferView" in accessor:
            at = self._elements(accessor["bufferView"], accessor.get("byteOffset", 0), count, size)
        else:
            self.check_size(self._n_elements + count, "elements")
            # Zeros that are stored nowhere; each is a place of its own.
            at = -1 - np.arange(count, dtype=np.int64) - number * 2**33
        sparse = accessor.get("sparse")
        if sparse is not None:
            n, indices, values = as_count(sparse["count"]), sparse["indices"], sparse["values"]
            kind = np.dtype(COMPONENTS[indices["componentType"]])
            where = self._elements(
                indices["bufferView"], indices.get("byteOffset", 0), n, kind.itemsize, True
            )
            numbers = self.numbers(where, kind, 1).reshape(-1).astype(np.int64)
            if n and (numbers.max() >= count or (np.diff(numbers) <= 0).any()):
                raise FileError("The numbers of a sparse accessor are not in order; the file is damaged.")
            at = at.copy()
            at[numbers] = self._elements(values["bufferView"], values.get("byteOffset", 0), n, size, True)
        return Stored(at, dtype, width, bool(accessor.get("normalized", False)))

    def _elements(
        self, view: Any, offset: Any, count: int, size: int, is_tight: bool = False
    ) -> NDArray[np.int64]:
        """Return where the elements of a buffer view begin, shape (count,)."""
        found = self._json["bufferViews"][as_count(view)]
        buffer, stride = as_count(found["buffer"]), as_count(found.get("byteStride", 0)) or size
        stride = size if is_tight else stride
        begin, length = as_count(found.get("byteOffset", 0)), as_count(found["byteLength"])
        offset = as_count(offset)
        if begin + length > self.begin[buffer + 1] - self.begin[buffer]:
            raise FileError(f"A view of {length:,} bytes ends behind its buffer; the file is damaged.")
        # What lies behind a view belongs to others, which must not be written to.
        if stride < size or (count and offset + (count - 1) * stride + size > length):
            raise FileError(f"An accessor of {count:,} elements ends behind its view; the file is damaged.")
        return np.arange(count, dtype=np.int64) * stride + offset + begin + int(self.begin[buffer])

    def is_apart(self, some: list[Stored], others: list[Stored]) -> bool:
        """Return whether no byte belongs to elements of both; all have elements."""

        # Almost always whole views lie one behind the other, and their ends tell.
        begins = np.array([each.at.min() for each in others])
        ends = np.array([each.at.max() + each.size for each in others])
        inside = [
            each for each in some if ((each.at.min() < ends) & (begins < each.at.max() + each.size)).any()
        ]
        if not inside:
            return True
        is_taken = np.zeros(len(self.bytes), bool)
        for one in inside:
            is_taken[self._bytes_of(one)] = True
        return not any(is_taken[self._bytes_of(each)].any() for each in others)

    @staticmethod
    def _bytes_of(stored: Stored) -> NDArray[np.int64]:
        """Return the numbers of all bytes of what is stored somewhere, shape (m, size)."""
        return stored.at[stored.at >= 0, None] + np.arange(stored.size)

    def check_size(self, count: int, what: str) -> None:
        """Raise FileError if there are more of something than the buffers can speak of."""
        each, beside = MOST_ELEMENTS
        if count > each * len(self.bytes) + beside:
            raise FileError(
                f"The file names {count:,} {what}, but holds {len(self.bytes):,} bytes; it is damaged."
            )

    def numbers(self, at: NDArray[np.int64], dtype: np.dtype, width: int) -> NDArray[Any]:
        """Return stored numbers, shape (n, width); zeros where nothing is stored."""
        size = dtype.itemsize * width
        step = int(at[1] - at[0]) if len(at) > 1 else size
        if len(at) and at[0] >= 0 and (np.diff(at) == step).all() and step > 0:
            return np.ndarray(
                (len(at), width), dtype, self.bytes.data, int(at[0]), strides=(step, dtype.itemsize)
            ).copy()
        result = np.zeros((len(at), width), dtype)
        is_stored = at >= 0
        parts = self.bytes[at[is_stored, None] + np.arange(size)]
        result[is_stored] = np.ascontiguousarray(parts).view(dtype).reshape(-1, width)
        return result

    def values(self, stored: Stored) -> NDArray[np.float64]:
        """Return the values of an accessor, shape (n, width)."""
        numbers = doubles(self.numbers(stored.at, stored.dtype, stored.width))
        return numbers if stored.scale == 1.0 else np.maximum(numbers / stored.scale, -1.0)

    @staticmethod
    def store(
        content: NDArray[np.uint8], stored: Stored, chosen: NDArray[np.bool_], values: NDArray[np.float64]
    ) -> None:
        """Write values of some elements into the buffers."""
        numbers = np.ascontiguousarray(as_stored(values, stored))
        size = stored.dtype.itemsize * stored.width
        content[stored.at[chosen, None] + np.arange(size)] = numbers.view(np.uint8).reshape(-1, size)


def as_stored(values: NDArray[np.float64], stored: Stored) -> NDArray[Any]:
    """Return values as the numbers that stand for them, shape (n, width)."""
    if stored.dtype.kind == "f":
        return values.astype(stored.dtype)
    limits = np.iinfo(stored.dtype)
    return np.clip(np.rint(values * stored.scale), limits.min, limits.max).astype(stored.dtype)


def as_count(value: Any) -> int:
    """Return a number of the JSON text that counts something."""
    if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value < 2**40:
        raise FileError(
            f"{str(value)[:40]} stands where a number of elements should be; the file is damaged."
        )
    return value


def is_file(uri: str) -> bool:
    """Return whether a URI is a relative path."""
    return not uri.startswith("data:") and "://" not in uri


def _content(uri: str, folder: Path) -> bytes:
    """Return what a URI stands for."""
    if uri.startswith("data:"):
        head, _comma, body = uri.partition(",")
        if not head.endswith(";base64"):
            raise FileError("A buffer is neither base64 nor a file; save the file as .glb first.")
        try:
            return base64.b64decode(body, validate=True)
        except binascii.Error as error:
            raise FileError("A buffer in the JSON text is damaged; its base64 cannot be read.") from error
    if not is_file(uri):
        raise FileError(f"The buffer {uri[:80]} is not on this computer; put it beside the file.")
    path = folder / unquote(uri)
    try:
        if not path.is_file():
            raise FileError(f"The file {path}, which holds the coordinates, does not exist.")
        return path.read_bytes()
    except OSError as error:
        raise FileError(f"{path} cannot be read: {error.strerror or error}.") from error
