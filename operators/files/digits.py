# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers as letters, by the million: with as many digits as those that they replace, or more."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .text import outside, word_starts

MOST_DIGITS = 15
"""So many digits are exact in double precision."""

_SPACE = 32
_FEW = 2**14  # numbers that are looked at together: the processor has room for them
_LEAST_POWER = -4  # of ten, that is written with a dot and zeros


@dataclass(frozen=True)
class NumberStyle:
    """How numbers are written: so many decimals, or so many digits in all with a power of ten."""

    is_fixed: bool
    digits: int


def style_for(words: NDArray[np.uint8], extent: float, largest: float, n_digits: int = 0) -> NumberStyle:
    """Return a style with as many digits as some numbers have, and as single precision around the middle has.

    Parameters
    ----------
    words : ndarray, shape (n,), uint8
        The numbers in the text, with spaces between them.
    extent : float
        Size of the surface.
    largest : float
        The largest coordinate.
    n_digits : int
        Least number of digits in all; 0 for what `extent` asks for.
    """
    step = max(extent, 1e-30) * 2.0**-24
    least = max(n_digits, int(np.ceil(np.log10(max(largest, step) / step))) + 1)
    lower = words | 0x20
    if n_digits or (lower == ord("e")).any():
        longest = _longest(words, (words >= 48) & (words <= 57))
        return NumberStyle(False, min(max(least, min(longest, 17)), 17))
    decimals = _longest_decimals(words)
    wanted = max(decimals, int(np.ceil(-np.log10(step))), 0)
    before = max(int(np.ceil(np.log10(max(largest, 1.0)))), 0) + 1
    if wanted + before > 17 and wanted > decimals:
        return NumberStyle(False, 17)
    return NumberStyle(True, wanted)


def style_of_words(
    letters: NDArray[np.uint8],
    start: NDArray[np.int64],
    stop: NDArray[np.int64],
    size: tuple[float, float],
    n_digits: int = 0,
) -> NumberStyle:
    """Return the style in which words that are coordinates are written again.

    Parameters
    ----------
    letters : ndarray, shape (n,), uint8
        The text.
    start, stop : ndarray, shape (m,), int64
        Where the words begin and end, ascending.
    size : tuple of float
        Size of the surface, and its largest coordinate; see `size_of`.
    n_digits : int
        Least number of digits in all; 0 for as many as single precision around the middle has.
    """
    is_word = ~outside(len(letters), start, stop)
    is_word[stop[stop < len(letters)]] = True  # the space behind each
    return style_for(letters[is_word], *size, n_digits)


def size_of(positions: NDArray[np.float64]) -> tuple[float, float]:
    """Return the longest side of the box around positions, and the largest coordinate."""
    finite = positions[np.isfinite(positions).all(axis=1)]
    if not len(finite):
        return 1.0, 1.0
    return float(np.ptp(finite, axis=0).max()), float(np.abs(finite).max())


def _longest(words: NDArray[np.uint8], is_counted: NDArray[np.bool_]) -> int:
    """Return the largest number of counted letters in a word."""
    start = np.flatnonzero(word_starts(words))
    return int(np.add.reduceat(is_counted, start, dtype=np.int64).max()) if len(start) else 0


def _longest_decimals(words: NDArray[np.uint8]) -> int:
    """Return the largest number of digits behind a dot."""
    dots = np.flatnonzero(words == ord("."))
    if not len(dots):
        return 0
    spaces = np.flatnonzero(words <= _SPACE)
    ends = np.append(spaces, len(words))[np.searchsorted(spaces, dots)]
    return int((ends - dots).max()) - 1


def as_text(values: NDArray[np.float64], style: NumberStyle) -> tuple[NDArray[np.uint8], NDArray[np.int64]]:
    """Return numbers, shape (m,), as letters one after the other, and the length of each."""
    if style.is_fixed and len(values):
        scaled = np.rint(np.abs(values) * 10.0**style.digits)
        if scaled.max() < 2.0**53:
            return _fixed(scaled.astype(np.uint64), np.signbit(values), style.digits)
    if not style.is_fixed and style.digits <= MOST_DIGITS and len(values):
        size = np.abs(values)
        is_plain = (size >= 10.0**_LEAST_POWER) & (size < 10.0 ** (style.digits - 1)) | (size == 0.0)
        letters, lengths = _significant(values[is_plain], style.digits)
        if is_plain.all():
            return letters, lengths
        others, other_lengths = _formatted(values[~is_plain], style)
        joined = np.empty(len(values), np.int64)
        joined[is_plain], joined[~is_plain] = lengths, other_lengths
        is_plain = np.repeat(is_plain, joined)
        result = np.empty(len(is_plain), np.uint8)
        result[is_plain], result[~is_plain] = letters, others
        return result, joined
    return _formatted(values, style)


def _formatted(
    values: NDArray[np.float64], style: NumberStyle
) -> tuple[NDArray[np.uint8], NDArray[np.int64]]:
    """Do the work of `as_text` for any numbers, one after the other."""
    form = b"%%.%d%s " % (style.digits, b"f" if style.is_fixed else b"g")
    text = np.frombuffer((form * len(values)) % tuple(values.tolist()), np.uint8)
    ends = np.flatnonzero(text == _SPACE)
    return text[text != _SPACE], np.diff(np.concatenate(([-1], ends))) - 1


def _significant(values: NDArray[np.float64], n_digits: int) -> tuple[NDArray[np.uint8], NDArray[np.int64]]:
    """Return numbers as `%g` writes them, as letters; none of them needs a power of ten."""
    pieces = [
        _significant_block(values[begin : begin + _FEW], n_digits) for begin in range(0, len(values), _FEW)
    ]
    if not pieces:
        return np.zeros(0, np.uint8), np.zeros(0, np.int64)
    return np.concatenate([each[0] for each in pieces]), np.concatenate([each[1] for each in pieces])


def _significant_block(
    values: NDArray[np.float64], n_digits: int
) -> tuple[NDArray[np.uint8], NDArray[np.int64]]:
    size = np.abs(values)
    power = np.floor(np.log10(np.where(size > 0.0, size, 1.0))).astype(np.int64)
    whole = np.rint(size * 10.0 ** (n_digits - 1 - power))
    # What was rounded up to the next power of ten, or taken for it by the logarithm.
    for is_off, step in (
        (whole >= 10.0**n_digits, 1),
        ((whole < 10.0 ** (n_digits - 1)) & (size > 0.0), -1),
    ):
        power[is_off] += step
        whole[is_off] = np.rint(size[is_off] * 10.0 ** (n_digits - 1 - power[is_off]))
    # Four zeros, then the digits; a dot goes behind the digit of the ones, wherever that is.
    n_rows = n_digits - _LEAST_POWER
    digits = np.full((n_rows, len(values)), ord("0"), np.uint8)
    ones = (power - _LEAST_POWER).astype(np.int8)
    last, rest = ones.copy(), whole.astype(np.uint64)
    for row in range(n_rows - 1, -_LEAST_POWER - 1, -1):
        tenth = rest // np.uint64(10)
        digits[row] = rest - tenth * np.uint64(10)
        np.maximum(last, row, out=last, where=digits[row] > 0)
        digits[row] += ord("0")
        rest = tenth
    last += last > ones
    first = np.minimum(ones, -_LEAST_POWER) - np.signbit(values)
    letters, is_used = (
        np.empty((n_rows + 2, len(values)), np.uint8),
        np.empty((n_rows + 2, len(values)), bool),
    )
    for place in range(-1, n_rows + 1):  # -1 is for a sign
        row = letters[place + 1]
        row[:] = digits[min(max(place - 1, 0), n_rows - 1)]
        np.copyto(row, digits[min(max(place, 0), n_rows - 1)], where=place <= ones)
        row[place == ones + 1] = ord(".")
        is_used[place + 1] = (first <= place) & (place <= last)
        row[(first == place) & np.signbit(values)] = ord("-")
    used = np.ascontiguousarray(is_used.T)
    return np.ascontiguousarray(letters.T)[used], last.astype(np.int64) - first + 1


def _fixed(
    scaled: NDArray[np.uint64], is_negative: NDArray[np.bool_], decimals: int
) -> tuple[NDArray[np.uint8], NDArray[np.int64]]:
    """Return whole numbers as letters with a dot before the last `decimals` digits."""
    n_digits = max(len(str(int(scaled.max()))), decimals + 1)
    width = 1 + n_digits + (decimals > 0)
    letters = np.empty((len(scaled), width), np.uint8)
    column, rest = width - 1, scaled
    n_used = np.full(len(scaled), decimals + 1 + (decimals > 0), np.int64)
    for place in range(n_digits):
        if decimals and place == decimals:
            letters[:, column] = ord(".")
            column -= 1
        quotient = rest // np.uint64(10)
        letters[:, column] = (rest - quotient * np.uint64(10)).astype(np.uint8) + 48
        rest, column = quotient, column - 1
        if place >= decimals:
            n_used += rest > 0
    if is_negative.any():
        rows = np.flatnonzero(is_negative)
        letters[rows, width - 1 - n_used[rows]] = ord("-")
        n_used[rows] += 1
    is_used = np.arange(width) >= (width - n_used)[:, None]
    return letters[is_used], n_used
