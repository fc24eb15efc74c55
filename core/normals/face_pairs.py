# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The pairwise frame on faces with equal weights, W, and what goes back through its adjoint, fused.

The stencil of a face is the face and its neighbors across edges: its taps. A pair i, j of k + 1 taps has the
coefficient (n_i - n_j) / (k + 1). The frame is that of `frames.valence_masks.PairwiseBank`, tight with
respect to the measure that the equal weights pull back to the faces.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..frames.mask_product import apply_matrix
from ..surface.locality import stable_order
from ..transform.adaptive_level import Neighbors
from .parts import empty_parts

TAPS_AT_ONCE = 2**15
"""Taps that a chunk may hold, so that its arrays stay in the cache at any number of edges."""

CHUNKS_AT_ONCE = 4
"""Chunks in a piece of work for a thread."""

LARGEST_MATRIX = 8
"""Taps up to which the transpose of the differences is a matrix product."""

Change = Callable[[int, NDArray[np.floating]], NDArray[np.floating]]
"""`change(index, apart)` returns what the differences n_i - n_j of a chunk, shape (3, pairs, n), become.

It may use their memory."""


class _Chunk(NamedTuple):
    """Faces with as many neighbors: their taps, shape (k + 1, n), and where these stand among all taps."""

    taps: NDArray[np.int32]
    place: slice


class FacePairs:
    """Differences of all pairs of taps of all faces.

    Parameters
    ----------
    neighbors : Neighbors
        Faces across edges.
    blocks : Blocks
        Threads to work on.
    """

    def __init__(self, neighbors: Neighbors, blocks: Blocks) -> None:
        self._blocks = blocks.sized(CHUNKS_AT_ONCE)
        counts = np.diff(neighbors.offset)
        self.n_faces = len(counts)
        groups = _groups(counts, 1)
        taps = empty_parts([(count + 1, len(part)) for count, part in groups], np.int32)
        ends = np.cumsum([own.size for own in taps]).tolist()
        self._n_slots = ends[-1] if ends else 0
        places = (slice(end - own.size, end) for own, end in zip(taps, ends, strict=True))
        self.chunks = list(map(_Chunk, taps, places))

        def fill(start: int, stop: int) -> None:
            for (count, part), own in zip(groups[start:stop], taps[start:stop], strict=True):
                own[0] = part
                own[1:] = neighbors.neighbor[neighbors.offset[part] + np.arange(count)[:, None]]

        self._blocks.run(fill, len(groups))
        self._set_sources()

    def _set_sources(self) -> None:
        """Find where each face stands among all taps, and the measure."""
        taps = np.concatenate([chunk.taps.ravel() for chunk in self.chunks])
        counts, order = self._blocks.together(
            lambda: np.bincount(taps, minlength=self.n_faces), lambda: stable_order(taps, self.n_faces)
        )
        sizes = {len(chunk.taps) for chunk in self.chunks}
        # On closed meshes of one kind of faces each is a tap as often as it has taps, and the measure is 1.
        self._is_even = len(sizes) == 1 and bool((counts == min(sizes)).all())
        self.measure: NDArray[np.floating] = np.ones(self.n_faces)
        if not self._is_even:
            weights = np.concatenate([np.full(c.taps.size, 1.0 / len(c.taps)) for c in self.chunks])
            self.measure = np.bincount(taps, weights, self.n_faces).astype(np.float64)
        begin = np.cumsum(counts) - counts
        groups = _groups(counts, 0)
        places = empty_parts([(count, len(part)) for count, part in groups], np.int32)

        def fill(start: int, stop: int) -> None:
            for (count, part), own in zip(groups[start:stop], places[start:stop], strict=True):
                np.take(order, begin[part] + np.arange(count)[:, None], out=own, mode="clip")

        self._blocks.run(fill, len(groups))
        self._sources = list(zip((part for _, part in groups), places, strict=True))

    def visit(
        self, normals: NDArray[np.floating], use: Callable[[int, NDArray[np.floating]], object]
    ) -> None:
        """Call a function with the differences n_i - n_j of each chunk, on threads."""

        def kernel(start: int, stop: int) -> None:
            for index in range(start, stop):
                use(index, _differences(normals.take(self.chunks[index].taps, axis=1)))

        self._blocks.run(kernel, len(self.chunks))

    def returned(self, normals: NDArray[np.floating], change: Change) -> Returned:
        """Take the differences of normals, shape (3, F), change them, and return W* of them.

        W* is the adjoint with respect to the measure, for differences that are not yet divided by k + 1.
        """
        slots = np.empty((3, self._n_slots), normals.dtype)

        def use(index: int, apart: NDArray[np.floating]) -> None:
            chunk = self.chunks[index]
            back = slots[:, chunk.place].reshape(3, *chunk.taps.shape)
            _add_up(change(index, apart), back)

        self.visit(normals, use)
        return Returned(slots, self._sources, None if self._is_even else self.measure, self._blocks)


class Returned:
    """What goes back through the adjoint, still tap by tap."""

    def __init__(
        self,
        slots: NDArray[np.floating],
        sources: list[tuple[NDArray[np.int32], NDArray[np.int32]]],
        measure: NDArray[np.floating] | None,
        blocks: Blocks,
    ) -> None:
        self._slots, self._sources, self._measure, self._blocks = slots, sources, measure, blocks

    def for_faces(self, use: Callable[[NDArray[np.int32] | slice, NDArray[np.floating]], None]) -> None:
        """Call `use(faces, values)` for parts of the faces, with values of shape (3, n), on threads."""

        def kernel(start: int, stop: int) -> None:
            for faces, places in self._sources[start:stop]:
                total = self._slots.take(places, axis=1).sum(axis=1)
                part = slice(int(faces[0]), int(faces[-1]) + 1)
                chosen = part if part.stop - part.start == len(faces) else faces
                if self._measure is not None:
                    total /= self._measure[chosen].astype(total.dtype)
                use(chosen, total)

        self._blocks.run(kernel, len(self._sources))


def _groups(counts: NDArray[np.integer], n_more: int) -> list[tuple[int, NDArray[np.int32]]]:
    """Return faces that have as many of something as pairs (count, faces), few enough for the cache.

    Of each face there are `n_more` more than the count.
    """
    groups = []
    for count in np.flatnonzero(np.bincount(counts)).tolist():
        alike = np.flatnonzero(counts == count).astype(np.int32)
        size = max(1, TAPS_AT_ONCE // (count + n_more))
        groups += [(count, part) for part in np.split(alike, range(size, len(alike), size))]
    return groups


def _differences(taps: NDArray[np.floating]) -> NDArray[np.floating]:
    """Return all differences of the taps i < j, shape (3, pairs, n), of taps (3, k + 1, n)."""
    n_taps = taps.shape[1]
    apart = np.empty((3, n_taps * (n_taps - 1) // 2, taps.shape[2]), taps.dtype)
    begin = 0
    for slot in range(n_taps - 1):
        end = begin + n_taps - 1 - slot
        np.subtract(taps[:, slot : slot + 1], taps[:, slot + 1 :], out=apart[:, begin:end])
        begin = end
    return apart


def _add_up(apart: NDArray[np.floating], taps: NDArray[np.floating]) -> None:
    """Set taps, shape (3, k + 1, n), to what the transpose of `_differences` gives, over (k + 1)^2."""
    n_taps = taps.shape[1]
    if n_taps <= LARGEST_MATRIX:
        apply_matrix(_transposed_differences(n_taps).astype(apart.dtype), apart, taps)
        return
    taps[:, 0] = 0
    begin = 0
    for slot in range(n_taps - 1):
        end = begin + n_taps - 1 - slot
        part = apart[:, begin:end]
        taps[:, slot] += part.sum(axis=1)
        if slot:
            taps[:, slot + 1 :] -= part
        else:
            np.negative(part, out=taps[:, 1:])
        begin = end
    taps *= taps.dtype.type(1.0 / n_taps**2)


@cache
def _transposed_differences(n_taps: int) -> NDArray[np.float64]:
    """Return the matrix, shape (k + 1, pairs), that adds up differences, over (k + 1)^2."""
    identity = np.broadcast_to(np.eye(n_taps), (3, n_taps, n_taps))
    return np.ascontiguousarray(_differences(identity)[0].T) / n_taps**2
