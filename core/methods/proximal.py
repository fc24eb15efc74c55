# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Penalties g on frame coefficients, by their proximal operators argmin_x g(x) + |x - y|^2 / 2 step.

Each treats groups of numbers by their norm: "BANDS" all bands of a coordinate at a vertex (4.5), "VECTOR" the
coordinates of a band (Algorithm-Tri-2), "SCALAR" each number (5.5).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ..arguments import as_identifier
from ..errors import SettingError
from ..settings import choices
from ..transform.level import Bands
from ..value_checks import check_choice, check_number

SHRINKAGES = tuple(choice.identifier for choice in choices.SHRINKAGES)
"""What is shrunk together, by name."""

SEPARABLE = ("VECTOR", "SCALAR")
"""Shrinkages that treat every band by itself, so that bands with v = 0 can be left out (Remark 4.1)."""

Groups = NDArray[np.intp] | None
"""Where groups of bands begin that "VECTOR" takes as one longer vector; None for single bands."""


class Penalty(Protocol):
    """What split Bregman needs of a penalty g."""

    def removed(self, bands: Bands, mu: float, groups: Groups = None) -> Bands:
        """Return y - prox(y) for the step 1 / mu, what the operator takes away, shape (3, H, n)."""
        ...

    def value(self, bands: Bands, groups: Groups = None) -> float:
        """Return g, summed over the bands."""
        ...


class _Threshold:
    """What the thresholds below have in common: a weight, and what is shrunk together, in any case."""

    weight: float
    kind: str

    def __post_init__(self) -> None:
        object.__setattr__(self, "kind", as_identifier(self.kind))
        check_choice("The shrinkage", self.kind, SHRINKAGES)
        check_number("The weight", self.weight, 0.0)

    def __call__(self: Penalty, bands: Bands, step: float = 1.0) -> Bands:
        """Apply the proximal operator."""
        return bands - self.removed(bands, 1.0 / step)


@dataclass(frozen=True)
class SoftThreshold(_Threshold):
    """g = weight * sum of norms: norms are shortened by weight * step.

    Examples
    --------
    >>> bands = np.array([3.0, 0.0, 4.0]).reshape(3, 1, 1)
    >>> SoftThreshold(1.0)(bands).ravel().tolist()
    [2.4, 0.0, 3.2]
    >>> SoftThreshold(1.0, "scalar")(bands).ravel().tolist()
    [2.0, 0.0, 3.0]
    """

    weight: float
    kind: str = "VECTOR"

    def removed(self, bands: Bands, mu: float, groups: Groups = None) -> Bands:
        """See `Penalty`.

        It is the projection onto the ball of radius nu = weight / mu in the dual norm, the next b of split
        Bregman.
        """
        if not bands.shape[1]:
            return bands.copy()  # a vertex without neighbors has no bands
        nu = bands.dtype.type(self.weight / mu)
        if self.kind == "SCALAR":
            return np.clip(bands, -nu, nu)
        axis = 0 if self.kind == "VECTOR" else 1
        # Coordinate by coordinate: numpy sums over a short axis much faster this way than by a reduction.
        parts = bands if axis == 0 else bands.transpose(1, 0, 2)
        norm = parts[0] * parts[0]
        for part in parts[1:]:
            norm += part * part
        if axis == 0 and groups is not None:
            norm = np.repeat(np.add.reduceat(norm, groups, axis=0), np.diff(groups, append=len(norm)), axis=0)
        np.sqrt(norm, out=norm)
        np.maximum(norm, max(nu, np.finfo(nu.dtype).tiny), out=norm)
        np.divide(nu, norm, out=norm)
        return bands * np.expand_dims(norm, axis)

    def value(self, bands: Bands, groups: Groups = None) -> float:
        """See `Penalty`."""
        return self.weight * float(norms(bands, self.kind, groups).sum())


@dataclass(frozen=True)
class HardThreshold(_Threshold):
    """g = weight * number of norms that are not 0: those up to (2 weight step)^(1/2) become 0.

    Examples
    --------
    >>> HardThreshold(8.0, "SCALAR")(np.array([3.0, 4.5, -5.0]).reshape(3, 1, 1)).ravel().tolist()
    [0.0, 4.5, -5.0]
    """

    weight: float
    kind: str = "VECTOR"

    def removed(self, bands: Bands, mu: float, groups: Groups = None) -> Bands:
        """See `Penalty`."""
        is_small = norms(bands, self.kind, groups) <= np.sqrt(2.0 * self.weight / mu)
        return np.where(spread(is_small, self.kind, bands.shape[1], groups), bands, bands.dtype.type(0))

    def value(self, bands: Bands, groups: Groups = None) -> float:
        """See `Penalty`."""
        return self.weight * float(np.count_nonzero(norms(bands, self.kind, groups)))


@dataclass(frozen=True)
class FirmThreshold(_Threshold):
    """The minimax concave penalty: as soft near 0, and nothing is taken from norms of `limit` or more.

    g(x) = weight |x| - x^2 weight / 2 limit up to the limit, and constant beyond it.

    Examples
    --------
    >>> FirmThreshold(1.0, 3.0, "SCALAR")(np.array([0.5, 2.0, 4.0]).reshape(3, 1, 1)).ravel().tolist()
    [0.0, 1.5, 4.0]
    """

    weight: float
    limit: float
    kind: str = "VECTOR"

    def __post_init__(self) -> None:
        super().__post_init__()
        check_number("The limit", self.limit, 0.0)

    def removed(self, bands: Bands, mu: float, groups: Groups = None) -> Bands:
        """See `Penalty`."""
        least = self.weight / mu
        if not least < self.limit:
            raise SettingError(
                f"The limit is {self.limit:g}; it must be larger than the weight over mu, which is {least:g}."
            )
        norm = norms(bands, self.kind, groups)
        share = least * (self.limit - norm) / ((self.limit - least) * np.maximum(norm, least))
        share = np.where(norm <= least, 1.0, np.maximum(share, 0.0)).astype(bands.dtype)
        return bands * spread(share, self.kind, bands.shape[1], groups)

    def value(self, bands: Bands, groups: Groups = None) -> float:
        """See `Penalty`."""
        norm = np.minimum(norms(bands, self.kind, groups), self.limit)
        return self.weight * float((norm - norm * norm / (2.0 * self.limit)).sum())


@dataclass(frozen=True)
class OwnPenalty:
    """A proximal operator of one's own, `prox(bands, step)`, and its penalty, `penalty(bands)`, if known."""

    prox: Callable[[Bands, float], Bands]
    penalty: Callable[[Bands], float] | None = None

    def removed(self, bands: Bands, mu: float, groups: Groups = None) -> Bands:
        """See `Penalty`."""
        return bands - self.prox(bands.copy(), 1.0 / mu)

    def value(self, bands: Bands, groups: Groups = None) -> float:
        """See `Penalty`; NaN where it is not known."""
        return float("nan") if self.penalty is None else float(self.penalty(bands))


def norms(bands: Bands, kind: str, groups: Groups = None) -> NDArray[np.float64]:
    """Return what is shrunk: (3, n) for BANDS, (H or groups, n) for VECTOR, (3, H, n) for SCALAR."""
    wide = bands.astype(np.float64)
    if kind == "SCALAR":
        return np.abs(wide)
    squares = (wide * wide).sum(axis=1 if kind == "BANDS" else 0)
    if kind == "VECTOR" and groups is not None and len(squares):
        squares = np.add.reduceat(squares, groups, axis=0)
    return np.sqrt(squares)


def spread(values: NDArray[Any], kind: str, n_bands: int, groups: Groups = None) -> NDArray[Any]:
    """Return values for norms, see `norms`, in a shape that multiplies the bands (3, H, n)."""
    if kind == "SCALAR":
        return values
    if kind == "BANDS":
        return values[:, None]
    if groups is not None:
        values = np.repeat(values, np.diff(groups, append=n_bands), axis=0)
    return values[None]
