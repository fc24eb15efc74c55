# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes of every kind and sizes of blocks, for tests of kernels against their definitions."""

import numpy as np
import pytest
from checks import wild_mesh
from framelet.core.blocks import Blocks
from meshes import MESHES, soup

ALONE = Blocks(1)
"""One thread, and one block for all meshes made in code."""

KINDS = {
    **{
        name: MESHES[name]
        for name in ("irregular torus", "quad torus", "mixed sheet", "prism", "three pages")
    },
    "border": MESHES["irregular grid"],
    "soup": lambda: soup(0, shortest=1),
    "empty faces": lambda: wild_mesh(np.eye(5, 3), [(), (0, 1, 2), (), (2, 4, 0), (3,), ()]),
}
KIND = pytest.mark.parametrize("kind", KINDS)
BLOCKS = pytest.mark.parametrize("blocks", [ALONE, Blocks(1, 7)], ids=["one block", "blocks"])
