# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The paper's noise model, and how strong the noise of a mesh is."""

from .estimate import NoiseEstimate, estimate_noise
from .model import PAPER_SIGMA, add_noise

__all__ = ["PAPER_SIGMA", "NoiseEstimate", "add_noise", "estimate_noise"]
