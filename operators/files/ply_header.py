# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The header of a PLY file: elements, their properties, and where the values begin."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from . import text
from .mesh_file import FileError

TYPES = {
    **{"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4"},
    **{"int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4"},
    **{"float": "f4", "double": "f8", "float32": "f4", "float64": "f8"},
    **{"int64": "i8", "uint64": "u8"},  # of no standard, but written
}
LONGEST_HEADER = 2**20
_LAST_LINE = re.compile(rb"(?<=[\r\n])end_header[ \t]*(\r\n|\n|\r)")
_ORDERS = {"binary_little_endian": "<", "binary_big_endian": ">", "ascii": ""}


@dataclass(frozen=True)
class Property:
    """A property of an element: its name, its type, and the type of its count if it is a list."""

    name: str
    kind: str
    count_kind: str = ""


@dataclass
class Element:
    """An element of the header: its name, how many there are, and their properties."""

    name: str
    count: int
    properties: list[Property] = field(default_factory=list)

    def index(self, *names: str) -> int:
        """Return the number of the first property with one of some names; -1 if there is none."""
        return next((k for k, each in enumerate(self.properties) if each.name in names), -1)


@dataclass
class Table:
    """Where the values of an element are.

    Attributes
    ----------
    element : Element
        What the header says.
    columns : list of ndarray, shape (count,)
        For each property where its values are: bytes of a binary file, words of a text.
    lengths : list of ndarray, shape (count,), or None
        For each list the number of its values; None for other properties.
    end : int
        Where the element ends.
    """

    element: Element
    columns: list[NDArray[np.int64]]
    lengths: list[NDArray[np.int64] | None]
    end: int


def read_header(data: bytes) -> tuple[str, list[Element], int]:
    """Return the order of bytes, empty for a text, the elements, and where the header ends."""
    if not data.startswith(b"ply"):
        raise FileError("The file does not begin with ‘ply’; it is damaged or of another type.")
    last = _LAST_LINE.search(data, 0, LONGEST_HEADER)
    if last is None:
        raise FileError("The header of the PLY file has no end; the file is damaged or of another type.")
    order, elements = None, []
    for line in data[: last.start()].decode("latin-1").replace("\r", "\n").split("\n"):
        words = line.split()
        if not words or words[0] in ("ply", "comment", "obj_info"):
            continue
        if words[0] == "format" and len(words) >= 2 and words[1] in _ORDERS:
            order = _ORDERS[words[1]]
        elif words[0] == "element" and len(words) == 3 and words[2].isdigit() and len(words[2]) < 16:
            elements.append(Element(words[1], int(words[2])))
        elif words[0] == "property" and elements and (found := _property(words)) is not None:
            elements[-1].properties.append(found)
        else:
            raise FileError(f"The line {text.shown(line.encode())} of the PLY header cannot be understood.")
    if order is None:
        raise FileError("The PLY header does not say whether the file is ascii or binary.")
    return order, elements, last.end()


def _property(words: list[str]) -> Property | None:
    """Return the property of a line of the header; None if it is none."""
    if len(words) == 3 and words[1] in TYPES:
        return Property(words[2], words[1])
    if len(words) == 5 and words[1] == "list" and words[2] in TYPES and words[3] in TYPES:
        return None if TYPES[words[2]][0] == "f" else Property(words[4], words[3], words[2])
    return None
