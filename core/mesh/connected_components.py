# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Connected components of items that are linked in pairs."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def connected_components(
    n_items: int, first: NDArray[np.integer], second: NDArray[np.integer]
) -> NDArray[np.int32]:
    """Return the lowest item that each item is linked to, directly or through others, shape (n,), int32.

    `first` and `second`, shape (p,), are the pairs. Each item points to a lower one of its component. In a
    round every item points to where the item that it points to points, and a component that touches a lower
    one is hooked onto it.

    Examples
    --------
    >>> connected_components(5, np.array([4, 2]), np.array([2, 1])).tolist()
    [0, 1, 1, 3, 1]
    """
    label = np.arange(n_items, dtype=np.int32)
    while len(first):
        low, high = label.take(first), label.take(second)
        apart = np.flatnonzero(low != high)
        if not len(apart):
            break
        first, second, low, high = first[apart], second[apart], low[apart], high[apart]
        # The lowest of those that ask: else a star would be joined by one of its arms in a round.
        np.minimum.at(label, np.maximum(low, high), np.minimum(low, high))
        while True:
            above = label.take(label)
            if np.array_equal(above, label):
                break
            label = above
    return label
