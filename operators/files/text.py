# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers in text, by the million: read from lines, and replaced in place.

All works on blocks of whole lines as arrays of bytes, without a loop over lines.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

from .mesh_file import FileError

BLOCK = 2**21
"""Bytes that are looked at together: some ten times as many are in use meanwhile."""

SHOWN = 40  # letters of a line that an error shows
_SPACE, _NEWLINE = 32, 10


@dataclass(frozen=True, eq=False)
class Block:
    """Whole lines of a text.

    Attributes
    ----------
    begin : int
        Where the lines begin in the text.
    letters : ndarray, shape (n,), uint8
        The bytes.
    first : ndarray, shape (k,), int64
        Where the first letter of each line is that is no space, counted from `begin`.
    start : ndarray, shape (k,), int64
        Where each line begins, counted from `begin`.
    """

    begin: int
    letters: NDArray[np.uint8]
    first: NDArray[np.int64]
    start: NDArray[np.int64]

    @property
    def stop(self) -> NDArray[np.int64]:
        """Where each line ends, its line break included, counted from `begin`."""
        return np.append(self.start[1:], len(self.letters))

    def with_keyword(self, keyword: bytes, *, any_case: bool = False) -> NDArray[np.bool_]:
        """Return which lines begin with a word and a space, shape (k,); the word is in lower case."""
        n = len(self.letters)
        found = self.first + len(keyword) < n
        for place, letter in enumerate(keyword):
            here = self.letters[np.minimum(self.first + place, n - 1)]
            found &= ((here | 0x20) if any_case else here) == letter
        found &= self.letters[np.minimum(self.first + len(keyword), n - 1)] <= _SPACE
        return found

    def of_lines(
        self, lines: NDArray[np.bool_], keyword_length: int
    ) -> tuple[NDArray[Any], NDArray[Any], NDArray[Any]]:
        """Return the letters of some lines without their keyword, where each begins, and its length."""
        start, stop = self.start[lines], self.stop[lines]
        first = self.first[lines]
        if len(start) and (start[1:] == stop[:-1]).all():
            letters = self.letters[start[0] : stop[-1]].copy()
            new_start = start - start[0]
        else:
            letters = self.letters[np.repeat(lines, self.stop - self.start)]
            new_start = np.concatenate(([0], np.cumsum(stop - start)))[:-1].astype(np.int64)
        at = first - start + new_start
        for place in range(keyword_length):
            letters[at + place] = _SPACE
        return letters, new_start, stop - start


def blocks(text: bytes, begin: int = 0, size: int = BLOCK) -> Iterator[Block]:
    """Give the lines of a text in blocks; a text without a line feed has lines that end with \\r."""
    newline = b"\r" if text.find(b"\n", begin) < 0 else b"\n"
    while begin < len(text):
        end = text.rfind(newline, begin, begin + size) + 1
        if not end:
            end = text.find(newline, begin + size) + 1 or len(text)
        yield _block(text, begin, end, newline[0])
        begin = end


def _block(text: bytes, begin: int, end: int, newline: int) -> Block:
    letters = np.frombuffer(text, np.uint8, end - begin, begin)
    breaks = np.flatnonzero(letters == newline)
    start = np.concatenate(([0], breaks + 1))
    if start[-1] == len(letters):
        start = start[:-1]
    first = start.copy()
    while True:
        here = letters[np.minimum(first, len(letters) - 1)]
        is_indented = np.flatnonzero(((here == _SPACE) | (here == 9)) & (first < len(letters)))
        if not len(is_indented):
            return Block(begin, letters, first, start)
        if len(is_indented) < 64:
            # A few deep indents would take a step a letter.
            for line in is_indented.tolist():
                stop = start[line + 1] if line + 1 < len(start) else len(letters)
                piece = letters[start[line] : stop].tobytes()
                first[line] = start[line] + len(piece) - len(piece.lstrip(b" \t"))
            return Block(begin, letters, first, start)
        first[is_indented] += 1


def word_starts(letters: NDArray[np.uint8]) -> NDArray[np.bool_]:
    """Return which letters begin a word, shape (n,)."""
    is_letter = letters > _SPACE
    found = is_letter.copy()
    found[1:] &= ~is_letter[:-1]
    return found


def word_stops(letters: NDArray[np.uint8]) -> NDArray[np.int64]:
    """Return where the words of a text end, shape (m,)."""
    is_letter = letters > _SPACE
    is_letter[:-1] &= ~is_letter[1:]
    return np.flatnonzero(is_letter) + 1


def count_words(letters: NDArray[np.uint8], start: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return how many words are in each line, shape (k,), of lines that follow each other."""
    if not len(start):
        return np.zeros(0, np.int64)
    return np.add.reduceat(word_starts(letters), start, dtype=np.int64)


def numbers(letters: NDArray[np.uint8] | bytes, dtype: DTypeLike, n_expected: int) -> NDArray[Any]:
    """Return the numbers of a text, shape (n_expected,).

    Raises
    ------
    FileError
        If a word is no number, or there are more or fewer.
    """
    text = bytes(letters)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # of texts that are not understood to the end
        try:
            found = np.fromstring(text, dtype, sep=" ") if text.strip() else np.zeros(0, dtype)
        except ValueError:  # of newer versions of NumPy, for the same texts
            found = np.zeros(0, dtype)
    if len(found) == n_expected:
        return found
    for word in text.split():
        try:
            _ = float(word) if np.dtype(dtype).kind == "f" else int(word)
        except ValueError:
            raise FileError(f"{shown(word)} stands where a number should be.") from None
    found = np.array(text.split(), dtype) if len(text.split()) == n_expected else found
    if len(found) == n_expected:  # Python reads more spellings than NumPy
        return found
    raise FileError(f"There are {len(found)} numbers where {n_expected} should be; the file is damaged.")


def shown(words: bytes) -> str:
    """Return a piece of a file as an error shows it."""
    text = words[:SHOWN].decode("utf-8", "replace")
    return "‘" + "".join(letter if letter.isprintable() else "?" for letter in text) + "’"


def replaced(
    letters: NDArray[np.uint8],
    start: NDArray[np.int64],
    stop: NDArray[np.int64],
    new: NDArray[np.uint8],
    lengths: NDArray[np.int64],
) -> NDArray[np.uint8]:
    """Return a text with some words replaced.

    Parameters
    ----------
    letters : ndarray, shape (n,), uint8
        The text.
    start, stop : ndarray, shape (m,), int64
        Where each word begins and ends, ascending.
    new : ndarray, uint8
        The new words, one after the other.
    lengths : ndarray, shape (m,), int64
        The length of each.
    """
    is_kept = outside(len(letters), start, stop)
    grown = np.cumsum(lengths - (stop - start))
    new_stop = stop + grown
    n_new = len(letters) + int(grown[-1] if len(grown) else 0)
    result = np.empty(n_new, np.uint8)
    is_old = outside(n_new, new_stop - lengths, new_stop)
    result[is_old] = letters[is_kept]
    result[~is_old] = new
    return result


def outside(n: int, start: NDArray[np.int64], stop: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Return which of n places are in none of some stretches that do not overlap."""
    step = np.zeros(n + 1, np.int8)
    step[start] = 1
    step[stop] -= 1
    return np.cumsum(step[:-1], dtype=np.int8) == 0
