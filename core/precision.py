# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Arrays that are given, and the precision that kernels work in."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from .errors import FrameletError, SettingError
from .value_checks import shown


def as_precision(dtype: DTypeLike) -> np.dtype[Any]:
    """Return the precision that a kernel is to work in.

    Raises
    ------
    SettingError
        Unless it is single or double precision: in others results overflow, or are whole numbers.

    Examples
    --------
    >>> as_precision("f4")
    dtype('float32')
    >>> as_precision(int)
    Traceback (most recent call last):
    ...
    framelet.core.errors.SettingError: The dtype is <class 'int'>; choose float32 or float64.
    """
    try:
        precision = np.dtype(dtype)
    except (TypeError, ValueError):
        precision = None
    if precision not in (np.float32, np.float64):
        raise SettingError(f"The dtype is {shown(dtype)}; choose float32 or float64.")
    return precision


def as_array(name: str, value: ArrayLike, error: type[FrameletError] = SettingError) -> NDArray[Any]:
    """Return an array; raise an error if a value is none, as where rows differ in length.

    Examples
    --------
    >>> as_array("The weights", [[1], [1, 2]])
    Traceback (most recent call last):
    ...
    framelet.core.errors.SettingError: The weights are [[1], [1, 2]]; give an array.
    """
    try:
        return np.asarray(value)
    except (ValueError, TypeError) as problem:
        raise error(f"{name} are {shown(value)}; give an array.") from problem
