# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Machine parts: solids that are united, cut, drilled and chamfered."""

from __future__ import annotations

import numpy as np
from manifold3d import CrossSection, JoinType, Manifold, OpType
from manifold3d import Mesh64 as SolidMesh

from .mesh import Mesh, from_faces, largest_island
from .noise import chance, log_uniform, random_rotation
from .resampling import decimated, edge_for, graded, isotropic, refined_in_parts


def to_mesh(solid: Manifold) -> Mesh:
    """Take the largest connected part of a solid."""
    pieces = solid.decompose()
    if len(pieces) > 1:
        solid = max(pieces, key=lambda piece: piece.volume())
    mesh = solid.to_mesh64()
    return largest_island(from_faces(mesh.vert_properties[:, :3], mesh.tri_verts))


def to_solid(mesh: Mesh) -> Manifold:
    """Make a solid of a closed mesh of triangles."""
    return Manifold(
        SolidMesh(np.ascontiguousarray(mesh.vertices), mesh.corner_vertex.reshape(-1, 3).astype(np.uint64))
    )


def _segments(rng) -> int:
    return int(log_uniform(rng, 24, 256))


def outline(rng) -> CrossSection:
    """Draw a plane outline within about the unit circle."""
    kind = rng.integers(7)
    if kind == 0:
        shape = CrossSection.square([rng.uniform(0.6, 2), rng.uniform(0.6, 2)], True)
    elif kind == 1:
        n = int(rng.integers(3, 9))
        angle = np.arange(n) * (2 * np.pi / n)
        shape = CrossSection([np.stack([np.cos(angle), np.sin(angle)], 1)])
    elif kind == 2:
        return gear(rng)
    elif kind == 3:
        # L, U, T and H brackets are strokes of some width.
        shape = CrossSection.square([2, 2], True)
        for _ in range(rng.integers(1, 3)):
            cut = CrossSection.square([rng.uniform(0.5, 1.4), rng.uniform(0.5, 1.4)], True)
            shape = shape - cut.translate([rng.choice([-1, 0, 1]), rng.choice([-1, 1])])
    elif kind == 4:
        n = int(rng.integers(5, 12))
        angle = np.sort(rng.uniform(0, 2 * np.pi, n))
        radius = rng.uniform(0.4, 1.1, n)
        shape = CrossSection([np.stack([np.cos(angle) * radius, np.sin(angle) * radius], 1)])
    elif kind == 5:
        disks = [
            CrossSection.circle(rng.uniform(0.15, 0.5), _segments(rng)).translate(
                list(rng.uniform(-0.7, 0.7, 2))
            )
            for _ in range(rng.integers(2, 4))
        ]
        shape = CrossSection.batch_hull(disks)
    else:
        angle = np.linspace(0, 2 * np.pi, 160, endpoint=False)
        radius = 0.8 + rng.uniform(0.03, 0.2) * np.cos(rng.integers(2, 8) * angle)
        shape = CrossSection([np.stack([np.cos(angle) * radius, np.sin(angle) * radius], 1)])
    if kind != 6 and chance(rng, 0.6):
        radius = log_uniform(rng, 0.03, 0.2)
        join = JoinType.Round if chance(rng, 0.7) else JoinType.Square
        segments = _segments(rng)
        shape = shape.offset(-radius, JoinType.Miter).offset(radius, join, 2.0, segments)
        if chance(rng, 0.5):
            shape = shape.offset(radius, JoinType.Miter).offset(-radius, join, 2.0, segments)
    if shape.is_empty() or shape.area() < 0.1:
        shape = CrossSection.square([1.5, 1.0], True)
    return shape


def gear(rng) -> CrossSection:
    """Draw a gear wheel."""
    n = int(rng.integers(6, 28))
    inner = rng.uniform(0.6, 0.88)
    top, foot = sorted(rng.uniform(0.1, 0.45, 2))
    points = []
    for k in range(n):
        for radius, offset in ((inner, -foot), (1, -top), (1, top), (inner, foot)):
            angle = (k + offset) * 2 * np.pi / n
            points.append([radius * np.cos(angle), radius * np.sin(angle)])
    shape = CrossSection([np.array(points)])
    return shape - CrossSection.circle(rng.uniform(0.1, 0.45), _segments(rng))


def _profile(rng) -> CrossSection:
    """Draw half a cross section of a turned part, straight and curved pieces from foot to head."""
    n = int(rng.integers(3, 8))
    height = np.concatenate([[-1], np.sort(rng.uniform(-1, 1, n - 1)), [1]])
    radius = rng.uniform(0.3, 1, n + 1)
    points = [[0, -1]]
    for k in range(n):
        style = rng.integers(4)
        if style == 0:
            points += [[radius[k], height[k]], [radius[k], height[k + 1]]]
        elif style == 1:
            points += [[radius[k], height[k]]]
        else:
            t = np.linspace(0, 1, 24)
            ease = (1 - np.cos(np.pi * t)) / 2 if style == 2 else np.sqrt(1 - (1 - t) ** 2)
            step = radius[k] + (radius[k + 1] - radius[k]) * ease
            points += [[r, h] for r, h in zip(step, height[k] + (height[k + 1] - height[k]) * t, strict=True)]
    points += [[radius[-1], 1], [0, 1]]
    return CrossSection([np.array(points, float)])


def folded_block(rng) -> Manifold:
    """Make a block whose top has creases that fade out along their length.

    Smooth faces that meet at an angle which falls to nothing are what makes a part hard to denoise.
    """
    n = 48
    u, v = np.meshgrid(np.linspace(-1, 1, n + 1), np.linspace(-1, 1, n + 1), indexing="ij")
    top = 0.3 * rng.normal() * u**2 + 0.3 * rng.normal() * v**2 + 0.2 * rng.normal() * u * v
    for _ in range(rng.integers(1, 4)):
        line = np.linspace(-1, 1, n + 1)[rng.integers(n // 5, n - n // 5)]
        x, along = (u, v) if chance(rng, 0.5) else (v, u)
        fade = np.clip((along - rng.uniform(-1, 0.4)) / rng.uniform(0.5, 1.5), 0, 1) ** rng.uniform(1, 2)
        top = top + rng.choice([-1, 1]) * rng.uniform(0.2, 1.2) * fade * np.maximum(x - line, 0)
    top = top - top.min() + rng.uniform(0.2, 0.8)
    m = n + 1
    points = np.stack([u, v, top], -1).reshape(-1, 3)
    floor = points * [1, 1, 0]
    cell = (np.arange(n)[:, None] * m + np.arange(n)).ravel()
    quads = np.stack([cell, cell + m, cell + m + 1, cell + 1], 1)
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    rim = np.concatenate(
        [np.arange(n) * m, n * m + np.arange(n), m * m - 1 - np.arange(n) * m, n - np.arange(n)]
    )
    following = np.roll(rim, -1)
    shift = m * m
    side = (
        np.stack([rim, rim + shift, following + shift], 1),
        np.stack([rim, following + shift, following], 1),
    )
    faces = np.concatenate([triangles, triangles[:, ::-1] + shift, *side])
    solid = to_solid(from_faces(np.concatenate([points, floor]), faces))
    return solid.translate([0, 0, -float(top.mean()) / 2])


def _base(rng) -> Manifold:
    kind = rng.integers(9)
    if kind == 0:
        return Manifold.cube(list(rng.uniform(0.5, 2, 3)), True)
    if kind == 1:
        return Manifold.cylinder(
            rng.uniform(0.4, 2.2), rng.uniform(0.5, 1), rng.uniform(0.3, 1), _segments(rng), True
        )
    if kind in (2, 3):
        height = rng.uniform(0.3, 1.6)
        twist = rng.uniform(-60, 60) if chance(rng, 0.2) else 0.0
        taper = rng.uniform(0.5, 1.0) if chance(rng, 0.2) else 1.0
        divisions = 40 if twist else 0
        return Manifold.extrude(outline(rng), height, divisions, twist, (taper, taper)).translate(
            [0, 0, -height / 2]
        )
    if kind == 4:
        return Manifold.revolve(_profile(rng), _segments(rng))
    if kind in (5, 6):
        return folded_block(rng)
    if kind == 7:
        # Lenses and barrels: curved faces that meet at obtuse edges.
        solid = Manifold.sphere(1.2, 128)
        for _ in range(rng.integers(1, 4)):
            other = Manifold.sphere(rng.uniform(1.0, 2.5), 160)
            if chance(rng, 0.5):
                other = Manifold.cylinder(6, rng.uniform(0.7, 1.4), -1, 160, True).rotate(
                    list(rng.uniform(0, 360, 3))
                )
            solid = solid ^ other.translate(list(rng.uniform(-0.5, 0.5, 3)))
        return solid
    pieces = [
        Manifold.sphere(rng.uniform(0.2, 0.6), 64).translate(list(rng.uniform(-0.8, 0.8, 3)))
        if chance(rng, 0.5)
        else Manifold.cylinder(rng.uniform(0.1, 0.6), rng.uniform(0.2, 0.7), -1, 96, True).translate(
            list(rng.uniform(-0.7, 0.7, 3))
        )
        for _ in range(rng.integers(2, 4))
    ]
    return Manifold.batch_hull(pieces)


def _place(rng, solid: Manifold, tool: Manifold) -> Manifold:
    """Turn a tool, which points up and has its top at height 0, onto the surface of a solid."""
    box = np.array(solid.bounding_box()).reshape(2, 3)
    axis, side = rng.integers(3), rng.choice([-1, 1])
    turn = {(0, 1): [0, 90, 0], (0, -1): [0, -90, 0], (1, 1): [-90, 0, 0], (1, -1): [90, 0, 0]}.get(
        (int(axis), int(side)), [0, 0, 0] if side > 0 else [180, 0, 0]
    )
    if chance(rng, 0.12):
        turn = [turn[0] + rng.uniform(-40, 40), turn[1] + rng.uniform(-40, 40), turn[2]]
    position = box[0] + (box[1] - box[0]) * rng.uniform(0.15, 0.85, 3)
    position[axis] = box[1 if side > 0 else 0, axis]
    return tool.rotate(turn).translate(list(position))


def _operate(rng, solid: Manifold, edge: float) -> Manifold:
    """Do one step of machining."""
    kind = rng.integers(11)
    depth = log_uniform(rng, 0.5 * edge, 12 * edge)
    if kind == 0:  # drilled holes, some of them with a wider mouth
        radius = log_uniform(rng, 1.5 * edge, 0.4)
        deep = 4.0 if chance(rng, 0.5) else depth * 2
        tool = Manifold.cylinder(deep + 0.5, radius, -1, _segments(rng)).translate([0, 0, -deep])
        if chance(rng, 0.4):
            tool = tool + Manifold.cylinder(depth + 0.5, radius * 1.5, -1, _segments(rng)).translate(
                [0, 0, -depth]
            )
        if chance(rng, 0.3):
            tool = tool + Manifold.cylinder(radius, radius * 0.9, radius * 1.9, _segments(rng)).translate(
                [0, 0, -radius * 0.5]
            )
        return solid - _place(rng, solid, tool)
    if kind == 1:  # slots
        radius = log_uniform(rng, edge, 0.25)
        shape = CrossSection.circle(radius, 48)
        shape = CrossSection.batch_hull([shape, shape.translate([log_uniform(rng, radius, 1.5), 0])])
        deep = 4.0 if chance(rng, 0.4) else depth
        tool = Manifold.extrude(shape.rotate(rng.choice([0, 90, rng.uniform(0, 180)])), deep + 0.5)
        return solid - _place(rng, solid, tool.translate([0, 0, -deep]))
    if kind in (2, 3):  # pockets and raised pads, from half an edge up
        shape = outline(rng).scale([log_uniform(rng, 0.15, 0.7)] * 2)
        if kind == 2:
            tool = Manifold.extrude(shape, depth + 0.5).translate([0, 0, -depth])
            return solid - _place(rng, solid, tool)
        tool = Manifold.extrude(shape, depth + 0.3).translate([0, 0, -0.3])
        return solid + _place(rng, solid, tool)
    if kind == 4:  # bosses
        radius = log_uniform(rng, 2 * edge, 0.4)
        tool = Manifold.cylinder(depth + 0.3, radius, radius * rng.uniform(0.6, 1), _segments(rng))
        if chance(rng, 0.3):
            tool = tool + Manifold.sphere(radius, 64).translate([0, 0, 0.3])
        tool = tool.translate([0, 0, -0.3])
        if chance(rng, 0.4):
            tool = tool - Manifold.cylinder(4, radius * rng.uniform(0.3, 0.7), -1, _segments(rng), True)
        return solid + _place(rng, solid, tool)
    if kind == 5:  # ribs
        thick = log_uniform(rng, edge, 6 * edge)
        tool = Manifold.cube([rng.uniform(0.5, 2), thick, depth + 0.4], True)
        tool = tool.rotate([0, 0, rng.choice([0, 90, rng.uniform(0, 180)])])
        return solid + _place(rng, solid, tool)
    if kind == 6:  # rows or circles of holes or fins
        n = int(rng.integers(3, 9))
        radius = log_uniform(rng, 1.2 * edge, 0.12)
        one = Manifold.cylinder(depth + 0.5, radius, -1, _segments(rng)).translate([0, 0, -depth])
        if chance(rng, 0.3):
            one = Manifold.cube([radius, rng.uniform(0.3, 1), 2 * depth], True)
        if chance(rng, 0.5):
            ring = rng.uniform(0.3, 0.7)
            many = [one.translate([ring, 0, 0]).rotate([0, 0, 360 * k / n]) for k in range(n)]
        else:
            many = [one.translate([(k - n / 2) * radius * 3, 0, 0]) for k in range(n)]
        tool = Manifold.batch_boolean(many, OpType.Add)
        tool = _place(rng, solid, tool)
        return solid - tool if chance(rng, 0.7) else solid + tool
    if kind in (7, 8):  # chamfers, from wide facets to obtuse grazing cuts
        normal = rng.choice([-1.0, 0.0, 1.0], 3) if chance(rng, 0.6) else rng.normal(size=3)
        if not normal.any():
            return solid
        normal = normal / np.linalg.norm(normal)
        reach = (to_mesh(solid).vertices @ normal).max()
        return solid.trim_by_plane(list(-normal), float(-reach + log_uniform(rng, 0.5 * edge, 0.25)))
    if kind == 9:  # ball-end mill
        radius = log_uniform(rng, 2 * edge, 0.8)
        tool = Manifold.sphere(radius, int(rng.integers(48, 160))).translate(
            [0, 0, radius * rng.uniform(-0.2, 0.8)]
        )
        return solid - _place(rng, solid, tool)
    ring, radius = rng.uniform(0.3, 1.0), log_uniform(rng, edge, 0.15)
    tool = Manifold.revolve(CrossSection.circle(radius, 40).translate([ring, 0]), int(rng.integers(64, 200)))
    tool = _place(rng, solid, tool)
    return solid - tool if chance(rng, 0.7) else solid + tool


def solid_part(rng, target: int, n_steps: int | None = None) -> tuple[Manifold, float]:
    """Make a part; return it and the edge that ``target`` faces on it have."""
    while True:
        solid = _base(rng)
        if chance(rng, 0.35):
            other = _base(rng).scale([rng.uniform(0.4, 0.9)] * 3).rotate([float(90 * rng.integers(4)), 0, 0])
            other = other.translate(list(rng.uniform(-0.6, 0.6, 3)))
            solid = [solid + other, solid - other, solid ^ other][rng.choice(3, p=[0.6, 0.25, 0.15])]
        if not solid.is_empty() and solid.volume() > 0.15:
            break
    n_steps = int(rng.integers(2, 13)) if n_steps is None else n_steps
    for _ in range(n_steps):
        edge = edge_for(solid.surface_area(), target)
        result = _operate(rng, solid, edge)
        # A step that cuts most of the part away would leave a splinter.
        if not result.is_empty() and result.volume() > 0.4 * solid.volume() and result.num_tri() < 60000:
            solid = result
    return solid, edge_for(solid.surface_area(), target)


def make_part(rng, target: int) -> Mesh:
    """Make a machine part with one of several ways of meshing."""
    solid, edge = solid_part(rng, target)
    way = rng.choice(7, p=[0.40, 0.14, 0.14, 0.08, 0.10, 0.07, 0.07])
    angle = rng.choice([8.0, 15.0, 25.0, 35.0])
    if way == 1:
        return to_mesh(solid.refine_to_length(edge * rng.uniform(1.2, 1.8)))
    if way == 2:
        return decimated(
            isotropic(to_mesh(solid), int(2.2 * target), angle, 4), target, rng.uniform(0.1, 0.6), True
        )
    if way == 3:
        return decimated(to_mesh(solid.refine_to_length(edge)), target, rng.uniform(0.1, 0.6), True)
    mesh = to_mesh(solid)
    if way == 4:
        return graded(rng, to_mesh(solid.refine_to_length(2 * edge)), target, angle)
    if way == 5:
        return refined_in_parts(rng, isotropic(mesh, target // 2, angle), target)
    if way == 6:
        turn = random_rotation(rng)
        # Remeshed in a stretched space: long triangles along one direction.
        stretch = turn @ np.diag([rng.uniform(1.5, 4), 1, 1]) @ turn.T
        there = isotropic(mesh.moved(mesh.vertices @ stretch), target, angle)
        return there.moved(there.vertices @ np.linalg.inv(stretch))
    return isotropic(mesh, target, angle, int(rng.integers(4, 10)))
