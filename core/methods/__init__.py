# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Ways to move the vertices of a noisy surface: one file each, one signature."""

from collections.abc import Callable

from .bilateral import bilateral_filter
from .learned_shrinkage import shrink_normals
from .positions import shrink_positions
from .problem import Problem, Solution

METHODS: dict[str, Callable[[Problem], Solution]] = {
    "AUTO": shrink_normals,
    "POSITIONS": shrink_positions,
    "BILATERAL": bilateral_filter,
}
"""The methods by the names that settings have for them."""

__all__ = ["METHODS", "Problem", "Solution"]
