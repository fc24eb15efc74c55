# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Weighted averages over neighbors, for neighborhoods of different sizes.

Fields have shape (n, C) here: an average is the product of a row of weights with gathered rows.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from .neighbors import Ragged

ITEMS_AT_ONCE = 4096
"""Items in a block, so that the gathered rows of a group stay in the cache."""


class Group(NamedTuple):
    """Items with the same number of members: their numbers (n,), and the members' (n, K)."""

    rows: NDArray[np.intp]
    members: NDArray[np.int32]


Weights = list[list[NDArray[np.floating]]]
"""A weight for each member, shape (n, K), of each group of each block."""


class Averages:
    """Neighborhoods, sorted by size within blocks.

    Parameters
    ----------
    around : callable
        `around(start, stop)` returns the members of the neighborhoods of a range of items.
    n_items : int
        Number of items.
    blocks : Blocks
        Threads to work on.
    """

    def __init__(self, around: Callable[[int, int], Ragged], n_items: int, blocks: Blocks) -> None:
        self._blocks = blocks.sized(ITEMS_AT_ONCE)
        self._n = n_items

        def kernel(start: int, stop: int) -> list[Group]:
            offset, items = around(start, stop)
            counts = np.diff(offset)
            groups = []
            for count in np.unique(counts[counts > 0]):
                rows = np.flatnonzero(counts == count)
                groups.append(Group(start + rows, items[offset[rows][:, None] + np.arange(count)]))
            return groups

        self._groups = self._blocks.run(kernel, n_items)

    def for_groups(self, function: Callable[..., NDArray[np.floating]], *given: Weights) -> Weights:
        """Return what a function makes of each group, and of what is given for it."""

        def kernel(start: int, _: int) -> list[NDArray[np.floating]]:
            index = start // self._blocks.block_size
            parts = zip(self._groups[index], *(item[index] for item in given), strict=True)
            return [function(*part) for part in parts]

        return self._blocks.run(kernel, self._n)

    def average(self, weights: Weights, field: NDArray[np.floating]) -> NDArray[np.floating]:
        """Return the averages, shape (n, C), of a field (n, C); items without members keep their value."""
        result = field.copy()

        def kernel(start: int, _: int) -> None:
            index = start // self._blocks.block_size
            for (rows, members), weight in zip(self._groups[index], weights[index], strict=True):
                result[rows] = np.matmul(weight[:, None], field.take(members, axis=0))[:, 0]

        self._blocks.run(kernel, self._n)
        return result
