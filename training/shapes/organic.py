# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Creature-like bodies: level sets of rounded limbs that melt into each other."""

from __future__ import annotations

import numpy as np
from skimage.measure import marching_cubes

from .mesh import Mesh, from_faces, largest_island, mean_edge, select_faces, vertex_normals
from .noise import Noise, chance, log_uniform, random_rotation
from .relief import with_relief
from .resampling import decimated, graded, isotropic, refined_in_parts


class Field:
    """A smooth signed distance-like function, negative inside.

    Attributes
    ----------
    pieces : list of tuple
        ``("cone", a, b, radius_a, radius_b)`` or ``("ball", center, rotation, radii)``.
    cuts : list of tuple
        The same, taken away.
    blend : float
        Width over which pieces melt into each other.
    """

    def __init__(self):
        self.pieces = []
        self.cuts = []
        self.blend = 0.1
        self.cut_blend = 0.05

    def cone(self, a, b, radius_a, radius_b):
        """Add a limb."""
        self.pieces.append(("cone", np.asarray(a, float), np.asarray(b, float), radius_a, radius_b))

    def ball(self, center, radii, rotation=None):
        """Add an ellipsoid."""
        rotation = np.eye(3) if rotation is None else rotation
        self.pieces.append(("ball", np.asarray(center, float), rotation, np.asarray(radii, float)))

    def mirrored(self):
        """Repeat all pieces on the other side of x = 0."""
        flip = np.array([-1.0, 1, 1])
        for many in (self.pieces, self.cuts):
            for piece in list(many):
                if piece[0] == "cone":
                    twin = ("cone", piece[1] * flip, piece[2] * flip, *piece[3:])
                    middle = abs(piece[1][0]) + abs(piece[2][0])
                else:
                    twin = ("ball", piece[1] * flip, flip[:, None] * piece[2] * flip, piece[3])
                    middle = abs(piece[1][0])
                if middle > 1e-9:
                    many.append(twin)

    def bounds(self):
        """Return a box around everything."""
        low, high = np.full(3, np.inf), np.full(3, -np.inf)
        for piece in self.pieces:
            ends = (
                [(piece[1], piece[3]), (piece[2], piece[4])]
                if piece[0] == "cone"
                else [(piece[1], piece[3].max())]
            )
            for center, radius in ends:
                low, high = np.minimum(low, center - radius), np.maximum(high, center + radius)
        return low - self.blend * 0.3, high + self.blend * 0.3

    def __call__(self, points):
        """Evaluate at points (N, 3)."""
        total = None
        for piece in self.pieces:
            value = _distance(piece, points)
            total = value if total is None else _smooth_minimum(total, value, self.blend)
        for piece in self.cuts:
            total = -_smooth_minimum(-total, _distance(piece, points), self.cut_blend)
        return total


def _distance(piece, points):
    kind = points.dtype
    if piece[0] == "cone":
        _, a, b, radius_a, radius_b = piece
        axis = (b - a).astype(kind)
        away = points - a.astype(kind)
        t = np.clip(away @ axis / max(float(axis @ axis), 1e-12), 0, 1)
        # A smooth course of the radius leaves no ring where the limb begins.
        return np.sqrt(((away - t[:, None] * axis) ** 2).sum(1)) - (
            radius_a + (radius_b - radius_a) * t * t * (3 - 2 * t)
        )
    _, center, rotation, radii = piece
    local = (points - center.astype(kind)) @ rotation.astype(kind)
    scaled = local / radii.astype(kind)
    first = np.sqrt((scaled**2).sum(1))
    second = np.sqrt(((scaled / radii.astype(kind)) ** 2).sum(1))
    return first * (first - 1) / np.maximum(second, 1e-9)


def _smooth_minimum(a, b, blend):
    h = np.maximum(blend - np.abs(a - b), 0) / blend
    return np.minimum(a, b) - h * h * h * (blend / 6)


def _limb(rng, field, start, direction, length, radius, joints=2):
    """Add a chain of bones that bends at each joint; return its end and last direction."""
    point = np.asarray(start, float)
    for _ in range(joints):
        direction = direction + rng.normal(size=3) * 0.35
        direction = direction / np.linalg.norm(direction)
        end = point + direction * length / joints
        thin = radius * rng.uniform(0.55, 1.0)
        field.cone(point, end, radius, thin)
        point, radius = end, thin
    return point, direction, radius


def creature(rng) -> Field:
    """Make an animal: trunk, legs, tail, neck, head with ears, horns, eyes and a mouth."""
    field = Field()
    field.blend = rng.uniform(0.06, 0.2)
    field.cut_blend = rng.uniform(0.02, 0.08)
    n = int(rng.integers(2, 5))
    spine = np.zeros((n, 3))
    spine[:, 1] = np.linspace(-0.7, 0.7, n)
    spine[:, 2] = rng.uniform(-0.25, 0.25, n)
    thick = rng.uniform(0.22, 0.5, n)
    for k in range(n - 1):
        field.cone(spine[k], spine[k + 1], thick[k], thick[k + 1])
    field.ball([0, rng.uniform(-0.4, 0.4), rng.uniform(-0.2, 0.1)], rng.uniform(0.25, 0.6, 3))
    for k in (0, n - 1)[: rng.integers(0, 3)]:
        start = spine[k] + np.array([thick[k] * 0.6, 0, 0])
        end, way, radius = _limb(
            rng, field, start, np.array([0.4, 0, -1]), rng.uniform(0.6, 1.1), rng.uniform(0.1, 0.22), 2
        )
        field.ball(end, rng.uniform(0.9, 1.8, 3) * radius, random_rotation(rng))
        for _ in range(rng.integers(0, 4)):
            _limb(rng, field, end, way + 0.7 * rng.normal(size=3), 0.25, radius * 0.45, 1)
    if chance(rng, 0.6):
        _limb(rng, field, spine[0] * [0, 1, 1], np.array([0, -1, 0.3]), rng.uniform(0.3, 1.2), 0.13, 3)
    head, way, _ = _limb(rng, field, spine[-1], np.array([0, 0.7, 0.8]), rng.uniform(0.2, 0.9), 0.2, 2)
    head[0] = 0
    size = rng.uniform(0.2, 0.42)
    field.ball(head, size * rng.uniform(0.8, 1.2, 3))
    snout = head + np.array([0, size * rng.uniform(0.7, 1.3), -size * rng.uniform(0, 0.4)])
    field.ball(snout, size * rng.uniform(0.3, 0.7, 3))
    if chance(rng, 0.8):
        ear = head + size * np.array([0.6, -0.1, 0.7])
        shape = size * np.array([rng.uniform(0.3, 0.8), rng.uniform(0.08, 0.2), rng.uniform(0.4, 1.1)])
        field.ball(
            ear + np.array([0, 0, shape[2] * 0.5]), shape, random_rotation(rng) if chance(rng, 0.4) else None
        )
        if chance(rng, 0.6):
            field.cuts.append(("ball", ear + np.array([0, shape[1], shape[2] * 0.5]), np.eye(3), shape * 0.6))
    if chance(rng, 0.4):
        _limb(
            rng,
            field,
            head + size * np.array([0.4, 0, 0.8]),
            np.array([0.3, 0, 1]),
            size * 1.5,
            size * 0.18,
            3,
        )
    eye = head + size * np.array([0.45, 0.75, 0.35])
    if chance(rng, 0.7):
        field.cuts.append(("ball", eye, np.eye(3), np.full(3, size * 0.22)))
    if chance(rng, 0.6):
        mouth = snout + np.array([0, size * 0.45, -size * 0.2])
        field.cuts.append(("ball", mouth, np.eye(3), size * np.array([0.5, 0.5, rng.uniform(0.04, 0.12)])))
    field.mirrored()
    return field


def blob(rng) -> Field:
    """Make a heap of ellipsoids and limbs without plan: pebbles, corals, roots, fruits."""
    field = Field()
    field.blend = log_uniform(rng, 0.02, 0.35)
    field.cut_blend = log_uniform(rng, 0.02, 0.1)
    center = np.zeros(3)
    for _ in range(rng.integers(1, 12)):
        if chance(rng, 0.55):
            radii = rng.uniform(0.2, 0.6, 3)
            field.ball(center, radii, random_rotation(rng))
            center = center + random_rotation(rng)[0] * radii.mean() * rng.uniform(0.6, 1.2)
        else:
            center, _, _ = _limb(
                rng, field, center, random_rotation(rng)[0], rng.uniform(0.3, 1.2), rng.uniform(0.08, 0.35)
            )
    for _ in range(rng.integers(0, 5)):
        piece = field.pieces[rng.integers(len(field.pieces))]
        place = piece[1] + rng.normal(size=3) * 0.3
        field.cuts.append(
            ("ball", place, random_rotation(rng), log_uniform(rng, 0.08, 0.4) * rng.uniform(0.3, 1, 3))
        )
    if chance(rng, 0.3):
        field.mirrored()
    return field


def bust(rng) -> Field:
    """Make a head on shoulders, with brow, nose, lips, ears and hair lumps."""
    field = Field()
    field.blend = rng.uniform(0.05, 0.14)
    field.cut_blend = rng.uniform(0.03, 0.08)
    field.ball([0, 0, 0.5], [rng.uniform(0.33, 0.42), rng.uniform(0.4, 0.5), rng.uniform(0.48, 0.6)])
    field.cone([0, -0.05, 0.2], [0, -0.12, -0.6], 0.2, 0.24)
    field.cone([0, -0.1, -0.75], [0.6, -0.15, -0.8], 0.3, rng.uniform(0.15, 0.25))
    field.ball([0, 0.3, 0.1], [0.2, 0.15, 0.14])
    field.cone([0, 0.42, 0.6], [0, 0.55, 0.4], 0.04, rng.uniform(0.06, 0.1))
    field.cone([0.07, 0.42, 0.68], [0.25, 0.36, 0.68], 0.05, 0.04)
    field.ball([0.08, 0.40, 0.22], [0.1, 0.06, rng.uniform(0.02, 0.05)])
    field.ball([0.4, -0.02, 0.5], [0.05, 0.1, rng.uniform(0.12, 0.2)])
    field.cuts.append(("ball", np.array([0.16, 0.43, 0.58]), np.eye(3), np.array([0.1, 0.07, 0.07])))
    for _ in range(rng.integers(0, 14)):
        way = random_rotation(rng)[0] * [1, 0.7, 1]
        way[1] = -abs(way[1]) if chance(rng, 0.7) else way[1]
        field.ball(
            np.array([0, -0.05, 0.6]) + way * 0.42, log_uniform(rng, 0.06, 0.25) * rng.uniform(0.5, 1, 3)
        )
    field.mirrored()
    field.ball([0.18, 0.39, 0.57], [0.05] * 3)
    field.ball([-0.18, 0.39, 0.57], [0.05] * 3)
    return field


def surface_of(field, low, high, resolution: int, spoil=None) -> Mesh:
    """Extract the zero level of a function in a box, of so many samples along the longest side.

    `spoil(values, step)` changes the samples first.
    """
    step = float((high - low).max()) / resolution
    axes = [
        np.arange(lo - 2 * step, hi + 2.5 * step, step, dtype=np.float32)
        for lo, hi in zip(low, high, strict=True)
    ]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), -1)
    value = field(grid.reshape(-1, 3)).reshape(grid.shape[:3]).astype(np.float32)
    if spoil is not None:
        value = spoil(value, step).astype(np.float32)
    points, faces, _, _ = marching_cubes(value, 0.0, allow_degenerate=False)
    return from_faces(points * step + [axis[0] for axis in axes], faces)


def project(field, mesh: Mesh, n_steps: int = 3) -> Mesh:
    """Move vertices onto the zero level, so that no ripple of the grid stays."""
    points = mesh.vertices
    edge = mean_edge(mesh)
    delta = 0.05 * edge
    for _ in range(n_steps):
        gradient = np.stack(
            [(field(points + delta * e) - field(points - delta * e)) / (2 * delta) for e in np.eye(3)], 1
        )
        step = field(points) / np.maximum((gradient**2).sum(1), 0.05)
        move = -step[:, None] * gradient
        length = np.linalg.norm(move, axis=1)
        points = points + move * np.minimum(1, 0.3 * edge / np.maximum(length, 1e-300))[:, None]
    return mesh.moved(points)


def random_field(rng) -> Field:
    """Draw a body of one of the kinds."""
    kind = rng.random()
    return creature(rng) if kind < 0.5 else blob(rng) if kind < 0.8 else bust(rng)


def smooth_body(rng, target: int, resolution: int | None = None) -> tuple[Mesh, Field]:
    """Make an isotropic mesh of a body without relief."""
    field = random_field(rng)
    mesh = largest_island(surface_of(field, *field.bounds(), resolution or int(rng.integers(56, 80))))
    mesh = isotropic(mesh, target, 180, 5)
    return project(field, mesh), field


def room_for_relief(field, mesh: Mesh):
    """Say how far the surface may move at each vertex: a share of how thick the body is there."""
    normal = vertex_normals(mesh)
    depth = np.full(len(mesh.vertices), 1e-3)
    for step in (0.01, 0.03, 0.06, 0.1, 0.16, 0.25):
        depth = np.maximum(depth, -field(mesh.vertices - step * normal))
    return 0.4 * depth


def make_organic(rng, target: int) -> Mesh:
    """Make a body with relief, meshed in one of several ways."""
    way = rng.choice(7, p=[0.42, 0.12, 0.14, 0.10, 0.10, 0.06, 0.06])
    fine = int(target * (2.2 if way in (1, 2) else 0.55 if way == 5 else 1))
    mesh, field = smooth_body(rng, fine)
    if way == 6:
        return mesh
    if way == 4:
        mesh = graded(rng, mesh, target, 180)
    if way == 5:
        mesh = refined_in_parts(rng, mesh, target)
    # On a fine mesh that is then coarsened the shortest waves are of the coarse edges.
    shortest = 4.5 if way in (1, 2) else 3.0
    mesh = with_relief(rng, mesh, int(rng.integers(2, 8)), shortest, room_for_relief(field, mesh))
    if way == 1:
        return isotropic(mesh, target, rng.choice([30.0, 60.0, 180.0]), 4)
    if way == 2:
        return decimated(mesh, target, rng.choice([0.0, 0.3, 0.6]))
    if way == 3:
        return isotropic(mesh, target, rng.choice([30.0, 60.0, 180.0]), 3)
    return mesh


def make_cutout(rng, target: int) -> Mesh:
    """Make a piece of a body of many more faces: there the surface bends little from face to face."""
    mesh = make_organic(rng, int(target * log_uniform(rng, 3, 9)))
    middle = mesh.vertices[mesh.corner_vertex.reshape(-1, 3)].mean(1)
    distance = np.linalg.norm(middle - middle[rng.integers(len(middle))], axis=1)
    is_near = distance <= np.sort(distance)[min(target, len(distance)) - 1]
    return largest_island(select_faces(mesh, is_near))


def bend(rng, mesh: Mesh, strength: float = 0.15) -> Mesh:
    """Bend a mesh by slow noise."""
    size = np.ptp(mesh.vertices, axis=0).max()
    noises = [Noise(rng) for _ in range(3)]
    points = mesh.vertices / size
    shift = np.stack([noise(points * rng.uniform(1, 2.5)) for noise in noises], 1)
    return mesh.moved(mesh.vertices + strength * size * shift)
