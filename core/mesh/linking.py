# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Groups of items that are linked in pairs."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def linked_groups(n_items: int, first: NDArray[np.integer], second: NDArray[np.integer]) -> NDArray[np.int64]:
    """Return the lowest item that each item is linked to, directly or through others, shape (n,), int64.

    Parameters
    ----------
    n_items : int
        Number of items.
    first, second : ndarray, shape (p,), int
        Pairs of linked items.
    """
    label = np.arange(n_items)
    while True:
        lower = np.minimum(label[first], label[second])
        following = label.copy()
        np.minimum.at(following, label[first], lower)
        np.minimum.at(following, label[second], lower)
        following = following[following]
        if np.array_equal(following, label):
            return label
        label = following
