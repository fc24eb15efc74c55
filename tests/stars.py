# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Sheets that are a grid everywhere but at one vertex: sectors of a lattice glued around it."""

from functools import cache

import numpy as np
from checks import read_only, wild_mesh
from framelet.core.mesh.surface_mesh import SurfaceMesh


@cache
def star(valence, reach, sides):
    """Return a sheet around vertex 0 and the numbers of its vertices by (sector, a, b).

    A vertex lies a steps along spoke `sector` and b along the next one, counterclockwise; all vertices but 0
    and those on the border are regular. `sides` is 3 for triangles, 4 for quads. With the valence of the
    lattice the sheet is flat, otherwise a cone.
    """
    number, places = {}, [np.zeros(3)]
    turn = 2 * np.pi / valence
    spokes = [
        np.array([np.cos(k * turn), np.sin(k * turn), 0.1 * (valence - 12 / sides)]) for k in range(valence)
    ]

    def ends(a, b):
        return a + b <= reach if sides == 3 else max(a, b) <= reach

    for k in range(valence):
        for a in range(1, reach + 1):
            for b in range(reach + 1):
                if ends(a, b):
                    number[k, a, b] = len(places)
                    places.append(a * spokes[k] + b * spokes[(k + 1) % valence])

    def at(k, a, b):
        if a == b == 0:
            return 0
        return number[k, a, b] if a else number[(k + 1) % valence, b, 0]

    faces = []
    for k in range(valence):
        for a in range(reach):
            for b in range(reach):
                if sides == 4:
                    faces.append([at(k, a, b), at(k, a + 1, b), at(k, a + 1, b + 1), at(k, a, b + 1)])
                elif a + b < reach:
                    faces.append([at(k, a, b), at(k, a + 1, b), at(k, a, b + 1)])
                    if a + b < reach - 1:
                        faces.append([at(k, a + 1, b), at(k, a + 1, b + 1), at(k, a, b + 1)])
    table = {
        (k, a, b): at(k, a, b)
        for k in range(valence)
        for a in range(reach + 1)
        for b in range(reach + 1)
        if ends(a, b)
    }
    return read_only(SurfaceMesh.from_faces(places, faces)), table


def relabeled(mesh, rng):
    """Return the mesh with its vertices and faces renumbered and its faces' corners turned, and old[new]."""
    old = rng.permutation(mesh.n_vertices)
    new = np.argsort(old)
    faces = [
        new[mesh.corner_vertex[a:b]].tolist()
        for a, b in zip(mesh.face_offset, mesh.face_offset[1:], strict=False)
    ]
    faces = [faces[f] for f in rng.permutation(len(faces))]
    faces = [face[turn:] + face[:turn] for face in faces for turn in [int(rng.integers(max(len(face), 1)))]]
    is_loose = np.bincount(mesh.corner_edge, minlength=mesh.n_edges) == 0
    return wild_mesh(mesh.vertices[old], faces, new[mesh.edges[is_loose]]), old
