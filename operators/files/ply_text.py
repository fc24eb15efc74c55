# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The values of an ascii PLY file, by their words."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.mesh.ragged import stretches
from . import digits, text
from .mesh_file import FileError
from .ply_header import Element, Table

_ROWS = 2**15  # vertices that are written together: the processor has room for their text


class TextLayout:
    """Values at words, counted from the end of the header."""

    def __init__(self, data: bytes, begin: int) -> None:
        self._data, self._begin = data, begin
        self._letters = np.frombuffer(data, np.uint8, len(data) - begin, begin)
        self._start = np.flatnonzero(text.word_starts(self._letters))
        self._numbers: NDArray[np.float64] | None = None

    def table(self, element: Element, begin: int) -> Table:
        """Find out where the values of an element are."""
        is_list = [bool(each.count_kind) for each in element.properties]
        if not element.count or not element.properties:
            empty = np.zeros(0, np.int64)
            return Table(element, [empty] * len(is_list), [empty] * len(is_list), begin)
        if not any(is_list):
            row = np.arange(element.count, dtype=np.int64) * len(is_list) + begin
            end = begin + element.count * len(is_list)
            self._check_end(element, end)
            return Table(element, [row + k for k in range(len(is_list))], [None] * len(is_list), end)
        return (
            self._uniform(element, is_list, begin)
            or self._by_lines(element, is_list, begin)
            or self._walked(element, is_list, begin)
        )

    def _check_end(self, element: Element, end: int) -> None:
        if end > len(self._start):
            raise FileError(f"The file ends within the elements ‘{element.name}’; it was cut off.")

    def _uniform(self, element: Element, is_list: list[bool], begin: int) -> Table | None:
        """Find the values if all elements have lists as long as those of the first; else None."""
        starts, lengths, at = [], [], begin
        for each in is_list:
            if each:
                length = self._count(at)
                starts.append(at + 1)
                lengths.append(length)
                at += 1 + length
            else:
                starts.append(at)
                lengths.append(-1)
                at += 1
        step = at - begin
        if begin + step * element.count > len(self._start):
            return None
        row = np.arange(element.count, dtype=np.int64) * step
        for start, length in zip(starts, lengths, strict=True):
            if length >= 0 and not (self.values(start - 1 + row, "f8") == length).all():
                return None
        counts = [None if length < 0 else np.full(element.count, length) for length in lengths]
        return Table(element, [start + row for start in starts], counts, begin + step * element.count)

    def _by_lines(self, element: Element, is_list: list[bool], begin: int) -> Table | None:
        """Find the values if each element is a line that begins with its only list; else None."""
        if not is_list[0] or any(is_list[1:]) or begin >= len(self._start):
            return None
        origin = int(self._start[begin])
        breaks = np.flatnonzero(self._letters[origin:] == 10)[: element.count - 1] + origin
        row = np.concatenate(([begin], np.searchsorted(self._start, breaks)))
        if len(row) < element.count or row[-1] >= len(self._start):
            return None
        numbers = self._all()[row]
        if not ((numbers >= 0) & (numbers < 2**31)).all():
            return None
        length = numbers.astype(np.int64)
        end = row + length + len(is_list)
        if (end[:-1] != row[1:]).any() or end[-1] > len(self._start):
            return None
        columns = [row + 1, *(row + length + k for k in range(1, len(is_list)))]
        return Table(element, columns, [length, *[None] * (len(is_list) - 1)], int(end[-1]))

    def _count(self, at: int) -> int:
        if at >= len(self._start):
            raise FileError("The file ends within a list; it was cut off.")
        number = self._all()[at]
        if not (0 <= number < 2**31) or number != int(number):
            raise FileError(f"A list has {number:g} values; the file is damaged.")
        return int(number)

    def _walked(self, element: Element, is_list: list[bool], begin: int) -> Table:
        """Find the values of elements whose lists have different lengths, one element after the other."""
        at, n = begin, len(is_list)
        found = np.empty((element.count, 2 * n), np.int64)
        numbers = self._all()
        whole = (
            np.where(np.isfinite(numbers) & (np.abs(numbers) < 2**31), numbers, -1).astype(np.int64).tolist()
        )
        for row in range(element.count):
            marks = []
            for each in is_list:
                length = -1
                if each:
                    if at >= len(whole) or whole[at] < 0:
                        self._check_end(element, at + 1)
                        raise FileError("A list has a negative number of values; the file is damaged.")
                    length = whole[at]
                    at += 1
                marks += [at, length]
                at += 1 if length < 0 else length
            found[row] = marks
            self._check_end(element, at)
        lengths = [found[:, 2 * k + 1] if is_list[k] else None for k in range(n)]
        return Table(element, [found[:, 2 * k] for k in range(n)], lengths, at)

    def _all(self) -> NDArray[np.float64]:
        """Return all words as numbers."""
        if self._numbers is None:
            self._numbers = text.numbers(self._letters, np.float64, len(self._start))
        return self._numbers

    def values(self, at: NDArray[np.int64], kind: str) -> NDArray[Any]:
        """Return the values of some words, shape (n,)."""
        numbers = self._all()[at]
        with np.errstate(over="ignore", invalid="ignore"):
            return numbers.astype(kind)

    def lists(self, at: NDArray[np.int64], lengths: NDArray[np.int64], kind: str) -> NDArray[np.int64]:
        """Return the values of all lists, one after the other."""
        numbers = self._all()[stretches(at, lengths)]
        if not (np.abs(numbers) < 2.0**53).all():
            raise FileError(
                "A face names a vertex by something that is no whole number; the file is damaged."
            )
        return numbers.astype(np.int64)

    def replaced(
        self,
        places: list[NDArray[np.int64]],
        kinds: list[str],
        moved: NDArray[np.bool_],
        after: NDArray[np.floating],
        before: NDArray[np.float64],
    ) -> bytes:
        """Return the file with other words."""
        words = np.stack(places, axis=1)[moved]
        order = np.argsort(words[0])
        words, rows = words[:, order], np.asarray(after[moved], np.float64)[:, order]
        size = digits.size_of(before)
        pieces, done = [], -self._begin  # up to where the text is in the pieces
        for at in range(0, len(words), _ROWS):
            some = words[at : at + _ROWS].reshape(-1)
            # Only what lies between the first and the last of the words is looked at.
            first, last = int(some[0]), int(some[-1])
            begin = int(self._start[first])
            end = int(self._start[last + 1]) if last + 1 < len(self._start) else len(self._letters)
            letters = self._letters[begin:end]
            start = self._start[some] - begin
            stop = text.word_stops(letters)[some - first]
            style = (
                digits.NumberStyle(True, 0)
                if kinds[0][0] != "f"
                else digits.style_of_words(letters, start, stop, size, 0 if "f8" in kinds else 9)
            )
            new, lengths = digits.as_text(rows[at : at + _ROWS].reshape(-1), style)
            pieces.append(self._data[self._begin + done : self._begin + begin])
            pieces.append(text.replaced(letters, start, stop, new, lengths).tobytes())
            done = end
        return b"".join((*pieces, self._data[self._begin + done :]))
