# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Memory for the temporaries of kernels, which is kept: fresh memory costs more than the arithmetic on it."""

from __future__ import annotations

import threading
from math import prod

import numpy as np
from numpy.typing import DTypeLike, NDArray


class Scratch(threading.local):
    """Arrays of a dtype by name, for each thread its own."""

    def __init__(self, dtype: DTypeLike = np.float32) -> None:
        self._dtype = np.dtype(dtype)
        self._arrays: dict[str, NDArray[np.floating]] = {}

    def __call__(self, name: str, *shape: int) -> NDArray[np.floating]:
        """Return an array with anything in it.

        It is the same memory each time that this thread asks for the name.
        """
        size = prod(shape)
        array = self._arrays.get(name)
        if array is None or len(array) < size:
            array = self._arrays[name] = np.empty(size, self._dtype)
        return array[:size].reshape(shape)
