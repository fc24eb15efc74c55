# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Quads and polygons: voxel remeshing, subdivided cages, bevels, duals, honeycombs, dissolved planes."""

from __future__ import annotations

import numpy as np

from .blender import dissolved, quadriflow, quads_joined, with_modifiers
from .mesh import Mesh, area, condition, from_faces, from_lists, largest_island, triangulated
from .noise import Noise, chance, log_uniform, octaves
from .organic import bend, make_organic, project, smooth_body
from .parts import solid_part, to_mesh
from .plates import make_plate
from .relief import with_relief
from .resampling import dual, isotropic
from .terrain import make_terrain


def _voxel(rng, target: int) -> Mesh:
    """Remesh a body or a part by voxels into quads."""
    mesh = make_organic(rng, int(1.5 * target)) if chance(rng, 0.6) else to_mesh(solid_part(rng, target)[0])
    mesh = mesh.moved(mesh.vertices - mesh.vertices.mean(0))
    # A surface that is turned at random meets 1.5 times its area in faces of the grid.
    size = float(np.sqrt(1.5 * area(mesh) / target))
    mesh = with_modifiers(mesh, ("REMESH", {"mode": "VOXEL", "voxel_size": size, "use_smooth_shade": False}))
    mesh = largest_island(mesh)
    return with_relief(rng, mesh, int(rng.integers(1, 3)), 5.0) if chance(rng, 0.2) else mesh


def cage(rng) -> Mesh:
    """Make a blocky cage: the outside of a few cubes of a grid that touch in faces only."""
    shape = rng.integers(2, 5, 3)
    full = np.zeros(shape + 2, bool)
    place = shape // 2
    for _ in range(rng.integers(3, 14)):
        full[tuple(place + 1)] = True
        axis = rng.integers(3)
        place = place.copy()
        place[axis] = np.clip(place[axis] + rng.choice([-1, 1]), 0, shape[axis] - 1)
    faces = []
    corners = {}

    def corner(point):
        return corners.setdefault(tuple(point), len(corners))

    for cell in np.argwhere(full):
        for axis in range(3):
            for side in (0, 1):
                step = np.eye(3, dtype=int)[axis] * (2 * side - 1)
                if full[tuple(cell + step)]:
                    continue
                a, b = np.eye(3, dtype=int)[(axis + 1) % 3], np.eye(3, dtype=int)[(axis + 2) % 3]
                origin = cell + np.eye(3, dtype=int)[axis] * side
                ring = [origin, origin + a, origin + a + b, origin + b]
                faces.append([corner(p) for p in (ring if side else ring[::-1])])
    points = np.array(list(corners), float)
    if condition(from_faces(points, np.array(faces)))[1:] != (0, 0, 0):
        # Two cubes met in an edge or a corner only.
        return cage(rng)
    points = points + rng.normal(size=points.shape) * rng.uniform(0, 0.22)
    return from_faces(points * rng.uniform(0.6, 1.4, 3), np.array(faces))


def _levels(mesh: Mesh, target: int) -> int:
    return max(1, round(np.log(target / mesh.n_faces) / np.log(4)))


def _subdivided(rng, target: int) -> Mesh:
    """Subdivide a cage; relief on some."""
    mesh = cage(rng)
    if chance(rng, 0.3):
        # Supporting loops keep corners tight, as modelers do.
        mesh = with_modifiers(
            mesh, ("BEVEL", {"width": rng.uniform(0.03, 0.15), "segments": 2, "limit_method": "NONE"})
        )
    levels = _levels(mesh, target)
    mesh = with_modifiers(mesh, ("SUBSURF", {"levels": levels, "render_levels": levels}))
    if chance(rng, 0.75):
        mesh = with_relief(rng, mesh, int(rng.integers(1, 6)), 4.0)
    return mesh


def _beveled(rng, target: int) -> Mesh:
    """Round the edges of a blocky cage and cut its faces by plain subdivision."""
    mesh = cage(rng)
    width = log_uniform(rng, 0.02, 0.2)
    segments = int(rng.integers(1, 5))
    mesh = with_modifiers(
        mesh, ("BEVEL", {"width": width, "segments": segments, "limit_method": "ANGLE", "angle_limit": 0.5})
    )
    levels = _levels(mesh, target)
    mesh = with_modifiers(
        mesh, ("SUBSURF", {"levels": levels, "render_levels": levels, "subdivision_type": "SIMPLE"})
    )
    return bend(rng, mesh, rng.uniform(0.02, 0.12)) if chance(rng, 0.4) else mesh


def _flow(rng, target: int) -> Mesh:
    """Remesh a smooth body into field-aligned quads."""
    mesh, field = smooth_body(rng, 4000)
    mesh = largest_island(quadriflow(mesh, max(target // 2, 4200)))
    mesh = project(field, mesh)
    return with_relief(rng, mesh, int(rng.integers(0, 4)), 4.0)


def _flow_part(rng, target: int) -> Mesh:
    """Remesh a machine part into field-aligned quads, which follow its creases or cross them."""
    part = isotropic(to_mesh(solid_part(rng, 6000)[0]), 6000, 25)
    return largest_island(quadriflow(largest_island(part), target))


def honeycomb(rng, target: int) -> Mesh:
    """Make a patch of hexagons over bumpy ground, sometimes rolled."""
    n_v = int(np.sqrt(target))
    n_u = int(target / n_v)
    i, j = np.meshgrid(np.arange(n_u), np.arange(n_v), indexing="ij")
    plane = np.stack([i + 0.5 * (j % 2), j * np.sqrt(3) / 2, 0.0 * i], -1).reshape(-1, 3)
    plane = plane / n_u * 2
    k = (np.arange(n_u - 1)[:, None] * n_v + np.arange(n_v - 1)).ravel()
    is_odd = np.tile(np.arange(n_v - 1) % 2 == 1, n_u - 1)[:, None]
    a, b, c, d = k, k + n_v, k + n_v + 1, k + 1
    even = np.stack([a, b, d, b, c, d], 1)
    odd = np.stack([a, b, c, a, c, d], 1)
    mesh = dual(from_faces(plane, np.where(is_odd, odd, even).reshape(-1, 3)))
    points = mesh.vertices
    points[:, 2] = octaves(
        rng, points, log_uniform(rng, 0.3, 1.5), int(rng.integers(1, 4)), 0.4
    ) * rng.uniform(0.02, 0.2)
    mesh = with_relief(rng, mesh.moved(points), int(rng.integers(0, 3)), 4.0)
    if chance(rng, 0.5):
        angle = mesh.vertices[:, 0] * rng.uniform(0.5, 2.8)
        far = 1 + mesh.vertices[:, 2]
        mesh = mesh.moved(np.stack([far * np.sin(angle), mesh.vertices[:, 1], far * np.cos(angle)], 1))
    return mesh


def _cells(rng, target: int) -> Mesh:
    """Take the dual of triangles: a polygon around each vertex."""
    if chance(rng, 0.6):
        mesh = make_organic(rng, 2 * target)
    else:
        mesh = isotropic(to_mesh(solid_part(rng, 2 * target)[0]), 2 * target, 25)
    return dual(mesh)


def _dominant(rng, target: int) -> Mesh:
    """Join triangles into quads where they fit, so that a mixture is left."""
    kind = rng.integers(3)
    base = (make_organic, make_plate, make_terrain)[kind](rng, int(1.6 * target))
    triangles = from_faces(base.vertices, triangulated(base))
    return quads_joined(triangles, rng.uniform(0.1, 0.7))


def _dissolved(rng, target: int) -> Mesh:
    """Dissolve flat parts into polygons."""
    if chance(rng, 0.5):
        mesh = isotropic(to_mesh(solid_part(rng, 2 * target)[0]), 2 * target, 20)
        # Only in places: a whole plate in one face would leave nothing to denoise.
        mask = Noise(rng)(mesh.vertices * (3 / np.ptp(mesh.vertices, axis=0).max()))
        return _partly_dissolved(rng, mesh, mask)
    mesh = make_organic(rng, int(2.0 * target))
    return dissolved(mesh, rng.uniform(0.03, 0.12))


def _partly_dissolved(rng, mesh: Mesh, mask) -> Mesh:
    """Merge random neighbors in one plane into small polygons where a mask is high."""
    faces = mesh.corner_vertex.reshape(-1, 3)
    a, b, c = (mesh.vertices[faces[:, k]] for k in range(3))
    normal = np.cross(b - a, c - a)
    normal /= np.maximum(np.linalg.norm(normal, axis=1), 1e-300)[:, None]
    n = len(mesh.vertices)
    start, end = faces.ravel(), np.roll(faces, -1, 1).ravel()
    owner = np.repeat(np.arange(len(faces)), 3)
    lookup = {}
    for s, e, f in zip(start.tolist(), end.tolist(), owner.tolist(), strict=True):
        lookup[s * n + e] = f
    # The fan around an inner vertex becomes one polygon when all of it lies in one plane.
    order = rng.permutation(n)
    around = {}
    for f, face in enumerate(faces.tolist()):
        for k in range(3):
            around.setdefault(face[k], []).append((face[(k + 1) % 3], face[(k + 2) % 3], f))
    taken = np.zeros(len(faces), bool)
    used = np.zeros(n, bool)
    polygons = []
    for vertex in order.tolist():
        if mask[vertex] < 0 or used[vertex]:
            continue
        fan = around.get(vertex, [])
        own = [f for _, _, f in fan]
        if taken[own].any() or (normal[own] @ normal[own[0]]).min() < 1 - 1e-8:
            continue
        following = {s: e for s, e, _ in fan}
        ring = [fan[0][0]]
        while following.get(ring[-1], ring[0]) != ring[0] and len(ring) <= len(fan):
            ring.append(following[ring[-1]])
        if len(ring) != len(fan) or following.get(ring[-1]) != ring[0]:
            continue
        taken[own] = True
        used[vertex] = True
        polygons.append(ring)
    rest = faces[~taken].tolist()
    result = from_lists(mesh.vertices, polygons + rest)
    kept, corner = np.unique(result.corner_vertex, return_inverse=True)
    return Mesh(result.vertices[kept], result.face_offset, corner.ravel().astype(np.int32))


def make_quads(rng, target: int) -> Mesh:
    """Make one of the shapes of this file."""
    kinds = [_voxel, _subdivided, _beveled, _flow, honeycomb, _cells, _dominant, _dissolved]
    return kinds[rng.choice(8, p=[0.2, 0.16, 0.11, 0.03, 0.08, 0.14, 0.16, 0.12])](rng, target)


def make_coarse_quads(rng, target: int) -> Mesh:
    """Make few quads: of parts, whose creases they often cross, and of bodies."""
    kinds = [_voxel, _flow_part, _subdivided, _beveled, _dominant, _cells]
    return kinds[rng.choice(6, p=[0.25, 0.3, 0.2, 0.1, 0.1, 0.05])](rng, target)
