# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Slow twins of the stencil rules: members, dilation and walks, vertex by vertex on lists."""

from collections import defaultdict
from functools import cache

import numpy as np
from framelet.core.mesh.connectivity import connect
from meshes import faces_of
from twins import angle_cosine, fans

NEAR = ((0, -1), (-1, 0), (0, 1), (1, 0))
"""Directions of a quad lattice, in ring order."""

RING = ((-1, -1), (-1, 0), (0, 1), (1, 1), (1, 0), (0, -1))
"""Directions of a triangle lattice, in ring order."""


class MeshTwin:
    """Rings and faces of a mesh as lists; the order of the rings is tested with the connectivity."""

    def __init__(self, mesh):
        self.points = mesh.vertices.astype(np.float64)
        self.faces = faces_of(mesh)
        self.named = defaultdict(list)  # the faces around each vertex
        self.edge_faces = defaultdict(list)
        for face in self.faces:
            for k, v in enumerate(face):
                self.named[v].append(face)
                self.edge_faces[frozenset((v, face[k - 1]))].append(face)
        connectivity = connect(mesh)
        self.ring = [connectivity.ring_of(v).tolist() for v in range(mesh.n_vertices)]
        self.is_open, self.is_broken = [], []
        for v, fan in enumerate(fans(mesh)):
            self.is_open.append(fan is not None and fan[1])
            self.is_broken.append(fan is None and v in self.named)

    def sizes(self, v):
        """Return the set of the sizes of the faces around a vertex."""
        return {len(face) for face in self.named[v]}

    def is_closed(self, v):
        return v in self.named and not self.is_open[v] and not self.is_broken[v]

    def is_regular(self, v, size):
        """Return whether a vertex has a closed fan of four quads, or of six triangles."""
        return self.is_closed(v) and self.sizes(v) == {size} and len(self.ring[v]) == {4: 4, 3: 6}[size]

    def between(self, v, size):
        """Return the far members: opposite corners of quads, or tips across triangles; -1 for none."""
        ring = self.ring[v]
        result = []
        for k, w in enumerate(ring):
            x = ring[(k + 1) % len(ring)]
            if self.is_broken[v] or (self.is_open[v] and k == len(ring) - 1):
                result.append(-1)
                continue
            # The face between two ring vertices names v right between them.
            (face,) = [
                f for f in self.named[v] if {f[f.index(v) - 1], f[(f.index(v) + 1) % len(f)]} == {w, x}
            ]
            if size == 4:
                opposite = (face.index(v) + len(face) // 2) % len(face)
                result.append(face[opposite] if len(face) > 3 else -1)
                continue
            over = [f for f in self.edge_faces[frozenset((w, x))] if f is not face]
            is_pair = len(face) == 3 and len(over) == 1 and len(over[0]) == 3
            result.append(next(u for u in over[0] if u not in (w, x)) if is_pair else -1)
        return result


def neighbors_by(twin, size):
    """Return who is one step from whom: along edges, or (size 4) by a common face of up to eight corners."""
    near = defaultdict(set)
    for edge in twin.edge_faces:
        for v in edge:
            near[v] |= edge - {v}
    if size == 4:
        for face in twin.faces:
            if 4 <= len(face) <= 8:
                for v in face:
                    near[v] |= set(face) - {v}
    return near


def distances(near, start):
    """Return the number of steps from a vertex to all it reaches, by breadth-first search."""
    found, edge = {start: 0}, [start]
    while edge:
        following = []
        for v in edge:
            for w in near[v]:
                if w not in found:
                    found[w] = found[v] + 1
                    following.append(w)
        edge = following
    return found


def dilated(twin, v, members, near, level, far_distance):
    """Return the members of a vertex after dilation by the angle rule (section 3.2)."""
    steps = distances(near, v)
    for j in range(1, level + 1):
        ring = sorted(w for w, d in steps.items() if d == far_distance * 2**j)
        members = [_straightest(twin.points, v, p, ring) if p >= 0 and ring else -1 for p in members]
    return members


def _straightest(points, v, p, ring):
    """Return the x for which x - p turns least from p - v; of ties the lowest number."""

    leaps, spoke = points[ring] - points[p], points[p] - points[v]
    sizes = np.linalg.norm(leaps, axis=1) * (np.linalg.norm(spoke) or 1.0)
    cosine = leaps @ spoke / np.where(sizes > 0, sizes, 1.0)
    return ring[np.flatnonzero(cosine > cosine.max() - 1e-7)[0]]


class Walker:
    """Walks on a mesh, one edge at a time; a step is (from, to), and None where there is no way on."""

    def __init__(self, twin):
        self.twin = twin
        self.known = {}

    def straight(self, step):
        """Go straight on: opposite, or along the border, or at the largest angle."""
        if step not in self.known:
            self.known[step] = step and self._straight(*step)
        return self.known[step]

    def _straight(self, u, v):
        twin = self.twin
        ring = twin.ring[v]
        at = ring.index(u)
        if twin.is_regular(v, 4) or twin.is_regular(v, 3):
            return v, ring[(at + len(ring) // 2) % len(ring)]
        if twin.is_open[v]:
            return (v, ring[-1 - at]) if len(ring) > 2 and at in (0, len(ring) - 1) else None
        if not twin.is_closed(v) or len(ring) < 3:
            return None
        cosine = [angle_cosine(twin.points, v, u, w) if w != u else np.inf for w in ring]
        return v, ring[next(k for k, c in enumerate(cosine) if c < min(cosine) + 1e-7)]

    def walk(self, step, first, turn, second):
        """Return where `first` steps, a turn by so many places of the ring, and `second` steps lead."""
        for _ in range(first - 1):
            step = self.straight(step)
        if step and second:
            step = self._turned(*step, turn)
            for _ in range(second - 1):
                step = self.straight(step)
        return step and step[1]

    def _turned(self, u, v, turn):
        ring = self.twin.ring[v]
        place = ring.index(u) + turn
        if self.twin.is_broken[v] or len(ring) <= abs(turn):
            return None
        if self.twin.is_open[v] and not 0 <= place < len(ring):
            return None
        return v, ring[place % len(ring)]

    def corner(self, one, two, a, b, swing):
        """Return the two ends of the walks a along one and b along two, in either order."""
        first = self.walk(one, a, -swing, b) if a and one else None
        second = self.walk(two, b, swing, a) if b and two else None
        return [end for end in (first, second) if end is not None]


@cache
def sector_of(place, ring):
    """Return s, a, b with place = a ring[s] + b ring[s + 1], a > 0 and b >= 0, by trial."""
    for s, one in enumerate(ring):
        two = ring[(s + 1) % len(ring)]
        for a in range(1, 30):
            for b in range(30):
                if (a * one[0] + b * two[0], a * one[1] + b * two[1]) == place:
                    return s, a, b
    raise AssertionError(place)
