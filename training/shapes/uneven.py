# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Uneven sampling: graded edges, needles, vertices of high valence, stretched triangles."""

from __future__ import annotations

import numpy as np

from .mesh import Mesh
from .noise import chance, log_uniform, random_rotation
from .organic import smooth_body
from .parts import solid_part, to_mesh
from .relief import with_relief
from .resampling import decimated, graded, isotropic, refined_in_parts, with_hubs


def _stretched(rng, mesh: Mesh, target: int, angle: float) -> Mesh:
    """Remesh in a stretched space, so that all triangles are long in one direction."""
    turn = random_rotation(rng)
    stretch = turn @ np.diag([log_uniform(rng, 2, 6), 1, 1]) @ turn.T
    there = isotropic(mesh.moved(mesh.vertices @ stretch), target, angle)
    return there.moved(there.vertices @ np.linalg.inv(stretch))


def make_uneven(rng, target: int) -> Mesh:
    """Make a part or a body and sample it unevenly."""
    way = rng.integers(6)
    if chance(rng, 0.45):
        solid, edge = solid_part(rng, target)
        angle = 20.0
        if way == 0:
            # Fine first: the inversion bends long edges.
            return graded(
                rng, to_mesh(solid.refine_to_length(1.5 * edge)), target, angle, log_uniform(rng, 5, 30)
            )
        if way == 1:
            # Flat parts cost no error: there the collapse leaves needles and high valences.
            fine = to_mesh(solid.refine_to_length(0.8 * edge))
            return decimated(fine, max(4500, int(fine.n_faces * rng.uniform(0.2, 0.5))), 0.0)
        if way == 2:
            return refined_in_parts(rng, isotropic(to_mesh(solid), target // 3, angle), target)
        if way == 3:
            return _stretched(rng, to_mesh(solid), target, angle)
        if way == 4:
            fine = isotropic(to_mesh(solid), int(1.5 * target), angle)
            return with_hubs(rng, fine, int(log_uniform(rng, 5, 120)))
        # As the modeler leaves it: fans across faces, then split where edges are too long.
        return to_mesh(solid.refine_to_length(edge * rng.uniform(1.5, 2.2)))
    fine = int(target * (2.2 if way == 1 else 0.4 if way == 2 else 1.3))
    mesh, _ = smooth_body(rng, fine)
    if way == 0:
        mesh = graded(rng, mesh, target, 180, log_uniform(rng, 5, 30))
        return with_relief(rng, mesh, int(rng.integers(0, 4)), 5.0)
    if way == 1:
        mesh = with_relief(rng, mesh, int(rng.integers(1, 5)), 5.0)
        return decimated(mesh, target, rng.choice([0.0, 0.05]))
    if way == 2:
        mesh = refined_in_parts(rng, mesh, target)
        return with_relief(rng, mesh, int(rng.integers(0, 3)), 6.0)
    mesh = with_relief(rng, mesh, int(rng.integers(1, 4)), 4.0)
    if way == 3:
        return _stretched(rng, mesh, target, 180)
    if way == 4:
        return with_hubs(rng, mesh, int(log_uniform(rng, 5, 120)))
    return graded(rng, mesh, target, rng.choice([45.0, 180.0]), log_uniform(rng, 5, 30))
