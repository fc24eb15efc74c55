# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Several separate parts in one mesh, of different sizes and edge lengths."""

from __future__ import annotations

import numpy as np

from .mesh import Mesh, condition, flipped, joined, mean_edge, volume
from .noise import log_uniform, random_rotation
from .organic import make_organic
from .parts import make_part
from .plates import make_plate
from .quads import make_quads
from .shells import make_shell
from .sweeps import make_sweep


def make_islands(rng, target: int) -> Mesh:
    """Put two to five other shapes side by side."""
    n = int(rng.choice([2, 3, 4, 5], p=[0.4, 0.35, 0.15, 0.1]))
    share = rng.dirichlet(np.full(n, 2.0))
    makers = [make_part, make_organic, make_sweep, make_plate, make_shell, make_quads]
    placed, right = [], 0.0
    for k in range(n):
        maker = makers[rng.choice(6, p=[0.28, 0.27, 0.2, 0.1, 0.1, 0.05])]
        mesh = maker(rng, max(1200, int(share[k] * target)))
        if condition(mesh).border == 0 and volume(mesh) < 0:
            mesh = flipped(mesh)
        # Edges, not sizes, have the ratio that counts.
        scale = log_uniform(rng, 1, 10) / mean_edge(mesh)
        points = mesh.vertices @ random_rotation(rng).T * scale
        points = points - (points.max(0) + points.min(0)) / 2
        width = float(np.ptp(points[:, 0]))
        shift = [right + width / 2, rng.uniform(-0.3, 0.3) * width, rng.uniform(-0.3, 0.3) * width]
        points = points + np.array(shift)
        right += width * rng.uniform(1.03, 1.3)
        placed.append(mesh.moved(points))
    return joined(placed)
