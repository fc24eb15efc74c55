# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Clean models made in code, where the shared meshes are missing, and for quick runs.

A sphere with bumps stands for organic models, because Blender's monkey would need the module bpy.
"""

import numpy as np
import sources  # noqa: F401
from framelet.core import SurfaceMesh
from made import box, bumpy_sphere, triangulated
from meshes import quad_torus, triangle_torus

FILLET = 0.3
"""Radius of the fillets of a cube from -1 to 1."""


def rounded_cube(n):
    """Return a cube of n x n quads a side with rounded edges and corners."""
    cube = box(n)
    core = np.clip(cube.vertices, FILLET - 1.0, 1.0 - FILLET)
    arm = cube.vertices - core
    return cube.with_vertices(core + FILLET * arm / np.linalg.norm(arm, axis=1, keepdims=True))


def gear(teeth=12, columns_per_tooth=14):
    """Return a gear with a hole, of quads: flat teeth, sharp edges, top and bottom."""
    columns = teeth * columns_per_tooth
    angle = np.arange(columns) * (2 * np.pi / columns)
    outer = 1.0 + 0.12 * np.clip(2.5 * np.sin(teeth * angle + 0.1), -1.0, 1.0)
    flat, wall = 12, 6
    # Around a cut through the rim: up the hole, outwards, down the teeth, inwards.
    rise, run = np.arange(wall) / wall, np.arange(flat) / flat
    across = np.concatenate((np.zeros(wall), run, np.ones(wall), 1 - run))
    height = np.concatenate((rise, np.ones(flat), 1 - rise, np.zeros(flat)))
    radius = 0.5 + across[:, None] * (outer[None, :] - 0.5)
    z = np.repeat(0.3 * height, columns).reshape(radius.shape)
    points = np.stack((radius * np.cos(angle), radius * np.sin(angle), z), -1).reshape(-1, 3)
    rows = len(across)
    number = np.arange(rows * columns).reshape(rows, columns)
    down, right = np.roll(number, -1, axis=0), np.roll(number, -1, axis=1)
    faces = np.stack((number, down, np.roll(down, -1, axis=1), right), -1).reshape(-1, 4)
    return SurfaceMesh.from_faces(points, faces)


MADE = {
    "made/rounded_cube_tri": lambda: triangulated(rounded_cube(24)),
    "made/gear_tri": lambda: triangulated(gear()),
    "made/torus_tri": lambda: triangle_torus(40, 80),
    "made/blob_tri": lambda: triangulated(bumpy_sphere(24)),
    "made/rounded_cube_quad": lambda: rounded_cube(24),
    "made/gear_quad": gear,
    "made/torus_quad": lambda: quad_torus(40, 80),
    "made/blob_quad": lambda: bumpy_sphere(24),
}
"""Builders of models by name."""

QUICK = {
    "made/small_cube_tri": lambda: triangulated(rounded_cube(10)),
    "made/small_cube_quad": lambda: rounded_cube(10),
}
"""Small models for quick runs."""
