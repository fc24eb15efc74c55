# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""The models of the page *Which preset for my mesh*, made in code."""

from itertools import pairwise

import bpy
import numpy as np
from framelet.core import SurfaceMesh
from meshes import copy_object, make_monkey


def surface_object(name: str, surface: SurfaceMesh) -> bpy.types.Object:
    """Return an object with the vertices and faces of a surface, hidden until it is rendered."""
    ends = surface.face_offset
    faces = [surface.corner_vertex[a:b].tolist() for a, b in pairwise(ends)]
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(surface.vertices.tolist(), [], faces)
    obj = bpy.data.objects.new(name, mesh)
    obj.hide_render = True
    bpy.context.scene.collection.objects.link(obj)
    return obj


def make_carved_monkey(name: str) -> bpy.types.Object:
    """Make the monkey with shallow grooves all over, as a sculptor would leave them: detail to be kept."""
    obj = copy_object(make_monkey("Smooth"), name)
    mesh = obj.data
    positions = np.array([vertex.co for vertex in mesh.vertices])
    normals = np.array([vertex.normal for vertex in mesh.vertices])
    wave = np.sin(64.0 * positions[:, 2] + 6.0 * np.sin(5.0 * positions[:, 0]))
    positions += (0.007 * np.tanh(2.0 * wave))[:, None] * normals
    mesh.attributes["position"].data.foreach_set("vector", positions.astype(np.float32).reshape(-1))
    mesh.update()
    return obj


def make_quad_monkey(name: str) -> bpy.types.Object:
    """Make the monkey as a subdivision surface of quads."""
    bpy.ops.mesh.primitive_monkey_add()
    source = bpy.context.object
    source.modifiers.new("Subdivision", "SUBSURF").levels = 3
    mesh = bpy.data.meshes.new_from_object(source.evaluated_get(bpy.context.evaluated_depsgraph_get()))
    bpy.data.objects.remove(source)
    obj = bpy.data.objects.new(name, mesh)
    obj.hide_render = True
    bpy.context.scene.collection.objects.link(obj)
    return obj


def bracket(n: int = 56) -> SurfaceMesh:
    """Return a machine part of quads: a ring with six flat teeth, sharp edges, a fillet-free hole."""
    columns = 6 * n // 2
    angle = np.arange(columns) * (2 * np.pi / columns)
    # A hexagon has flat sides; its distance to the center follows from the angle.
    outer = 0.95 / np.cos((angle + 0.01) % (np.pi / 3) - np.pi / 6)
    flat, wall = n // 4, n // 6
    rise, run = np.arange(wall) / wall, np.arange(flat) / flat
    across = np.concatenate((np.zeros(wall), run, np.ones(wall), 1 - run))
    height = np.concatenate((rise, np.ones(flat), 1 - rise, np.zeros(flat)))
    radius = 0.45 + across[:, None] * (outer[None, :] - 0.45)
    z = np.repeat(0.5 * height, columns).reshape(radius.shape)
    points = np.stack((radius * np.cos(angle), radius * np.sin(angle), z), -1).reshape(-1, 3)
    number = np.arange(len(across) * columns).reshape(len(across), columns)
    down, right = np.roll(number, -1, axis=0), np.roll(number, -1, axis=1)
    quads = np.stack((number, down, np.roll(down, -1, axis=1), right), -1).reshape(-1, 4)
    triangles = np.concatenate((quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]))
    turn = np.radians(62.0)
    matrix = np.array(
        [[1.0, 0.0, 0.0], [0.0, np.cos(turn), -np.sin(turn)], [0.0, np.sin(turn), np.cos(turn)]]
    )
    return SurfaceMesh.from_faces(points @ matrix.T, triangles)


def bone(resolution: int = 72, noise: float = 0.12, seed: int = 0) -> SurfaceMesh:
    """Return the surface of a bone in a noisy scan of voxels, such as a CT: triangles with steps."""
    axis = np.linspace(-1.45, 1.45, resolution)
    x, y, z = np.meshgrid(axis, axis, axis, indexing="ij")
    rng = np.random.default_rng(seed)
    along = np.clip(z, -0.75, 0.75)
    shaft = np.sqrt(x**2 + y**2 + (z - along) ** 2) - (0.26 + 0.12 * along**2)
    balls = [
        ((0.28, 0, 0.95), 0.36),
        ((-0.28, 0, 0.95), 0.36),
        ((0.3, 0, -0.95), 0.34),
        ((-0.3, 0, -0.95), 0.34),
    ]
    field = np.exp(-10.0 * shaft)
    for (cx, cy, cz), radius in balls:
        field += np.exp(-10.0 * (np.sqrt((x - cx) ** 2 + (y - cy) ** 2 + (z - cz) ** 2) - radius))
    distance = -np.log(field) / 10.0
    step = axis[1] - axis[0]
    # A voxel holds the share of it that is inside, and noise.
    volume = np.clip(0.5 - distance / (1.2 * step), 0.0, 1.0) + noise * rng.standard_normal(distance.shape)
    keep = (np.abs(distance) < 3 * step) | (distance < 0)
    volume = np.where(keep, np.where(distance < -3 * step, 1.0, volume), 0.0)
    return surface_net(volume - 0.5, axis[0], step)


def surface_net(volume: np.ndarray, origin: float, step: float) -> SurfaceMesh:
    """Return where a volume, shape (n, n, n), is zero: a vertex in each cell that the surface crosses."""
    n = len(volume)
    inside = volume > 0
    total = np.zeros((n - 1, n - 1, n - 1, 3))
    count = np.zeros((n - 1, n - 1, n - 1))
    corners = np.array([(i, j, k) for i in (0, 1) for j in (0, 1) for k in (0, 1)])

    def at(array: np.ndarray, corner: np.ndarray) -> np.ndarray:
        i, j, k = corner
        return array[i : n - 1 + i, j : n - 1 + j, k : n - 1 + k]

    for first in corners:
        for axis in range(3):
            if first[axis]:
                continue
            second = first + np.eye(3, dtype=int)[axis]
            a, b = at(volume, first), at(volume, second)
            crosses = at(inside, first) != at(inside, second)
            share = np.where(crosses, a / np.where(crosses, a - b, 1.0), 0.0)
            place = first + share[..., None] * (second - first)
            total += crosses[..., None] * place
            count += crosses
    used = count > 0
    cells = np.argwhere(used)
    number = np.full(used.shape, -1)
    number[used] = np.arange(len(cells))
    vertices = origin + step * (cells + total[used] / count[used][:, None])
    quads = []
    for axis in range(3):
        second, third = (axis + 1) % 3, (axis + 2) % 3
        low, high = [slice(None)] * 3, [slice(None)] * 3
        low[axis], high[axis] = slice(0, n - 1), slice(1, n)
        places = np.argwhere(inside[tuple(low)] != inside[tuple(high)])
        places = places[(places[:, second] > 0) & (places[:, third] > 0)]
        places = places[(places[:, second] < n - 1) & (places[:, third] < n - 1)]
        around = []
        for du, dv in ((-1, -1), (0, -1), (0, 0), (-1, 0)):
            cell = places.copy()
            cell[:, second] += du
            cell[:, third] += dv
            around.append(number[tuple(cell.T)])
        quad = np.stack(around, axis=1)
        is_out = inside[tuple(low)][tuple(places.T)]
        quad[~is_out] = quad[~is_out][:, ::-1]
        quads.append(quad)
    quads = np.concatenate(quads)
    return SurfaceMesh.from_faces(vertices, np.concatenate((quads[:, [0, 1, 2]], quads[:, [0, 2, 3]])))
