# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Plates and bodies with engraved or embossed strokes that look like writing, and with holes."""

from __future__ import annotations

import itertools

import numpy as np
from manifold3d import CrossSection, Manifold, OpType

from .mesh import Mesh, edge_lengths
from .noise import Noise, chance, log_uniform, smooth_step
from .parts import outline, to_mesh
from .relief import with_relief
from .resampling import decimated, edge_for, graded, isotropic


def _glyph(rng):
    """Draw segments of a sign within the unit square: (S, 2, 2)."""
    nodes = np.stack(np.meshgrid([0.1, 0.4, 0.7], [0.0, 0.33, 0.66, 1.0], indexing="ij"), -1).reshape(-1, 2)
    segments = []
    place = rng.integers(len(nodes))
    for _ in range(rng.integers(2, 6)):
        near = np.flatnonzero(np.abs(nodes - nodes[place]).sum(1) < 0.75)
        following = rng.choice(near[near != place])
        segments.append([nodes[place], nodes[following]])
        place = following if chance(rng, 0.8) else rng.integers(len(nodes))
    if chance(rng, 0.4):
        start = rng.uniform(0, 6)
        angle = np.linspace(start, start + rng.uniform(2.5, 2 * np.pi), 14)
        arc = rng.choice([0.4, 0.5]) + 0.25 * np.stack([np.cos(angle), np.sin(angle)], 1)
        segments += [[a, b] for a, b in itertools.pairwise(arc)]
    return np.array(segments)


def writing(rng, width: float, height: float):
    """Fill a centered rectangle with rows of signs: segments (S, 2, 2), and the size of a sign."""
    n_rows = int(rng.integers(1, 5))
    size = height / n_rows
    n_columns = max(1, int(width / (0.8 * size)))
    if n_columns * n_rows > 48:
        n_columns = 48 // n_rows
    segments = []
    for row in range(n_rows):
        for column in range(n_columns):
            if chance(rng, 0.88):
                corner = [(column - n_columns / 2) * 0.85, (row - n_rows / 2) + 0.12]
                segments.append((_glyph(rng) * [1, 0.76] + corner) * size)
    if not segments:
        segments.append((_glyph(rng) - 0.5) * size)
    return np.concatenate(segments), size


def _strokes(rng, segments, width: float) -> CrossSection:
    """Thicken segments into a plane figure with round or straight ends."""
    is_round = chance(rng, 0.6)
    pieces = []
    for a, b in segments:
        along = b - a
        length = float(np.linalg.norm(along))
        if is_round:
            dot = CrossSection.circle(width / 2, 24)
            pieces.append(CrossSection.batch_hull([dot.translate(list(a)), dot.translate(list(b))]))
        else:
            bar = CrossSection.square([length + width, width], True)
            bar = bar.rotate(float(np.degrees(np.arctan2(along[1], along[0]))))
            pieces.append(bar.translate(list((a + b) / 2)))
    return CrossSection.batch_boolean(pieces, OpType.Add)


def _wrapped(rng, mesh: Mesh, half: float) -> Mesh:
    """Lay a flat plate, ``half`` as wide as long, onto a cylinder or a sphere."""
    x, y, z = mesh.vertices.T
    kind = rng.integers(4)
    if kind == 0:
        return mesh
    radius = half / rng.uniform(0.3, 2.9 if kind < 3 else 1.2)
    if kind < 3:
        angle, far = x / radius, radius + z
        return mesh.moved(np.stack([far * np.sin(angle), y, far * np.cos(angle)], 1))
    # Polar distance kept: strokes on a dome hardly change their widths.
    distance = np.hypot(x, y)
    angle, far = distance / radius, radius + z
    share = np.where(distance > 1e-12, np.sin(angle) / np.maximum(distance, 1e-12), 1 / radius)
    return mesh.moved(np.stack([far * share * x, far * share * y, far * np.cos(angle)], 1))


def _carved(rng, target: int) -> Mesh:
    """Cut or raise strokes with sharp walls."""
    half_x, half_y = 1.0, rng.uniform(0.4, 1.0)
    thick = log_uniform(rng, 0.06, 0.4)
    if chance(rng, 0.6):
        figure = CrossSection.square([2 * half_x, 2 * half_y], True)
        if chance(rng, 0.5):
            radius = rng.uniform(0.05, 0.3)
            figure = figure.offset(-radius).offset(radius, circular_segments=64)
    else:
        figure = outline(rng)
    plate = Manifold.extrude(figure, thick).translate([0, 0, -thick])
    edge = edge_for(plate.surface_area() * 1.15, target)
    segments, size = writing(rng, 1.6 * half_x, 1.5 * half_y)
    width = max(1.2 * edge, size * rng.uniform(0.07, 0.2))
    depth = log_uniform(rng, 0.5, 6) * edge
    strokes = _strokes(rng, segments, width) ^ figure
    if chance(rng, 0.5):
        depth = min(depth, 0.7 * thick)
        plate = plate - Manifold.extrude(strokes, depth + 0.2).translate([0, 0, -depth])
    else:
        plate = plate + Manifold.extrude(strokes, depth + thick / 2).translate([0, 0, -thick / 2])
    for _ in range(rng.integers(0, 5)):
        place = rng.uniform(-0.9, 0.9, 2) * [half_x, half_y]
        hole = Manifold.cylinder(4, log_uniform(rng, 1.5 * edge, 0.15), -1, int(rng.integers(16, 96)), True)
        plate = plate - hole.translate([*place, 0])
    if chance(rng, 0.4):
        # A raised or sunken frame.
        border = figure.offset(-0.04) - figure.offset(-0.04 - log_uniform(rng, 1.5 * edge, 0.1))
        step = log_uniform(rng, 0.5, 4) * edge
        if chance(rng, 0.5):
            plate = plate + Manifold.extrude(border, step + 0.02).translate([0, 0, -0.02])
        else:
            plate = plate - Manifold.extrude(border, step + 0.5).translate([0, 0, -step])
    way = rng.choice(4, p=[0.55, 0.15, 0.15, 0.15])
    if way == 1:
        mesh = to_mesh(plate.refine_to_length(edge * 1.5))
    elif way == 2:
        mesh = decimated(isotropic(to_mesh(plate), 2 * target, 25, 4), target, rng.uniform(0.1, 0.5), True)
    else:
        mesh = isotropic(to_mesh(plate), target, 25)
    mesh = _wrapped(rng, mesh, half_x)
    return graded(rng, mesh, target, 25, rng.uniform(2, 4)) if way == 3 else mesh


def _segment_distance(points, segments):
    """Distance of plane points to the nearest segment."""
    best = np.full(len(points), np.inf)
    for a, b in segments:
        along = b - a
        t = np.clip((points - a) @ along / max(along @ along, 1e-12), 0, 1)
        best = np.minimum(best, np.hypot(*(points - a - t[:, None] * along).T))
    return best


def _pressed(rng, target: int) -> Mesh:
    """Press strokes with soft walls into a smooth body: coins, jars, seals, tiles."""
    kind = rng.integers(4)
    if kind == 0:
        solid = Manifold.cylinder(rng.uniform(0.8, 2), rng.uniform(0.5, 1), rng.uniform(0.5, 1), 200, True)
    elif kind == 1:
        solid = Manifold.sphere(1, 160).scale(list(rng.uniform(0.6, 1.2, 3)))
    elif kind == 2:
        solid = Manifold.cylinder(rng.uniform(0.1, 0.5), 1, -1, 200, True)
    else:
        solid = Manifold.cube([2, rng.uniform(0.8, 2), rng.uniform(0.1, 0.6)], True)
    mesh = isotropic(to_mesh(solid), target, 35)
    edge = float(edge_lengths(mesh).mean())
    points = mesh.vertices
    radius = np.hypot(points[:, 0], points[:, 1])
    if kind < 2:
        plane = np.stack([np.arctan2(points[:, 1], points[:, 0]), points[:, 2]], 1)
        outward = np.column_stack([points[:, :2] / np.maximum(radius, 1e-9)[:, None], 0 * radius])
        inside = radius > 0.35 if kind else radius > 0.98 * radius.max() * 0.5
    else:
        plane = points[:, :2]
        outward = np.tile([0.0, 0.0, 1.0], (len(points), 1))
        # Only the upper side, and not its rim.
        inside = points[:, 2] > points[:, 2].max() - 1e-6
    segments, size = writing(rng, 4.5 if kind < 2 else 1.3, 1.0)
    distance = _segment_distance(plane, segments)
    width = max(1.5 * edge, size * rng.uniform(0.06, 0.16))
    soft = log_uniform(rng, 0.8, 4) * edge
    height = smooth_step(width / 2 - distance, soft) * log_uniform(rng, 0.3, 4) * edge
    if chance(rng, 0.3):
        height = height * smooth_step(Noise(rng)(points * 2), 0.6)
    sign = 1 if chance(rng, 0.5) else -1
    mesh = mesh.moved(points + (sign * height * inside)[:, None] * outward)
    if chance(rng, 0.25):
        mesh = with_relief(rng, mesh, 1, 8.0)
    return isotropic(mesh, target, 60, 3) if chance(rng, 0.3) else mesh


def make_plate(rng, target: int) -> Mesh:
    """Make a plate or a body with writing."""
    return _carved(rng, target) if chance(rng, 0.65) else _pressed(rng, target)
