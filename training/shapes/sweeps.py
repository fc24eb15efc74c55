# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Sweeps, lathes, knots and tubes on structured grids."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import PchipInterpolator

from .mesh import Mesh, flipped, from_faces, from_lists
from .noise import Noise, chance, log_uniform, octaves, smooth_step
from .relief import heights


def grid_faces(rng, n_u: int, n_v: int, is_closed_u: bool, is_closed_v: bool, style: str):
    """Return faces over a grid of points, as quads or as triangles with one of several kinds of diagonals."""
    i = np.arange(n_u if is_closed_u else n_u - 1)
    j = np.arange(n_v if is_closed_v else n_v - 1)
    i, j = (x.ravel() for x in np.meshgrid(i, j, indexing="ij"))
    k, m = (i + 1) % n_u, (j + 1) % n_v
    quads = np.stack([i * n_v + j, k * n_v + j, k * n_v + m, i * n_v + m], 1)
    if style == "quads":
        return quads
    turned = {
        "diagonal": np.zeros(len(quads), bool),
        "alternate": (i + j) % 2 == 1,
        "rows": i % 2 == 1,
        "random": rng.random(len(quads)) < 0.5,
    }[style]
    quads = np.where(turned[:, None], np.roll(quads, -1, axis=1), quads)
    return np.stack([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]], 1).reshape(-1, 3)


STYLES = ["quads", "diagonal", "alternate", "rows", "random"]


def grid_style(rng, quads: float = 0.4) -> str:
    """Draw how the cells of a grid are divided."""
    return "quads" if chance(rng, quads) else STYLES[rng.integers(1, 5)]


def grid_mesh(rng, points, is_closed_u: bool, is_closed_v: bool, style: str) -> Mesh:
    """Make a mesh over a grid of points (n_u, n_v, 3)."""
    n_u, n_v = points.shape[:2]
    return from_faces(points.reshape(-1, 3), grid_faces(rng, n_u, n_v, is_closed_u, is_closed_v, style))


def capped(rng, points, style: str, poles) -> Mesh:
    """Make a tube that is closed around (second axis); its ends become points, polygons or stay open.

    Parameters
    ----------
    rng : numpy.random.Generator
    points : (n_u, n_v, 3) array
    style : str
    poles : list of (3,) array or None
        What closes the first and the last ring: a point, or nothing.
    """
    n_u, n_v = points.shape[:2]
    faces = grid_faces(rng, n_u, n_v, False, True, style).tolist()
    extra = []
    ring = np.arange(n_v)
    for end, pole in enumerate(poles):
        if pole is None:
            continue
        rim = ring if end == 0 else ring[::-1] + (n_u - 1) * n_v
        index = n_u * n_v + len(extra)
        extra.append(pole)
        faces += [[int(b), int(a), index][::-1] for a, b in zip(rim, np.roll(rim, -1), strict=True)]
    vertices = np.concatenate([points.reshape(-1, 3), np.array(extra).reshape(-1, 3)])
    # Along and then around is left-handed seen from outside.
    return flipped(from_lists(vertices, faces))


def _counts(
    rng, target: int, style: str, ratio: float, longest: float = 2.0, least: int = 12
) -> tuple[int, int]:
    """Numbers of points along and around, for cells whose sides have a random ratio."""
    cells = target if style == "quads" else target / 2
    cell = log_uniform(rng, 1 / longest, longest)
    n_u = int(np.clip(np.sqrt(cells * ratio * cell), 12, 1500))
    return n_u, max(least, int(cells / n_u))


def _curve(rng, n: int, is_closed: bool):
    """Draw a smooth space curve: (n, 3)."""
    t = np.linspace(0, 2 * np.pi, n, endpoint=not is_closed)
    if is_closed and chance(rng, 0.5):
        p, q = [(2, 3), (3, 2), (2, 5), (3, 4), (1, 2), (3, 5), (1, 4)][rng.integers(7)]
        radius = 1 + rng.uniform(0.25, 0.45) * np.cos(q * t)
        return np.stack(
            [radius * np.cos(p * t), radius * np.sin(p * t), rng.uniform(0.25, 0.45) * np.sin(q * t)], 1
        )
    if is_closed:
        curve = np.stack([np.cos(t), np.sin(t), 0 * t], 1)
        for k in range(2, 5):
            curve += (
                0.35
                / k
                * (np.cos(k * t)[:, None] * rng.normal(size=3) + np.sin(k * t)[:, None] * rng.normal(size=3))
                / 2
            )
        return curve
    if chance(rng, 0.3):
        turns = rng.uniform(1, 4)
        grow = rng.uniform(0.3, 1)
        scale = grow + (1 - grow) * t / (2 * np.pi)
        return np.stack([scale * np.cos(turns * t), scale * np.sin(turns * t), t * rng.uniform(0.15, 0.4)], 1)
    curve = np.stack([t / np.pi - 1, 0 * t, 0 * t], 1) * rng.uniform(0.8, 2)
    for k in range(1, 4):
        curve += np.sin(k * t / 2 + rng.uniform(0, 6))[:, None] * rng.normal(size=3) * 0.35 / k
    return curve


def _frames(curve, is_closed: bool):
    """Carry a frame along a curve without twist; a closed curve spreads what is left over."""
    tangent = np.roll(curve, -1, 0) - np.roll(curve, 1, 0)
    if not is_closed:
        tangent[0], tangent[-1] = curve[1] - curve[0], curve[-1] - curve[-2]
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    normal = np.empty_like(curve)
    start = np.eye(3)[np.abs(tangent[0]).argmin()]
    for k in range(len(curve)):
        start = start - (start @ tangent[k]) * tangent[k]
        start = start / np.linalg.norm(start)
        normal[k] = start
    binormal = np.cross(tangent, normal)
    if is_closed:
        last = normal[-1] - (normal[-1] @ tangent[0]) * tangent[0]
        angle = np.arctan2(last @ binormal[0], last @ normal[0])
        turn = -angle * np.arange(len(curve)) / (len(curve) - 1)
        cos, sin = np.cos(turn)[:, None], np.sin(turn)[:, None]
        normal, binormal = cos * normal + sin * binormal, cos * binormal - sin * normal
    return normal, binormal, tangent


def _section(rng, angle, along):
    """Draw a radius for each angle around and place along (n_u, n_v): round, flattened, fluted, threaded."""
    kind = rng.integers(6)
    if kind == 0:
        return np.ones_like(angle)
    if kind == 1:
        power = log_uniform(rng, 1.2, 8)
        flat = rng.uniform(0.4, 1)
        return (np.abs(np.cos(angle)) ** power + np.abs(np.sin(angle) / flat) ** power) ** (-1 / power)
    n = int(rng.integers(3, 16))
    deep = log_uniform(rng, 0.02, 0.3)
    phase = n * angle + 2 * np.pi * rng.integers(-6, 7) * along
    if kind == 2:
        return 1 + deep * np.cos(phase)
    if kind == 3:
        return 1 - deep * np.abs(np.cos(phase / 2)) if n % 2 == 0 else 1 + deep * np.cos(phase)
    if kind == 4:
        return 1 + deep * smooth_step(np.cos(phase), log_uniform(rng, 0.1, 1.5))
    turns = int(rng.integers(4, 30))
    return 1 + deep * np.abs(2 * ((turns * along + angle / (2 * np.pi)) % 1) - 1)


def tube(rng, target: int, least: int = 12) -> Mesh:
    """Sweep a section along a curve: tubes, hoses, knots, horns, rings; with `least` cells around or more."""
    is_closed = chance(rng, 0.5)
    style = grid_style(rng)
    radius = log_uniform(rng, 0.06, 0.28)
    n_u, n_v = _counts(rng, target, style, 8.0 / (2 * np.pi * radius), 3.0, least)
    curve = _curve(rng, n_u, is_closed)
    normal, binormal, _ = _frames(curve, is_closed)
    along = np.linspace(0, 1, n_u, endpoint=not is_closed)[:, None]
    angle = np.broadcast_to(np.linspace(0, 2 * np.pi, n_v, endpoint=False), (n_u, n_v))
    swell = 1 + rng.uniform(0, 0.5) * np.cos(2 * np.pi * rng.integers(1, 6) * along + rng.uniform(0, 6))
    size = radius * swell * _section(rng, angle, along)
    poles = [None, None]
    if not is_closed and chance(rng, 0.7):
        # Rounded or tapering ends that close in a point.
        cap = log_uniform(rng, 0.02, 0.5)
        size = size * np.sqrt(
            np.clip(1 - np.maximum(0, 1 - np.minimum(along, 1 - along) / cap) ** 2, 0, 1) + 1e-3
        )
        poles = [curve[0], curve[-1]]
    points = curve[:, None] + size[..., None] * (
        np.cos(angle)[..., None] * normal[:, None] + np.sin(angle)[..., None] * binormal[:, None]
    )
    if is_closed:
        return grid_mesh(rng, points, True, True, style)
    return capped(rng, points, style, poles)


def lathe(rng, target: int) -> Mesh:
    """Turn a profile: vases, columns, chess pieces, bowls."""
    style = grid_style(rng)
    n_u, n_v = _counts(rng, target, style, rng.uniform(0.5, 1.5), 3.0)
    n = int(rng.integers(4, 12))
    knots = np.linspace(0, 1, n)
    radius = rng.uniform(0.25, 1, n)
    height = np.cumsum(np.concatenate([[0], rng.uniform(0.2, 1, n - 1)]))
    height = height / height[-1] * rng.uniform(1, 3)
    is_smooth = chance(rng, 0.6)
    t = np.linspace(0, 1, n_u)
    if is_smooth:
        r, z = PchipInterpolator(knots, radius)(t), PchipInterpolator(knots, height)(t)
    else:
        # Corners of the profile, with a point of the grid on each.
        t = np.unique(np.concatenate([t, knots]))
        r, z = np.interp(t, knots, radius), np.interp(t, knots, height)
    angle = np.broadcast_to(np.linspace(0, 2 * np.pi, n_v, endpoint=False), (len(t), n_v))
    r = r[:, None] * (_section(rng, angle, t[:, None]) if chance(rng, 0.5) else 1)
    points = np.stack([r * np.cos(angle), r * np.sin(angle), np.broadcast_to(z[:, None], r.shape)], -1)
    if chance(rng, 0.5):
        return capped(rng, points, style, [None, None])
    # Flat ends of several rings: a fan that spans the whole disk would be needles only.
    rings = np.linspace(0, 1, max(3, n_v // 8))[1:-1, None, None]
    low = points[0] * rings * [1, 1, 0] + points[0] * [0, 0, 1]
    high = points[-1] * rings[::-1] * [1, 1, 0] + points[-1] * [0, 0, 1]
    middle = [points[0].mean(0) * [0, 0, 1], points[-1].mean(0) * [0, 0, 1]]
    return capped(rng, np.concatenate([low, points, high]), style, middle)


def superellipsoid(rng, target: int) -> Mesh:
    """Make a ball that is more or less boxy or pinched."""
    style = grid_style(rng)
    n_u, n_v = _counts(rng, target, style, 0.5)
    e, f = log_uniform(rng, 0.15, 2.2), log_uniform(rng, 0.15, 2.2)

    def power(x, p):
        return np.sign(x) * np.abs(x) ** p

    u = np.linspace(-np.pi / 2, np.pi / 2, n_u + 2)[1:-1, None]
    v = np.linspace(-np.pi, np.pi, n_v, endpoint=False)[None]
    points = np.stack(
        [
            power(np.cos(u), e) * power(np.cos(v), f),
            power(np.cos(u), e) * power(np.sin(v), f),
            power(np.sin(u), e) + 0 * v,
        ],
        -1,
    )
    points = points * rng.uniform(0.5, 1, 3)
    height = float(points[..., 2].max())
    return capped(rng, points, style, [np.array([0, 0, -height * 1.001]), np.array([0, 0, height * 1.001])])


def harmonic_ball(rng, target: int) -> Mesh:
    """Make a ball whose radius is smooth noise, on a grid of angles."""
    style = grid_style(rng)
    n_u, n_v = _counts(rng, target, style, 0.5)
    u = np.linspace(0, np.pi, n_u + 2)[1:-1, None]
    v = np.linspace(0, 2 * np.pi, n_v, endpoint=False)[None]
    ball = np.stack([np.sin(u) * np.cos(v), np.sin(u) * np.sin(v), -np.cos(u) + 0 * v], -1)
    unit = np.concatenate([ball.reshape(-1, 3), [[0, 0, -1], [0, 0, 1]]])
    radius = 1 + rng.uniform(0.05, 0.35) * octaves(rng, unit, log_uniform(rng, 0.5, 2), rng.integers(1, 4))
    mesh = capped(rng, ball, style, [unit[-2], unit[-1]])
    return mesh.moved(unit * np.maximum(radius, 0.2)[:, None])


def sheet(rng, target: int) -> Mesh:
    """Make an open patch: a wavy or folded cloth over a grid, often of elongated cells."""
    style = grid_style(rng)
    n_u, n_v = _counts(rng, target, style, 1.0, 6.0)
    u, v = np.meshgrid(np.linspace(-1, 1, n_u), np.linspace(-1, 1, n_v), indexing="ij")
    points = np.stack([u, v, 0 * u], -1).reshape(-1, 3)
    points[:, 2] = 0.15 * Noise(rng)(points * rng.uniform(0.5, 1.5))
    edge = 2 / np.sqrt(n_u * n_v)
    points[:, 2] += heights(rng, points, edge * 1.3, int(rng.integers(0, 3)), 6.0)
    if chance(rng, 0.5):
        # Rolled around an axis.
        angle = points[:, 0] * rng.uniform(0.5, 2.8)
        far = 1 + points[:, 2]
        points = np.stack([far * np.sin(angle), points[:, 1], far * np.cos(angle)], 1)
    return grid_mesh(rng, points.reshape(n_u, n_v, 3), False, False, style)


def make_ball(rng, target: int) -> Mesh:
    """Make a smooth body of equal triangles: a subdivided icosahedron, or an ellipsoid remeshed."""
    from .blender import with_bmesh
    from .resampling import isotropic

    def icosphere(bmesh, work):
        bmesh.ops.create_icosphere(work, subdivisions=6 if chance(rng, 0.75) else 5, radius=1)

    ball = with_bmesh(from_faces(np.zeros((0, 3)), np.zeros((0, 3), int)), icosphere)
    unit = ball.vertices / np.linalg.norm(ball.vertices, axis=1)[:, None]
    wave = 0 if chance(rng, 0.3) else rng.uniform(0.03, 0.3)
    radius = 1 + wave * octaves(rng, unit, log_uniform(rng, 0.8, 2.5), 1)
    ball = ball.moved(unit * np.maximum(radius, 0.3)[:, None])
    if chance(rng, 0.5):
        return ball
    return isotropic(ball.moved(ball.vertices * np.exp(rng.uniform(-0.7, 0.7, 3))), target, 180)


def make_thin_tube(rng, target: int) -> Mesh:
    """Make a tube of few faces around."""
    return tube(rng, target, least=5)


def make_sweep(rng, target: int) -> Mesh:
    """Make one of the shapes of this file."""
    kinds = [tube, lathe, superellipsoid, harmonic_ball, sheet]
    return kinds[rng.choice(5, p=[0.38, 0.27, 0.1, 0.12, 0.13])](rng, target)
