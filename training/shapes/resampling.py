# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Other triangles on the same surface: remeshed, decimated, graded, refined, dual."""

from __future__ import annotations

import numpy as np
import pymeshlab

from .mesh import Mesh, area, flipped, from_faces, from_lists, half_edges, triangulated
from .noise import Noise, chance, log_uniform


def _load(mesh: Mesh) -> pymeshlab.MeshSet:
    lab = pymeshlab.MeshSet()
    lab.add_mesh(pymeshlab.Mesh(mesh.vertices, triangulated(mesh)))
    return lab


def _unload(lab) -> Mesh:
    lab.meshing_remove_unreferenced_vertices()
    current = lab.current_mesh()
    return from_faces(current.vertex_matrix(), current.face_matrix())


def edge_for(surface: float, target: int) -> float:
    """Return the edge of equilateral triangles, ``target`` of which have the area ``surface``."""
    return float(np.sqrt(4 * surface / (np.sqrt(3) * target)))


def isotropic(mesh: Mesh, target: int, angle: float = 30.0, iterations: int = 6) -> Mesh:
    """Remesh into about ``target`` nearly equilateral triangles; edges sharper than ``angle`` stay."""
    lab = _load(mesh)
    lab.meshing_isotropic_explicit_remeshing(
        iterations=iterations,
        targetlen=pymeshlab.PureValue(edge_for(area(mesh), target)),
        featuredeg=angle,
        checksurfdist=False,
    )
    return _unload(lab)


def decimated(mesh: Mesh, target: int, quality: float = 0.3, is_planar: bool = False) -> Mesh:
    """Collapse edges by the quadric error; no ``quality`` gives needles."""
    lab = _load(mesh)
    lab.meshing_decimation_quadric_edge_collapse(
        targetfacenum=int(target),
        qualitythr=quality,
        planarquadric=is_planar,
        planarweight=1e-3,
        preservenormal=True,
        preserveboundary=True,
        preservetopology=True,
    )
    return _unload(lab)


def graded(rng, mesh: Mesh, target: int, angle: float = 30.0, ratio: float | None = None) -> Mesh:
    """Remesh so that edges grow from one side to the other.

    An inversion in a sphere keeps angles and changes scale with distance: triangles that are nearly
    equilateral and equal in the inverted space are nearly equilateral here, but of many sizes.
    """
    center = (mesh.vertices.max(0) + mesh.vertices.min(0)) / 2
    radius = np.linalg.norm(mesh.vertices - center, axis=1).max()
    ratio = ratio or log_uniform(rng, 2.5, 10)
    # From the nearest to the farthest point the squared distances have this ratio.
    root = np.sqrt(ratio)
    direction = rng.normal(size=3)
    direction /= np.linalg.norm(direction)
    pole = center + direction * radius * (root + 1) / (root - 1)

    def invert(points):
        away = points - pole
        return pole + away * (radius**2 / np.einsum("ij,ij->i", away, away))[:, None]

    there = isotropic(flipped(mesh.moved(invert(mesh.vertices))), target, angle)
    return flipped(there.moved(invert(there.vertices)))


def split_edges(mesh: Mesh, marked) -> Mesh:
    """Refine the marked triangles into four, and their neighbors so that no gap opens.

    Parameters
    ----------
    mesh : Mesh
        Of triangles.
    marked : (F,) bool array

    Returns
    -------
    Mesh
    """
    faces = mesh.corner_vertex.reshape(-1, 3).astype(np.int64)
    n = len(mesh.vertices)
    ends = np.stack([faces, np.roll(faces, -1, axis=1)], axis=-1)
    key = ends.min(-1) * n + ends.max(-1)
    split = np.unique(key[marked])
    place = np.minimum(np.searchsorted(split, key), max(len(split) - 1, 0))
    is_split = split[place] == key
    middle = np.where(is_split, n + place, -1)
    points = np.concatenate([mesh.vertices, (mesh.vertices[split // n] + mesh.vertices[split % n]) / 2])
    count = is_split.sum(1)
    result = [faces[count == 0]]
    a, b, c = faces[count == 3].T
    ab, bc, ca = middle[count == 3].T
    result += [np.stack(t, 1) for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))]
    # Turn the others so that the split edge, or the edge before the unsplit one, comes first.
    one, two = count == 1, count == 2
    turn = is_split[one].argmax(1)
    index = (turn[:, None] + np.arange(3)) % 3
    a, b, c = np.take_along_axis(faces[one], index, 1).T
    ab = np.take_along_axis(middle[one], index, 1)[:, 0]
    result += [np.stack(t, 1) for t in ((a, ab, c), (ab, b, c))]
    turn = (~is_split[two]).argmax(1) + 1
    index = (turn[:, None] + np.arange(3)) % 3
    a, b, c = np.take_along_axis(faces[two], index, 1).T
    ab, bc, _ = np.take_along_axis(middle[two], index, 1).T
    result += [np.stack(t, 1) for t in ((ab, b, bc), (a, ab, bc), (a, bc, c))]
    return from_faces(points, np.concatenate(result))


def refined_in_parts(rng, mesh: Mesh, target: int) -> Mesh:
    """Refine within random balls and patches until there are about ``target`` faces."""
    size = np.ptp(mesh.vertices, axis=0).max()
    center = mesh.vertices[rng.integers(len(mesh.vertices), size=rng.integers(1, 4))]
    radius = size * rng.uniform(0.1, 0.4, len(center))
    noise = Noise(rng)
    use_noise = chance(rng, 0.4)
    for _ in range(rng.integers(1, 4)):
        middle = mesh.vertices[mesh.corner_vertex.reshape(-1, 3)].mean(1)
        if use_noise:
            marked = noise(middle * (4 / size)) > rng.uniform(-0.1, 0.3)
        else:
            marked = (np.linalg.norm(middle[:, None] - center, axis=2) < radius).any(1)
        if len(marked) + 3 * marked.sum() > 1.8 * target:
            break
        mesh = split_edges(mesh, marked)
        radius = radius * rng.uniform(0.5, 0.9)
    return mesh


def with_hubs(rng, mesh: Mesh, n_hubs: int) -> Mesh:
    """Collapse neighbors into random vertices, which gives these up to about 50 neighbors.

    Nothing is collapsed that would fold a face, turn it by more than a little, or touch a border.
    """
    points = mesh.vertices
    faces = {f: tuple(face) for f, face in enumerate(mesh.corner_vertex.reshape(-1, 3).tolist())}
    around = [set() for _ in range(len(points))]
    for f, face in faces.items():
        for vertex in face:
            around[vertex].add(f)

    def ring(vertex):
        return {other for f in around[vertex] for other in faces[f]} - {vertex}

    def normal(face):
        a, b, c = points[list(face)]
        (ux, uy, uz), (vx, vy, vz) = b - a, c - a
        return np.array([uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx])

    def can_collapse(hub, victim, ring_of_victim):
        if len(ring_of_victim & ring(hub)) != 2 or len(ring_of_victim) != len(around[victim]):
            return False
        for f in around[victim]:
            if hub in faces[f]:
                continue
            before = normal(faces[f])
            after = normal(tuple(hub if v == victim else v for v in faces[f]))
            length = np.sqrt((before @ before) * (after @ after))
            if before @ after < 0.9 * length or length < 1e-4 * (before @ before):
                return False
        return True

    for hub in rng.permutation(len(points))[:n_hubs].tolist():
        wanted = int(rng.integers(10, 51))
        for _ in range(60):
            mine = ring(hub)
            if len(mine) >= wanted or len(mine) != len(around[hub]):
                break
            # The nearest first: the hub stays in the middle of its fan.
            by_distance = sorted(mine, key=lambda v: float(((points[v] - points[hub]) ** 2).sum()))
            for victim in by_distance:
                if can_collapse(hub, victim, ring(victim)):
                    break
            else:
                break
            for f in list(around[victim]):
                if hub in faces[f]:
                    for vertex in faces.pop(f):
                        around[vertex].discard(f)
                else:
                    faces[f] = tuple(hub if v == victim else v for v in faces[f])
                    around[hub].add(f)
            around[victim] = set()
    used, corner = np.unique(np.array(list(faces.values())), return_inverse=True)
    return from_faces(points[used], corner.reshape(-1, 3))


def dual(mesh: Mesh) -> Mesh:
    """Return the dual: a polygon around each inner vertex; the border is cut off."""
    faces = triangulated(mesh)
    start, end, face = half_edges(from_faces(mesh.vertices, faces))
    n = len(mesh.vertices)
    centers = mesh.vertices[faces].mean(1)
    following = {}
    lookup = dict(zip((start.astype(np.int64) * n + end).tolist(), face.tolist(), strict=True))
    # Around a vertex, face f is followed by the one across the edge that arrives at the vertex in f.
    for s, e, f in zip(start.tolist(), end.tolist(), face.tolist(), strict=True):
        following[(e, f)] = lookup.get(e * n + s, -1)
    polygons = []
    first = dict(zip(start.tolist(), face.tolist(), strict=True))
    for vertex, origin in first.items():
        ring, f = [origin], following[(vertex, origin)]
        while f not in (-1, origin):
            ring.append(f)
            f = following[(vertex, f)]
        if f == origin and len(ring) > 2:
            polygons.append(ring)
    result = from_lists(centers, polygons)
    used, corner = np.unique(result.corner_vertex, return_inverse=True)
    return Mesh(result.vertices[used], result.face_offset, corner.ravel().astype(np.int32))
