# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The paper's noise model, how strong the noise of a mesh is, and steps, which are none."""

from .estimate import NoiseEstimate, estimate_noise
from .model import PAPER_SIGMA, add_noise
from .steps import ROUNDED, TERRACES, VOXELS, find_steps, rounding_noise

__all__ = [
    "PAPER_SIGMA",
    "ROUNDED",
    "TERRACES",
    "VOXELS",
    "NoiseEstimate",
    "add_noise",
    "estimate_noise",
    "find_steps",
    "rounding_noise",
]
