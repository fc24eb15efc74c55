# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a value stands in a JSON text, so that it alone can be replaced."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence

from .mesh_file import FileError

_DECODER = json.JSONDecoder()
_SPACE = re.compile(r"[ \t\n\r]*")


def span_of(text: str, path: Sequence[str | int], begin: int = 0) -> tuple[int, int]:
    """Return where a value begins and ends.

    Parameters
    ----------
    text : str
        A JSON text.
    path : sequence of str and int
        Names of objects and numbers in lists that lead to the value.
    begin : int
        Where the text begins.

    Raises
    ------
    FileError
        If there is no such value.

    Examples
    --------
    >>> text = '{"a": [1, {"b": 2.5}]}'
    >>> begin, end = span_of(text, ["a", 1, "b"])
    >>> text[begin:end]
    '2.5'
    """
    at = _skip(text, begin)
    for step in path:
        at = _member(text, at, step) if isinstance(step, str) else _item(text, at, step)
    return at, _DECODER.raw_decode(text, at)[1]


def replaced(text: str, changes: dict[tuple[int, int], str]) -> str:
    """Return a text with some spans, which do not overlap, replaced."""
    pieces, at = [], 0
    for (begin, end), new in sorted(changes.items()):
        pieces += [text[at:begin], new]
        at = end
    return "".join([*pieces, text[at:]])


def _skip(text: str, at: int) -> int:
    found = _SPACE.match(text, at)
    return at if found is None else found.end()


def _member(text: str, at: int, name: str) -> int:
    """Return where the value of a name in an object begins; the last one counts."""
    found = -1
    if text[at] != "{":
        raise FileError(f"The JSON text has no object with ‘{name}’ where one should be.")
    at = _skip(text, at + 1)
    while text[at] != "}":
        key, at = _DECODER.raw_decode(text, at)
        value = _skip(text, _skip(text, at) + 1)  # behind the colon
        if key == name:
            found = value
        at = _skip(text, _DECODER.raw_decode(text, value)[1])
        if text[at] == ",":
            at = _skip(text, at + 1)
    if found < 0:
        raise FileError(f"The JSON text has no ‘{name}’ where one should be.")
    return found


def _item(text: str, at: int, number: int) -> int:
    """Return where an item of a list begins."""
    if text[at] != "[":
        raise FileError(f"The JSON text has no list with an item {number} where one should be.")
    at = _skip(text, at + 1)
    for _ in range(number):
        at = _skip(text, _skip(text, _DECODER.raw_decode(text, at)[1]) + 1)  # behind the comma
    return at
