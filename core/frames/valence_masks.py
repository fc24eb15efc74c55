# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Masks that fit the valence: exactly tight on every mesh, without virtual points.

For a vertex with K neighbors take a low-pass w = (w_c, w_r, ..., w_r) > 0 that sums to 1 and any matrix M_K
with first row w and M_K' M_K = diag(w). If every tap is one real vertex p[k, t], then for any measure m' > 0

    sum_k m'_k |M D_k|^2 = sum_k m'_k sum_t w_t |V[p[k, t]]|^2 = sum_p m_p |V_p|^2

with m_p = sum over (k, t) with p[k, t] = p of w_t m'_k: the transform is a tight frame from l2(m) to l2(m').
"""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

from .mask_product import apply_matrix

CENTER_WEIGHT = 0.25
"""Low-pass weight of the vertex; its neighbors share the rest. For K = 6 it is the box spline's low-pass."""

LARGEST_MATRIX = 32
"""Valence up to which masks are written out as a matrix."""


def low_pass_weights(valence: int) -> NDArray[np.float64]:
    """Return the low-pass w of a valence, shape (K + 1,), float64; (1,) for valence 0."""
    if valence == 0:
        return np.ones(1)
    return np.array([CENTER_WEIGHT] + [(1.0 - CENTER_WEIGHT) / valence] * valence)


@cache
def harmonic_masks(valence: int) -> NDArray[np.float64]:
    """Return the masks Q_K diag(sqrt(w)) whose rows are ring-against-center and the real ring harmonics.

    Row 0 is the low-pass, row 1 the ring against the center, then cosine and sine of frequency 1, 2, ...; an
    even valence ends with the alternating signs. On a regular flat ring all but frequency 1 vanish.

    Returns
    -------
    ndarray, shape (K + 1, K + 1), float64
    """
    weights = low_pass_weights(valence)
    rows = [np.sqrt(weights)]
    if valence:
        ring = np.sqrt(weights[0] / valence)
        rows.append(np.array([np.sqrt(1.0 - weights[0])] + [-ring] * valence))
    angle = 2.0 * np.pi * np.arange(valence) / max(valence, 1)
    for frequency in range(1, valence // 2 + 1):
        waves = [np.cos(frequency * angle)]
        if 2 * frequency < valence:
            waves.append(np.sin(frequency * angle))
        rows += [np.concatenate(([0.0], wave / np.linalg.norm(wave))) for wave in waves]
    masks = np.array(rows) * np.sqrt(weights)
    masks.flags.writeable = False
    return masks


def harmonic_groups(valence: int) -> NDArray[np.intp]:
    """Return where the groups of high bands begin: cosine and sine of one frequency belong together.

    Their joint norm does not depend on where the numbering of the ring starts.
    """
    return np.concatenate(([0], np.arange(1, valence, 2))).astype(np.intp)


class HarmonicBank:
    """Applies `harmonic_masks`; for large or unordered rings a reflection takes their place.

    The reflection I - 2 u u' that maps sqrt(w) to the first unit vector is orthogonal, needs no matrix, and
    treats all neighbors alike, so that no ring order is needed: its bands are the neighbors one by one.

    Parameters
    ----------
    valence : int
        K, the number of neighbors.
    is_ordered : bool
        Whether the neighbors are in ring order.
    """

    def __init__(self, valence: int, is_ordered: bool = True) -> None:
        self.valence = valence
        self.weights = low_pass_weights(valence)
        self.n_bands = valence + 1
        self._masks = harmonic_masks(valence) if is_ordered and valence <= LARGEST_MATRIX else None
        self.group_starts = harmonic_groups(valence) if self._masks is not None and valence else None
        # Frequency 1 measures how the neighbors lie in the tangent plane, not how the surface bends:
        # shrinking it would only pull vertices together. The paper's algorithms never use it either.
        self.unpenalized = slice(1, 3) if self._masks is not None and valence > 2 else slice(0, 0)
        root = np.sqrt(self.weights)
        self._root = root
        normal = root - np.eye(1, valence + 1)[0]
        length = np.linalg.norm(normal)
        self._normal = normal / length if length > 0 else normal

    def apply(self, data: NDArray[np.floating]) -> NDArray[np.floating]:
        """Return M D, shape (3, K + 1, n), of data of the same shape."""
        if self._masks is not None:
            return apply_matrix(self._masks.astype(data.dtype), data)
        return self._reflect(data * self._root.astype(data.dtype)[:, None])

    def apply_transposed(self, coefficients: NDArray[np.floating]) -> NDArray[np.floating]:
        """Return M' alpha, shape (3, K + 1, n)."""
        if self._masks is not None:
            masks = np.ascontiguousarray(self._masks.T, coefficients.dtype)
            return apply_matrix(masks, coefficients)
        return self._reflect(coefficients) * self._root.astype(coefficients.dtype)[:, None]

    def _reflect(self, data: NDArray[np.floating]) -> NDArray[np.floating]:
        normal = self._normal.astype(data.dtype)
        return data - 2.0 * normal[:, None] * np.einsum("t,ctn->cn", normal, data)[:, None]


class PairwiseBank:
    """Low-pass and all weighted differences of a stencil: |L p|^2 + sum w_i w_j |p_i - p_j|^2 = sum w_i
    |p_i|^2.

    Its masks are w and, for i < j, sqrt(w_i w_j) (delta_i - delta_j); it is tight for any weights that sum to
    1.

    Parameters
    ----------
    valence : int
        K, the number of neighbors.
    weights : ndarray, shape (K + 1,), optional
        Row-stochastic weights; by default those of the low-pass.
    """

    def __init__(self, valence: int, weights: NDArray[np.float64] | None = None) -> None:
        self.valence = valence
        self.weights = low_pass_weights(valence) if weights is None else weights
        self._first, self._second = np.triu_indices(valence + 1, 1)
        self._scale = np.sqrt(self.weights[self._first] * self.weights[self._second])
        self.n_bands = 1 + len(self._first)
        self.group_starts: NDArray[np.intp] | None = None
        self.unpenalized = slice(0, 0)

    def apply(self, data: NDArray[np.floating]) -> NDArray[np.floating]:
        """Return low-pass and differences, shape (3, 1 + K (K + 1) / 2, n), of data (3, K + 1, n)."""
        low = np.einsum("t,ctn->cn", self.weights.astype(data.dtype), data)[:, None]
        apart = data[:, self._first] - data[:, self._second]
        apart *= self._scale.astype(data.dtype)[:, None]
        return np.concatenate((low, apart), axis=1)

    def apply_transposed(self, coefficients: NDArray[np.floating]) -> NDArray[np.floating]:
        """Return M' alpha, shape (3, K + 1, n)."""
        dtype = coefficients.dtype
        result = self.weights.astype(dtype)[:, None] * coefficients[:, :1]
        scaled = coefficients[:, 1:] * self._scale.astype(dtype)[:, None]
        begin = 0
        for slot in range(self.valence):
            end = begin + self.valence - slot
            result[:, slot] += scaled[:, begin:end].sum(axis=1)
            result[:, slot + 1 :] -= scaled[:, begin:end]
            begin = end
        return result


FAMILIES = {"ADAPTIVE": HarmonicBank, "PAIRWISE": PairwiseBank}
"""Families of masks that fit the valence, by the name of their frame."""
