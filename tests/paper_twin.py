# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The paper's algorithms on closed meshes of triangles or of quads, without code of the package.

Masks are typed from (3.5) and (5.1), points under them follow sections 3.1 and 4.2, the iteration is (4.10).
"""

from types import SimpleNamespace

import numpy as np
from meshes import faces_of
from twins import completed_ring, fans, split_bregman, straight_pairs

ROOT_2, ROOT_3, ROOT_6 = np.sqrt([2.0, 3.0, 6.0])
BOX_SPLINE = (
    np.array(
        [
            (2, 1, 1, 1, 1, 1, 1),
            (2, -1, -1, 1, -1, -1, 1),
            (2, 1, -1, -1, 1, -1, -1),
            (2, -1, 1, -1, -1, 1, -1),
            2 * ROOT_3 / 3 * np.array((0, -1, -1, -1, 1, 1, 1)),
            ROOT_6 / 3 * np.array((0, 1, 1, -2, -1, -1, 2)),
            ROOT_2 * np.array((0, 1, -1, 0, -1, 1, 0)),
        ]
    )
    / 8
)
HAT = (np.array((1, 2, 1)) / 4, ROOT_2 * np.array((1, 0, -1)) / 4, np.array((-1, 2, -1)) / 4)
AROUND = ((1, 1), (1, 0), (0, 0), (0, 1), (0, 2), (1, 2), (2, 2), (2, 1), (2, 0))
"""Places of the 3x3 mask: the vertex, then once around, edge neighbors and corners in turn."""

LINEAR_SPLINE = np.array([[np.outer(a, b)[place] for place in AROUND] for a in HAT for b in HAT])


def denoised(points, mesh, stencil, shrinkage, lambda_, mu, delta, iterations):
    """Return the positions, shape (N, 3), after the iteration; lambda in the unit of the positions."""
    is_quads = len(faces_of(mesh)[0]) == 4
    rings = [fan[0] for fan in fans(mesh)]
    weights = quad_weights(mesh, rings) if is_quads else triangle_weights(points, rings, stencil)
    bank = SimpleNamespace(masks=LINEAR_SPLINE if is_quads else BOX_SPLINE)
    settings = SimpleNamespace(
        shrinkage=shrinkage, lambda_=lambda_, mu=mu, delta=delta, iterations=iterations
    )
    return split_bregman(points, lambda s: np.einsum("tnv,vc->tnc", weights, s), bank, settings)


def triangle_weights(points, rings, stencil):
    """Return which points lie under the 7 taps, as weights of the vertices, shape (7, N, N)."""
    n = len(rings)
    weights, unit = np.zeros((7, n, n)), np.eye(n)
    weights[0] = unit
    for v, ring in enumerate(rings):
        if len(ring) == 6:
            six = unit[ring]
        elif stencil == "MEAN":
            six = np.repeat(unit[ring].mean(axis=0)[None], 6, axis=0)
        elif len(ring) < 5:
            # The midpoints are told by the positions, and taken as weights of their two ends.
            places = np.array(completed_ring(points, ring))
            ends = [(a, b) for a in ring for b in ring]
            middles = np.array([0.5 * (points[a] + points[b]) for a, b in ends])
            found = [ends[np.abs(middles - place).sum(axis=1).argmin()] for place in places]
            six = np.array([0.5 * (unit[a] + unit[b]) for a, b in found])
        else:
            pairs = [sorted(pair) for pair in straight_pairs(points, v, ring)]
            six = unit[[pair[0] for pair in pairs] + [pair[1] for pair in pairs]]
        weights[1:, v] = six
    return weights


def quad_weights(mesh, rings):
    """Return which points lie under the 9 taps by the rule MEAN, as weights, shape (9, N, N)."""
    n = len(rings)
    weights, unit = np.zeros((9, n, n)), np.eye(n)
    weights[0] = unit
    faces = [set(face) for face in faces_of(mesh)]
    for v, ring in enumerate(rings):
        far = []
        for k, w in enumerate(ring):
            (face,) = [face for face in faces if {v, w, ring[(k + 1) % len(ring)]} <= face]
            far.append(next(iter(face - {v, w, ring[(k + 1) % len(ring)]})))
        near, far = unit[ring], unit[far]
        if len(ring) != 4:
            near, far = near.mean(axis=0), far.mean(axis=0)
        weights[1::2, v], weights[2::2, v] = near, far
    return weights
