# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Sentences for single values that are of the wrong kind or out of range."""

from __future__ import annotations

import math
import sys
from collections.abc import Iterable
from numbers import Integral, Rational, Real
from typing import Any

from .errors import FrameletError, SettingError

LONGEST = 80
"""Letters of a value that a sentence shows."""


def shown(value: Any) -> str:
    """Return a value as a sentence shows it: in one line, and not all of what is long.

    Examples
    --------
    >>> shown("tri-3"), shown([[0.5]] * 99)
    ("'tri-3'", '[[0.5], [0.5], [0.5], [0.5], [0.5], [0.5], [0.5], [0.5], [0.5], [0.5], [0.5],...')
    """
    try:
        words = " ".join(repr(value).split())
    except ValueError:  # Python writes no whole number of thousands of digits
        words = "a huge number"
    return words if len(words) <= LONGEST else f"{words[: LONGEST - 3]}..."


def check_kind(
    name: str,
    value: Any,
    kinds: type | tuple[type, ...],
    wanted: str,
    error: type[FrameletError] = SettingError,
) -> None:
    """Raise an error unless a value is an instance of a type, or None, which is what was not given.

    Examples
    --------
    >>> check_kind("The memory", "1 GB", int, "bytes")
    Traceback (most recent call last):
    ...
    framelet.core.errors.SettingError: The memory is '1 GB'; give bytes.
    """
    if value is not None and not isinstance(value, kinds):
        raise error(f"{name} is {shown(value)}; give {wanted}.")


def check_callable(name: str, value: Any) -> None:
    """Raise SettingError unless a value can be called, or is None, which is what was not given."""
    if value is not None and not callable(value):
        raise SettingError(f"{name} is {shown(value)}; give a function.")


def check_number(
    name: str,
    value: Any,
    minimum: float,
    maximum: float = math.inf,
    *,
    is_whole: bool = False,
    error: type[FrameletError] = SettingError,
) -> None:
    """Raise an error unless a value is a number in a range; True and False are none.

    Examples
    --------
    >>> check_number("The seed", 1.5, 0, is_whole=True)
    Traceback (most recent call last):
    ...
    framelet.core.errors.SettingError: The seed is 1.5; it must be a whole number.
    """
    is_number = isinstance(value, Integral if is_whole else Real)
    if not is_number or type(value) is bool:
        raise error(f"{name} is {shown(value)}; it must be a {'whole ' if is_whole else ''}number.")
    # Whole numbers and fractions may be larger than any float.
    is_finite = is_whole or not isinstance(value, Rational) or value <= sys.float_info.max
    if minimum <= value <= maximum and value != math.inf and is_finite:  # also refuses NaN
        return
    number = "a huge number" if isinstance(value, int) and abs(value) > sys.float_info.max else f"{value:g}"
    ends = (
        f"a finite number, at least {minimum:g}"
        if maximum == math.inf
        else f"between {minimum:g} and {maximum:g}"
    )
    raise error(f"{name} is {number}; it must be {ends}.")


def check_choice(
    name: str, value: Any, choices: Iterable[str], error: type[FrameletError] = SettingError
) -> None:
    """Raise an error unless a value is one of some words."""
    words = list(choices)
    if not isinstance(value, str) or value not in words:
        raise error(f"{name} is {shown(value)}; choose one of {', '.join(words)}.")
