# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Soft shrinkage of frame coefficients: the proximal maps of the three norms |W S|_1 in the paper."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..errors import SettingError

SHRINKAGES = ("BANDS", "VECTOR", "SCALAR")
SEPARABLE = ("VECTOR", "SCALAR")
"""Shrinkages that treat every band by itself, so that bands with v = 0 can be left out (Remark 4.1)."""


def shrink(coefficients: NDArray[np.floating], threshold: float, kind: str) -> NDArray[np.floating]:
    """Shrink high-pass coefficients towards zero.

    Parameters
    ----------
    coefficients : ndarray, shape (3, H, n)
        Coordinates, high bands, vertices; not modified.
    threshold : float
        Length nu >= 0 by which norms are shortened, in the unit of the coefficients.
    kind : {"BANDS", "VECTOR", "SCALAR"}
        BANDS (4.5) shortens the norm over the bands of each coordinate, VECTOR (Algorithm-Tri-2) the length
        of each band's vector, SCALAR (5.5) each number.

    Returns
    -------
    ndarray, shape (3, H, n)
        T_nu of the coefficients.

    Raises
    ------
    SettingError
        If the kind is not known or the threshold is negative.
    """
    return coefficients - clipped(coefficients, threshold, kind)


def clipped(
    coefficients: NDArray[np.floating],
    threshold: float,
    kind: str,
    group_starts: NDArray[np.intp] | None = None,
) -> NDArray[np.floating]:
    """Return what shrinkage takes away, y - T_nu(y): the coefficients cut off at norm nu, shape (3, H, n).

    It is the projection onto the ball of radius nu in the dual norm, and the next b of split Bregman. With
    `group_starts`, VECTOR takes the bands from each start to the next as one longer vector.
    """
    if kind not in SHRINKAGES:
        raise SettingError(f"The shrinkage is {kind!r}; choose one of {', '.join(SHRINKAGES)}.")
    if not threshold >= 0:
        raise SettingError(f"The threshold is {threshold}; it must not be negative.")
    if not coefficients.shape[1]:
        return coefficients.copy()  # a vertex without neighbors has no bands
    nu = coefficients.dtype.type(threshold)
    if kind == "SCALAR":
        return np.clip(coefficients, -nu, nu)
    axis = 0 if kind == "VECTOR" else 1
    # Coordinate by coordinate: numpy sums over a short axis much faster this way than by a reduction.
    parts = coefficients if axis == 0 else coefficients.transpose(1, 0, 2)
    norm = parts[0] * parts[0]
    for part in parts[1:]:
        norm += part * part
    if axis == 0 and group_starts is not None:
        sizes = np.diff(group_starts, append=len(norm))
        norm = np.repeat(np.add.reduceat(norm, group_starts, axis=0), sizes, axis=0)
    np.sqrt(norm, out=norm)
    np.maximum(norm, max(nu, np.finfo(nu.dtype).tiny), out=norm)
    np.divide(nu, norm, out=norm)
    return coefficients * np.expand_dims(norm, axis)
