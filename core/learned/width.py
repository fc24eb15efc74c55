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

LEAST_FACES = 2000
"""Faces of an island below which its noise counts as fine: quantiles of few faces hang on single ones."""

UNSURE = np.float32(0.02)
"""Gain up to which both nets have a share, so that rounding decides nothing."""


def wide_share(quantiles: NDArray[np.float32], n_faces: NDArray[np.intp]) -> NDArray[np.float32]:
    """Return the share of the net for wide noise, shape (I,), from 0 to 1.

    `quantiles`, shape (I, N_GLOBAL), are those of `Features`, and `n_faces`, shape (I,), of how many faces.
    """
    arrays = _load()
    gain = terms(quantiles, arrays["mean"], arrays["scale"]) @ arrays["weights"]
    share: NDArray[np.float32] = np.clip(np.float32(0.5) + gain / (2 * UNSURE), 0, 1)
    share[n_faces < LEAST_FACES] = 0
    return share


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
