# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Many arrays that live long, in one piece of memory.

Small ones would lie between those that come and go, and keep their memory from going back to the system.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import prod

import numpy as np
from numpy.typing import DTypeLike, NDArray


def empty_parts(shapes: Sequence[tuple[int, ...]], dtype: DTypeLike) -> list[NDArray]:
    """Return arrays of given shapes, not yet filled, which lie in one array."""
    ends = np.cumsum([prod(shape) for shape in shapes], dtype=np.int64).tolist()
    everything = np.empty(ends[-1] if ends else 0, dtype)
    return [
        everything[end - prod(shape) : end].reshape(shape) for shape, end in zip(shapes, ends, strict=True)
    ]


def in_one_array(parts: Sequence[NDArray], dtype: DTypeLike) -> list[NDArray]:
    """Return copies of arrays that lie in one array."""
    copies = empty_parts([part.shape for part in parts], dtype)
    for copy, part in zip(copies, parts, strict=True):
        copy[...] = part
    return copies
