# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The paper's noise model, how strong the noise of a mesh is, and steps, which are none."""

from .estimate import NoiseEstimate, estimate_noise
from .model import PAPER_SIGMA, add_noise
from .steps import TERRACES, VOXELS, find_steps

__all__ = ["PAPER_SIGMA", "TERRACES", "VOXELS", "NoiseEstimate", "add_noise", "estimate_noise", "find_steps"]
