# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A level whose masks fit the valence of each vertex; its adjoint is its exact inverse."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache, cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import DTypeLike, NDArray

from ..blocks import Blocks
from ..frames.valence_masks import HarmonicBank, PairwiseBank
from ..mesh.locality import stable_order
from ..mesh.ragged import Chunk, Ragged
from ..stencils.ring_points import RingPoints
from .level import Bands, Points, Sites, Visit


class Neighbors(NamedTuple):
    """The stencil of every site: the site itself, then its neighbors.

    Attributes
    ----------
    rows : Ragged
        The neighbors of each of N sites, int32.
    is_ordered : ndarray, shape (N,), bool
        Whether they are in ring order.
    is_kept : ndarray, shape (N,), bool
        Sites whose details shrinkage leaves alone.
    """

    rows: Ragged
    is_ordered: NDArray[np.bool_]
    is_kept: NDArray[np.bool_]


def ring_neighbors(ring_points: RingPoints, boundary: str) -> Neighbors:
    """Return one-rings as neighbors, without ring points that were not found.

    Unless the boundary is FREE, the one-sided rings of boundary vertices are kept, as shrinking them would
    pull the border inwards.
    """
    connectivity = ring_points.connectivity
    is_ordered = ~connectivity.is_non_manifold
    is_kept = is_ordered & connectivity.is_boundary & (boundary != "FREE")
    rows = Ragged(connectivity.ring_offset, ring_points.near)
    return Neighbors(rows.kept(ring_points.near >= 0), is_ordered, is_kept)


class _Taps(NamedTuple):
    """Vertices with the same number K of neighbors, and their taps."""

    bank: HarmonicBank | PairwiseBank
    taps: NDArray[np.int32]
    """The vertices and their neighbors, shape (K + 1, n)."""
    place: slice
    """Where its taps stand in the flat list of all taps."""
    unpenalized: slice

    @property
    def vertices(self) -> NDArray[np.int32]:
        """The vertices, shape (n,)."""
        return self.taps[0]


class AdaptiveLevel:
    """One level of the frames in `frames.valence_masks`.

    Parameters
    ----------
    neighbors : Neighbors
        The stencils.
    family : type
        `HarmonicBank` or `PairwiseBank`.
    out_measure : ndarray, shape (N,)
        Measure m' of this level's coefficients.
    dtype : dtype
        Precision to work in.
    """

    def __init__(
        self,
        neighbors: Neighbors,
        family: type[HarmonicBank] | type[PairwiseBank],
        out_measure: NDArray[np.floating],
        dtype: DTypeLike,
        blocks: Blocks,
    ) -> None:
        self._blocks = blocks.with_block_size(1)
        self._slots_per_chunk = 4 * blocks.block_size  # so that arrays stay in the cache at any valence
        self._dtype = np.dtype(dtype)
        self.n_sites = self.n_vertices = len(neighbors.is_kept)
        self._chunks = _make_chunks(neighbors, family, self._slots_per_chunk)
        self._n_slots = self._chunks[-1].place.stop
        self.sites: Sites = [chunk.vertices for chunk in self._chunks]
        self.chunk_bands = [chunk.bank.n_bands - 1 for chunk in self._chunks]
        self.n_high = max(self.chunk_bands)
        self.is_tight = True  # masks that fit the valence are so on every mesh
        self._out_measure = out_measure.astype(self._dtype, copy=False)
        self._is_weighted = bool((out_measure != 1.0).any())

    @cached_property
    def measure(self) -> NDArray[np.floating]:
        """The measure m pulled back to this level's input, shape (N,), in the precision of the level."""
        measure = np.zeros(self.n_sites)
        for chunk in self._chunks:
            flow = chunk.bank.weights[:, None] * self._out_measure[chunk.vertices]
            measure += np.bincount(chunk.taps.ravel(), flow.ravel(), self.n_sites)
        return measure.astype(self._dtype)

    def prepare(self) -> None:
        """Find what `forward` and `backward` need."""
        self._sources  # noqa: B018

    @cached_property
    def _sources(self) -> list[Chunk]:
        """The places of the taps of each vertex in the flat list of all taps, by as many taps each."""
        taps = np.concatenate([chunk.taps.ravel() for chunk in self._chunks])
        places = Ragged.of_lengths(
            np.bincount(taps, minlength=self.n_sites), stable_order(taps, self.n_sites)
        )
        # Every vertex is at least its own tap, so that no count is zero.
        vertices = np.arange(self.n_sites, dtype=np.int32)
        return list(places.chunks(vertices, lambda count: self._slots_per_chunk // count))

    def _gathered(self, slots: NDArray[np.floating]) -> Points:
        """Sum values of all taps, shape (C, slots), to the vertices under them, and divide by the measure."""
        return self._summed(slots, np.divide(1.0, self.measure, dtype=slots.dtype))

    def _summed(self, slots: NDArray[np.floating], share: NDArray[np.floating] | None = None) -> Points:
        """Sum values of all taps, shape (C, slots), to the vertices under them, times a share (N,)."""
        result = np.empty((len(slots), self.n_sites), slots.dtype)
        sources = self._sources

        def kernel(index: int, _: int) -> None:
            vertices, places = sources[index]
            total = slots.take(places, axis=1).sum(axis=1)
            if share is not None:
                total *= share[vertices]
            result[:, vertices] = total

        self._blocks.run(kernel, len(sources))
        return result

    def _taps_of(self, chunk: _Taps, coefficients: NDArray[np.floating]) -> NDArray[np.floating]:
        """Return M' alpha times the measure, shape (3, taps of the chunk)."""
        taps = chunk.bank.apply_transposed(coefficients)
        if self._is_weighted:
            taps *= self._out_measure[chunk.vertices].astype(taps.dtype)
        return taps.reshape(3, -1)

    def group_starts(self, chunk: int) -> NDArray[np.intp] | None:
        """Return where groups of bands begin that are shrunk as one; see `Level`."""
        return self._chunks[chunk].bank.group_starts

    def unpenalized(self, chunk: int) -> slice:
        """Return the bands of frequency 1, or all on a border; see `Level`."""
        return self._chunks[chunk].unpenalized

    def forward(
        self, low: Points, visit: Visit, *, needs_low: bool = True
    ) -> tuple[Points, NDArray[np.floating]]:
        """Analyze a surface and begin to rebuild it; see `Level`."""
        next_low = np.empty_like(low) if needs_low else low
        slots = np.empty((3, self._n_slots), low.dtype)

        def kernel(index: int, _: int) -> None:
            chunk = self._chunks[index]
            coefficients = chunk.bank.apply(low.take(chunk.taps, axis=1))
            if needs_low:
                next_low[:, chunk.vertices] = coefficients[:, 0]
            visit(index, coefficients[:, 1:])
            coefficients[:, 0] = 0
            slots[:, chunk.place] = self._taps_of(chunk, coefficients)

        self._blocks.run(kernel, len(self._chunks))
        return next_low, self._gathered(slots)

    def low_pass(self, low: Points) -> Points:
        """Return the low-pass of a surface, shape (3, N), without its bands."""
        result = np.empty_like(low)

        def kernel(index: int, _: int) -> None:
            chunk = self._chunks[index]
            weights = chunk.bank.weights.astype(low.dtype)
            taps = low.take(chunk.taps, axis=1)
            taps *= weights[:, None]
            result[:, chunk.vertices] = taps.sum(axis=1)

        self._blocks.run(kernel, len(self._chunks))
        return result

    def pending(self, chunks: Sequence[Bands]) -> NDArray[np.floating]:
        """Return what given high bands add to the rebuilt surface; see `Level`."""
        slots = np.empty((3, self._n_slots), self._dtype)
        for chunk, high in zip(self._chunks, chunks, strict=True):
            coefficients = np.concatenate((np.zeros((3, 1, high.shape[2]), self._dtype), high), axis=1)
            slots[:, chunk.place] = self._taps_of(chunk, coefficients)
        return self._gathered(slots)

    def backward(self, next_low: Points | None, pending: NDArray[np.floating]) -> Points:
        """Rebuild the surface by the adjoint with respect to the measures; see `Level`."""
        if next_low is None:
            return pending
        # One coordinate after the other: so there is memory for one only.
        slots = np.empty((1, self._n_slots), pending.dtype)
        result = pending.copy()
        for axis in range(3):
            low = next_low[axis]

            def kernel(index: int, _: int, low: NDArray[np.floating] = low) -> None:
                chunk = self._chunks[index]
                own = low.take(chunk.vertices)
                if self._is_weighted:
                    own *= self._out_measure.take(chunk.vertices)
                weights = chunk.bank.weights.astype(slots.dtype)[:, None]
                np.multiply(weights, own, out=slots[0, chunk.place].reshape(chunk.taps.shape))

            self._blocks.run(kernel, len(self._chunks))
            result[axis] += self._gathered(slots)[0]
        return result

    def weighted_adjoint(self, next_low: Points, chunks: Sequence[Bands]) -> Points:
        """Apply the adjoint with respect to the measures, which is the inverse."""
        return self.backward(next_low, self.pending(chunks))

    def adjoint(self, next_low: Points, chunks: Sequence[Bands]) -> Points:
        """Apply the transposed matrix of this level."""
        slots = np.empty((3, self._n_slots), self._dtype)
        for chunk, high in zip(self._chunks, chunks, strict=True):
            coefficients = np.concatenate((next_low[:, None, chunk.vertices], high), axis=1)
            slots[:, chunk.place] = chunk.bank.apply_transposed(coefficients).reshape(3, -1)
        return self._summed(slots)


def _make_chunks(
    neighbors: Neighbors, family: type[HarmonicBank] | type[PairwiseBank], slots_per_chunk: int
) -> list[_Taps]:
    """Sort the sites by the number of neighbors, by whether these are ordered, and by what is kept."""

    @cache
    def bank_of(valence: int, is_ordered: bool) -> HarmonicBank | PairwiseBank:
        return HarmonicBank(valence, is_ordered) if issubclass(family, HarmonicBank) else family(valence)

    chunks: list[_Taps] = []
    begin = 0
    for is_ordered in (True, False):
        for is_kept in (False, True):
            kind = (neighbors.is_ordered == is_ordered) & (neighbors.is_kept == is_kept)
            sites = np.flatnonzero(kind).astype(np.int32)

            def at_once(valence: int, is_ordered: bool = is_ordered) -> int:
                return slots_per_chunk // bank_of(valence, is_ordered).n_bands

            for rows, items in neighbors.rows.chunks(sites, at_once):
                bank, taps = bank_of(len(items), is_ordered), np.concatenate((rows[None], items))
                place = slice(begin, begin + taps.size)
                chunks.append(_Taps(bank, taps, place, slice(None) if is_kept else bank.unpenalized))
                begin = place.stop
    return chunks
