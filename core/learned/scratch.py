# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Memory for the temporaries of kernels, which is kept: fresh memory costs more than the arithmetic on it."""

from __future__ import annotations

import threading

import numpy as np
from numpy.typing import NDArray


class Scratch(threading.local):
    """Arrays by name, for each thread its own."""

    def __init__(self) -> None:
        self._arrays: dict[str, NDArray[np.float32]] = {}

    def __call__(self, name: str, n_rows: int, n_columns: int) -> NDArray[np.float32]:
        """Return an array of shape (n_rows, n_columns), float32, with anything in it.

        It is the same memory each time that this thread asks for the name.
        """
        size = n_rows * n_columns
        array = self._arrays.get(name)
        if array is None or len(array) < size:
            array = self._arrays[name] = np.empty(size, np.float32)
        return array[:size].reshape(n_rows, n_columns)
