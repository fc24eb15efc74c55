# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Walking on a mesh as on a grid: straight on and turns (sections 3.3 and 5.3).

A *step* is a directed edge: the entry of the one-ring table that leads from its owner to a neighbor; -1 is no
step. At a regular vertex straight on is the opposite edge. At an irregular one it is the edge that makes the
largest angle with the one arrived by; on a border it is the other border edge, except at corners, and none
from inside.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..mesh.connectivity import Connectivity
from .straight import HIGHEST_VALENCE, TIE

Steps = NDArray[np.int64]


class Grid:
    """Steps of a mesh and how they go on.

    Parameters
    ----------
    connectivity : Connectivity
        One-rings.
    vertices : ndarray, shape (N, 3)
        Positions; they decide what is straight at irregular vertices.
    """

    def __init__(self, connectivity: Connectivity, vertices: NDArray[np.floating]) -> None:
        self._connectivity = connectivity
        self._owner = np.repeat(np.arange(connectivity.n_vertices), connectivity.valence)
        keys = self._owner * connectivity.n_vertices + connectivity.ring
        self._order = np.argsort(keys)
        self._sorted_keys = keys[self._order]
        self._is_open = connectivity.is_boundary & ~connectivity.is_non_manifold
        # One more entry at the end of each, so that step -1 leads to -1.
        self._target = np.append(connectivity.ring, -1)
        self._back = np.append(self.find(connectivity.ring, self._owner), -1)
        self._straight = np.append(self._find_straight(vertices), -1)
        self._powers = [self._straight]

    def find(self, start: NDArray[np.integer], stop: NDArray[np.integer]) -> Steps:
        """Return the steps between neighbors, -1 where two vertices are not neighbors."""
        if not len(self._sorted_keys):
            return np.full(len(start), -1)
        keys = np.asarray(start, np.int64) * self._connectivity.n_vertices + stop
        place = np.minimum(np.searchsorted(self._sorted_keys, keys), len(self._sorted_keys) - 1)
        return np.where(self._sorted_keys[place] == keys, self._order[place], -1)

    def target(self, steps: Steps) -> NDArray[np.int64]:
        """Return the vertices that steps lead to, -1 for no step."""
        return self._target[steps]

    def march(self, steps: Steps, count: int) -> Steps:
        """Go straight on `count` times, in as many table look-ups as the count has binary digits."""
        for bit in range(count.bit_length()):
            if bit == len(self._powers):
                last = self._powers[-1]
                self._powers.append(np.append(last[last[:-1]], -1))
            if count >> bit & 1:
                steps = self._powers[bit][steps]
        return steps

    def turn(self, steps: Steps, amount: int) -> Steps:
        """Go on by the edge `amount` places behind the edge arrived by, in ring order; -1 beyond a border."""
        ring_offset, valence = self._connectivity.ring_offset, self._connectivity.valence
        vertex = self.target(steps)
        back = self._back[steps]
        usable = (back >= 0) & ~self._connectivity.is_non_manifold[vertex] & (valence[vertex] > abs(amount))
        place = back - ring_offset[vertex] + amount
        inside = (place >= 0) & (place < valence[vertex])
        place = np.where(self._is_open[vertex], place, place % np.maximum(valence[vertex], 1))
        usable &= inside | ~self._is_open[vertex]
        return np.where(usable, ring_offset[vertex] + place, -1)

    def sector(
        self, first: Steps, second: Steps, swing: int, ahead: int, aside: int
    ) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Find the point `ahead` steps along one direction and `aside` along the next one in ring order.

        Parameters
        ----------
        first, second : ndarray, shape (n,)
            Steps from each site in the two directions.
        swing : int
            Places between the edge arrived by and the one to turn into: 1 on quads, 2 on triangles.
        ahead, aside : int
            Number of steps along `first` and `second`, not both 0.

        Returns
        -------
        ndarray, ndarray, shape (n,)
            Vertices found along `first` first, and along `second` first; -1 where the walk ends too early.
        """
        nothing = np.full(len(first), -1)
        one = two = nothing
        if ahead:
            steps = self.march(first, ahead - 1)
            one = self.target(self.march(self.turn(steps, -swing), aside - 1) if aside else steps)
        if aside:
            steps = self.march(second, aside - 1)
            two = self.target(self.march(self.turn(steps, swing), ahead - 1) if ahead else steps)
        return one, two

    def orbit(self, spokes: Steps, swing: int, ahead: int, aside: int) -> list[NDArray[np.int64]]:
        """Return where all walks of one shape end that begin with the given steps, each shape (n,).

        The walks turn to either side, and go `ahead` or `aside` steps first; -1 where one ends too early.
        """
        if not aside:
            return [self.target(self.march(spokes, ahead - 1))]
        legs = [(ahead, aside)] if ahead == aside else [(ahead, aside), (aside, ahead)]
        return [
            self.target(self.march(self.turn(self.march(spokes, first - 1), way), second - 1))
            for first, second in legs
            for way in (-swing, swing)
        ]

    def _find_straight(self, vertices: NDArray[np.floating]) -> Steps:
        """Return the step that goes straight on after each step."""
        connectivity = self._connectivity
        vertex, back = connectivity.ring, self._back[:-1]
        offset, valence = connectivity.ring_offset[vertex], connectivity.valence[vertex]
        place = back - offset
        following = np.full(len(vertex), -1)
        is_regular = connectivity.is_regular_triangle() | connectivity.is_regular_quad()
        is_closed = ~connectivity.is_boundary & ~connectivity.is_non_manifold
        regular = is_regular[vertex]
        following[regular] = (offset + (place + valence // 2) % np.maximum(valence, 1))[regular]
        # A border vertex with one face is a corner, where no line goes straight on.
        rim = self._is_open[vertex] & (valence > 2) & ((place == 0) | (place == valence - 1))
        following[rim] = (offset + valence - 1 - place)[rim]
        irregular = is_closed & ~is_regular
        by_angle = self._straightest(vertices, irregular)
        chosen = irregular[vertex]
        following[chosen] = by_angle[back[chosen]]
        following[back < 0] = -1
        return following

    def _straightest(self, vertices: NDArray[np.floating], wanted: NDArray[np.bool_]) -> Steps:
        """Return, for each ring entry of the wanted vertices, the entry at the largest angle from it."""
        connectivity = self._connectivity
        opposite = np.full(len(connectivity.ring), -1)
        for valence in np.unique(connectivity.valence[wanted]):
            if valence < 3 or valence > HIGHEST_VALENCE:
                continue
            group = np.flatnonzero(wanted & (connectivity.valence == valence))
            for part in np.array_split(group, max(1, len(group) * int(valence) ** 2 // 2**20)):
                entries = connectivity.ring_offset[part, None] + np.arange(valence)
                spokes = vertices[connectivity.ring[entries]].astype(np.float64) - vertices[part, None]
                length = np.linalg.norm(spokes, axis=2, keepdims=True)
                spokes /= np.where(length > TIE * length.max(axis=1, keepdims=True), length, np.inf)
                cosine = np.rint(np.einsum("nic,njc->nij", spokes, spokes) / TIE)
                cosine[:, np.arange(valence), np.arange(valence)] = np.inf
                opposite[entries] = connectivity.ring_offset[part, None] + cosine.argmin(axis=2)
        return opposite
