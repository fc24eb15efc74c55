# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pairs of half-edges, and what stands at the next corner, against loops over faces."""

import numpy as np
import pytest
from checks import wild_mesh
from framelet.core.blocks import Blocks
from framelet.core.mesh.half_edges import find_half_edges, last_corners, shifted
from framelet.core.mesh.surface_mesh import SurfaceMesh
from meshes import MESHES, faces_of

SPOILED = {
    "three at an edge": lambda: SurfaceMesh.from_faces(
        np.eye(5, 3), [(0, 1, 2), (1, 0, 3), (0, 1, 4), (2, 1, 4)], loose_edges=[(3, 4)]
    ),
    "vertex twice in a row": lambda: wild_mesh(np.eye(4, 3), [(0, 1, 1, 2), (2, 1, 3)]),
    "vertex three times": lambda: wild_mesh(np.eye(3), [(0, 0, 0), (0, 1, 2)]),
    "both sides": lambda: SurfaceMesh.from_faces(np.eye(3), [(0, 1, 2), (2, 1, 0)]),
    "all kinds of faces": lambda: SurfaceMesh.from_faces(
        np.eye(7, 3), [(0, 1, 2), (2, 1, 3, 4), (4, 3, 5, 6, 0)]
    ),
}


def pairs_by_a_loop(mesh):
    """Return partner and number of faces for each corner, by lists of the corners at each edge."""
    at_edge = [[] for _ in range(mesh.n_edges)]
    for corner, edge in enumerate(mesh.corner_edge.tolist()):
        at_edge[edge].append(corner)
    partner = [-1] * mesh.n_corners
    for (first, second), corners in zip(mesh.edges.tolist(), at_edge, strict=True):
        if len(corners) == 2 and first != second:
            partner[corners[0]], partner[corners[1]] = corners[::-1]
    return partner, [len(corners) for corners in at_edge]


@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.parametrize("name", [*MESHES, *SPOILED])
def test_half_edges_match_a_loop(name, threads):
    mesh = {**MESHES, **SPOILED}[name]()
    with Blocks(threads, block_size=7) as blocks:
        found = find_half_edges(mesh, blocks)
    partner, counts = pairs_by_a_loop(mesh)
    assert found.partner.tolist() == partner
    assert found.edge_face_count.tolist() == counts
    target = [v for face in faces_of(mesh) for v in face[1:] + face[:1]]
    assert found.target.tolist() == target
    owner = mesh.corner_vertex.tolist()
    inconsistent = [p >= 0 and owner[p] == owner[c] for c, p in enumerate(partner)]
    assert found.is_inconsistent.tolist() == inconsistent


@pytest.mark.parametrize("name", [*MESHES, *SPOILED])
def test_shifts_go_around_within_faces(name, rng):
    mesh = {**MESHES, **SPOILED}[name]()
    values = rng.integers(0, 1000, mesh.n_corners).astype(np.int32)
    begin = 0
    forward, backward = (shifted(values, mesh, step, Blocks(1, 5)).tolist() for step in (1, -1))
    for face in faces_of(mesh):
        part = values[begin : begin + len(face)].tolist()
        assert forward[begin : begin + len(face)] == part[1:] + part[:1]
        assert backward[begin : begin + len(face)] == part[-1:] + part[:-1]
        begin += len(face)


def test_the_first_and_the_last_corner_stay(rng):
    owner = rng.integers(0, 50_000, 200_000).astype(np.int32)
    owner[owner == 7] = 8
    last, first = np.full(50_000, -1), np.full(50_000, -1)
    for corner, at in enumerate(owner.tolist()):
        last[at] = corner
        first[at] = corner if first[at] < 0 else first[at]
    assert last_corners(owner, 50_000).tolist() == last.tolist()
    assert last_corners(owner, 50_000, is_descending=True).tolist() == first.tolist()
    assert last[7] == first[7] == -1
