# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A level with the masks of a filter bank: alpha = M D, rebuilt by the rows v with v M = delta."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import DTypeLike, NDArray

from ..blocks import Blocks
from ..errors import FrameError
from ..frames import FilterBank
from ..frames.mask_product import apply_matrix, hadamard_bands, is_hadamard
from ..mesh.ragged import starts
from ..scratch import Scratch
from ..stencils import Stencil
from .level import Bands, Points, Sites, Visit

TAPS_PER_BLOCK = 2**18
"""Taps that a block may hold, so that the arrays of wide masks stay in the cache too."""


def _block_size(n_taps: int) -> int:
    """Return the number of sites in a block, a power of two."""
    return 2 ** max(10, (TAPS_PER_BLOCK // n_taps).bit_length() - 1)


class LatticeLevel:
    """One level of (3.6), (3.7) for vertex-centered and cell-centered banks.

    Because the low-pass entry of every row v is 1, rebuilding is one sum: the low-pass, averaged over the
    sites in which a vertex is a central tap, plus the same average of the high bands times v. A vertex that
    is nowhere a central tap (cell-centered banks on borders) keeps its position in the low-pass, and so
    nothing is lost there either.

    Parameters
    ----------
    stencil : Stencil
        Points under the masks.
    bank : FilterBank
        The masks.
    dtype : dtype
        Precision to work in.
    bands : ndarray of int, optional
        Bands to compute, the low-pass first; all by default.
    are_shifts : bool
        Whether stencils of regular vertices are shifts of each other. On coarser levels, where they are found
        across wider rings of a curved surface, they are not.
    """

    def __init__(
        self,
        stencil: Stencil,
        bank: FilterBank,
        dtype: DTypeLike,
        blocks: Blocks,
        bands: NDArray[np.intp] | None = None,
        are_shifts: bool = True,
    ) -> None:
        if stencil.n_taps != bank.n_taps:
            raise FrameError(f"The stencil has {stencil.n_taps} taps, but {bank.name} has {bank.n_taps}.")
        bands = np.arange(bank.n_bands) if bands is None else bands
        self.stencil = stencil
        blocks = blocks.with_block_size(min(blocks.block_size, _block_size(stencil.n_taps)))
        self._blocks = blocks
        self._masks = bank.masks[bands]
        self._typed_masks = self._masks.astype(dtype)
        self._is_hadamard = stencil.is_vertex_centered and is_hadamard(self._masks)
        self._rows = bank.reconstruction[:, bands].astype(dtype)
        self.n_sites, self.n_vertices = stencil.n_sites, stencil.n_vertices
        starts = range(0, self.n_sites, blocks.block_size)
        self.sites: Sites = [slice(start, min(start + blocks.block_size, self.n_sites)) for start in starts]
        self.n_high = len(self._masks) - 1
        self.chunk_bands = [self.n_high] * len(self.sites)
        self._dtype = np.dtype(dtype)
        self._scratch = Scratch(dtype)
        self.is_tight = (
            stencil.is_vertex_centered
            and bank.is_tight
            and len(bands) == bank.n_bands
            and not stencil.is_irregular.any()
            and are_shifts
        )
        self._incidence = None if stencil.is_vertex_centered else _Incidence(stencil, len(self._rows), dtype)

    def group_starts(self, chunk: int) -> NDArray[np.intp] | None:
        """Return None: every band is shrunk by itself."""
        return None

    def unpenalized(self, chunk: int) -> slice:
        """Return no bands: first differences never reach the surface, as v is zero there."""
        return slice(0, 0)

    def forward(
        self, low: Points, visit: Visit, *, needs_low: bool = True
    ) -> tuple[Points, NDArray[np.floating]]:
        """Analyze a surface and begin to rebuild it; see `Level`."""
        stencil, scratch = self.stencil, self._scratch
        points = scratch("points", 3, stencil.n_points)

        def copy(start: int, stop: int) -> None:
            points[:, start:stop] = low[:, start:stop]

        self._blocks.run(copy, stencil.n_vertices)
        stencil.fill_virtual(points, self._blocks)
        # Averages over sites need a low-pass where a vertex is in none.
        needs_low = needs_low or self._incidence is not None
        site_low = np.empty((3, stencil.n_sites), points.dtype) if needs_low else None
        detail = scratch("detail", len(self._rows), 3, stencil.n_sites)  # sums of the high bands

        def kernel(start: int, stop: int) -> None:
            own_low = None if site_low is None else site_low[:, start:stop]
            if self._is_hadamard:
                rings = scratch("rings", 3, stencil.n_taps - 1, stop - start)
                stencil.gather_rings(points, start, stop, rings)
                high = hadamard_bands(points[:, start:stop], rings, own_low)
            else:
                data = stencil.gather(points, start, stop, scratch("data", 3, stencil.n_taps, stop - start))
                coefficients = apply_matrix(self._typed_masks, data)
                if own_low is not None:
                    own_low[:] = coefficients[:, 0]
                high = coefficients[:, 1:]
            visit(start // self._blocks.block_size, high)
            self._weigh(high, detail[:, :, start:stop])

        self._blocks.run(kernel, stencil.n_sites)
        if self._incidence is None:
            return low if site_low is None else site_low, detail[0]
        assert site_low is not None
        return self._incidence.mean(np.broadcast_to(site_low, detail.shape), low), self._incidence.mean(
            detail
        )

    def pending(self, chunks: Sequence[Bands]) -> NDArray[np.floating]:
        """Return what given high bands add to the rebuilt surface; see `Level`."""
        detail = np.empty((len(self._rows), 3, self.n_sites), self._dtype)
        for part, chunk in zip(self.sites, chunks, strict=True):
            self._weigh(chunk, detail[:, :, part])
        return detail[0] if self._incidence is None else self._incidence.mean(detail)

    def _weigh(self, high: Bands, out: NDArray[np.floating]) -> None:
        """Write the sums of v times the high bands, shape (rows, 3, n)."""
        for row, total in zip(self._rows[:, 1:], out, strict=True):
            used = np.flatnonzero(row)
            if not len(used):
                total[:] = 0
            for place, band in enumerate(used):
                term = high[:, band] if row[band] == 1 else row[band] * high[:, band]
                np.add(total, term, out=total) if place else np.copyto(total, term)

    def backward(self, next_low: Points | None, pending: NDArray[np.floating]) -> Points:
        """Rebuild the surface; see `Level`."""
        return pending if next_low is None else next_low + pending

    def weighted_adjoint(self, next_low: Points, chunks: Sequence[Bands]) -> Points:
        """Apply the transposed matrix: all measures are 1."""
        return self.adjoint(next_low, chunks)

    def adjoint(self, next_low: Points, chunks: Sequence[Bands]) -> Points:
        """Apply the transposed matrix of this level.

        For cell-centered banks `next_low` is given on vertices like everywhere, and goes back through the
        transposed averages.
        """
        stencil = self.stencil
        result = np.zeros((3, stencil.n_vertices))
        if self._incidence is None:
            site_low = next_low
        else:
            site_low = self._incidence.transposed_mean(next_low)
            result += np.where(self._incidence.is_served, 0.0, next_low)
        spread = np.zeros((3, stencil.n_points))
        for part, chunk in zip(self.sites, chunks, strict=True):
            coefficients = np.concatenate((site_low[:, None, part], chunk), axis=1)
            taps = np.matmul(self._masks.T, coefficients)
            index = stencil.slots[:, part].ravel()
            for axis in range(3):
                spread[axis] += np.bincount(index, taps[axis].ravel(), stencil.n_points)
        result += spread[:, : stencil.n_vertices]
        owner = np.repeat(np.arange(stencil.n_vertices, stencil.n_points), np.diff(stencil.virtual_offset))
        for axis in range(3):
            weights = stencil.virtual_weight * spread[axis, owner]
            result[axis] += np.bincount(stencil.virtual_vertex, weights, stencil.n_vertices)
        return result.astype(self._dtype)


class _Incidence:
    """The sites in which each vertex is a central tap."""

    def __init__(self, stencil: Stencil, n_centers: int, dtype: DTypeLike) -> None:
        central = stencil.slots[:n_centers].ravel()  # index: center * n_sites + site
        entries = np.flatnonzero(central < stencil.n_vertices)
        vertex = central[entries]
        self._entries = entries[np.argsort(vertex, kind="stable")]
        counts = np.bincount(vertex, minlength=stencil.n_vertices)
        self.is_served = counts > 0
        self._begin = starts(counts)[self.is_served]
        self._share = np.divide(1.0, counts[self.is_served]).astype(dtype)
        self._shape = (n_centers, stencil.n_sites)

    def mean(self, values: NDArray[np.floating], rest: Points | None = None) -> Points:
        """Average site values, shape (centers, 3, n_sites), to vertices; others take `rest`, or 0."""
        flat = values.transpose(1, 0, 2).reshape(3, -1)
        result = np.zeros((3, len(self.is_served)), values.dtype) if rest is None else rest.copy()
        if len(self._begin):
            result[:, self.is_served] = (
                np.add.reduceat(flat[:, self._entries], self._begin, axis=1) * self._share
            )
        return result

    def transposed_mean(self, values: Points) -> Points:
        """Apply the transposed average of a low-pass, from vertices to sites, shape (3, n_sites)."""
        counts = np.diff(np.append(self._begin, len(self._entries)))
        per_entry = np.repeat(values[:, self.is_served] * self._share, counts, axis=1)
        site = self._entries % self._shape[1]
        return np.stack([np.bincount(site, row, self._shape[1]) for row in per_entry])
