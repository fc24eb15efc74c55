# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether noise is wide: shared by neighbors, as scanners and voxels make it, or new at each vertex.

Fine relief and wide noise look alike, and one net for both is too timid for the one or too bold for the
other. So there are two, and this says which one will be closer to the clean surface: a regression, learned
from runs of both, on the quantiles of energies over an island.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

ARRAYS = Path(__file__).with_name("width.npz")

CLIP = np.float32(3)
"""Standardized quantiles are cut off here: squares grow fast where nothing was seen."""


def find_wide(quantiles: NDArray[np.float32]) -> NDArray[np.bool_]:
    """Return which rows of quantiles, shape (I, N_GLOBAL), are of wide noise, shape (I,); see `Features`."""
    arrays = _load()
    gain = terms(quantiles, arrays["mean"], arrays["scale"]) @ arrays["weights"]
    result: NDArray[np.bool_] = gain > 0
    return result


def terms(
    quantiles: NDArray[np.float32], mean: NDArray[np.float32], scale: NDArray[np.float32]
) -> NDArray[np.float32]:
    """Return 1, standardized quantiles and their products, shape (I, 153), whose sum is the gain of wide."""
    rows = np.clip((quantiles - mean) / scale, -CLIP, CLIP)
    one, two = np.triu_indices(rows.shape[1])
    return np.concatenate((np.ones_like(rows[:, :1]), rows, rows[:, one] * rows[:, two]), axis=1)


@cache
def _load() -> dict[str, NDArray[np.float32]]:
    """Read the arrays that come with Framelet."""
    with np.load(ARRAYS) as file:
        return {name: file[name] for name in file.files if file[name].dtype.kind == "f"}
