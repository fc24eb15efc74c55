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


def find_wide(quantiles: NDArray[np.float32]) -> NDArray[np.bool_]:
    """Return which rows of quantiles, shape (n, N_GLOBAL), are of wide noise, shape (n,); see `Features`."""
    arrays = _load()
    rows = (quantiles - arrays["mean"]) / arrays["scale"]
    hidden = np.tanh(rows @ arrays["enter"] + arrays["enter_bias"])
    result: NDArray[np.bool_] = hidden @ arrays["leave"] > arrays["least"]
    return result


@cache
def _load() -> dict[str, NDArray[np.float32]]:
    """Read the arrays that come with Framelet."""
    with np.load(ARRAYS) as file:
        return {name: file[name] for name in file.files if file[name].dtype.kind == "f"}
