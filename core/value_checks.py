# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Sentences for single values that are of the wrong kind or out of range."""

from __future__ import annotations

import math
import sys
from collections.abc import Iterable
from numbers import Integral, Real
from typing import Any

from .errors import SettingError


def check_number(
    name: str, value: Any, minimum: float, maximum: float = math.inf, *, is_whole: bool = False
) -> None:
    """Raise SettingError unless a value is a number in a range; True and False are none.

    Examples
    --------
    >>> check_number("The seed", 1.5, 0, is_whole=True)
    Traceback (most recent call last):
    ...
    framelet.core.errors.SettingError: The seed is 1.5; it must be a whole number.
    """
    is_number = isinstance(value, Integral if is_whole else Real)
    if not is_number or type(value) is bool:
        raise SettingError(f"{name} is {value!r}; it must be a {'whole ' if is_whole else ''}number.")
    if minimum <= value <= maximum and value != math.inf:  # also refuses NaN
        return
    shown = "a huge number" if isinstance(value, int) and abs(value) > sys.float_info.max else f"{value:g}"
    ends = (
        f"a finite number, at least {minimum:g}"
        if maximum == math.inf
        else f"between {minimum:g} and {maximum:g}"
    )
    raise SettingError(f"{name} is {shown}; it must be {ends}.")


def check_choice(name: str, value: Any, choices: Iterable[str]) -> None:
    """Raise SettingError unless a value is one of some words."""
    words = list(choices)
    if not isinstance(value, str) or value not in words:
        raise SettingError(f"{name} is {value!r}; choose one of {', '.join(words)}.")
