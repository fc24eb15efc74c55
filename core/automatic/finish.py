# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What may follow recipes: further passes from their own result, and vertices back to their places."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray


class Pass(NamedTuple):
    """A pass of shrinkage whose pilot is a result, and the fit of its vertices to what the pass gives.

    The parameters are those of `Recipe`.
    """

    range_sigma: float
    caution: float
    n_bands: int
    vertex_steps: int


BROAD = Pass(0.35, 1.5, 7, 20)
FINE = Pass(0.25, 1.0, 6, 20)


class Finish(NamedTuple):
    """What follows recipes.

    Attributes
    ----------
    label : str
        The words for it, "" for nothing.
    passes : tuple of Pass
        Further passes, one after the other.
    share : float
        How much of what they give counts; the rest is what they began with.
    held : float
        The share of the motion within the surface that is taken back.
    """

    label: str = ""
    passes: tuple[Pass, ...] = ()
    share: float = 1.0
    held: float = 0.0

    @property
    def is_quick(self) -> bool:
        """Whether it serves large meshes."""
        return not self.passes


def _all_finishes() -> tuple[Finish, ...]:
    """Return all combinations; what is plainer comes first, as ties go to the first."""
    refined = (("refined", (BROAD,)), ("refined finely", (FINE,)), ("refined twice", (BROAD, FINE)))
    shares = (("half ", 0.5), ("", 1.0))
    ways = [
        ("", (), 1.0),
        *((half + name, passes, share) for name, passes in refined for half, share in shares),
    ]
    holds = (("", 0.0), ("half in place", 0.5), ("in place", 1.0))
    return tuple(
        Finish(", ".join(filter(None, (way, hold))), passes, share, held)
        for way, passes, share in ways
        for hold, held in holds
    )


FINISHES = _all_finishes()
N_PASSES = len({finish.passes for finish in FINISHES if finish.passes})
"""Passes that all of them take, since those that begin alike share what they begin with."""


def held_in_place(
    points: NDArray[np.floating], noisy: NDArray[np.floating], normals: NDArray[np.floating], share: float
) -> NDArray[np.floating]:
    """Return positions with a share of their motion within the surface taken back.

    Low-passes, and averages of any kind, even out triangles: on irregular meshes vertices slide within the
    surface by several times the noise, away from where they were measured. Where they sit says nothing about
    the shape, so that to take it back costs nothing but the noise that there is within the surface.

    Parameters
    ----------
    points, noisy : ndarray, shape (3, N)
        Positions after and before.
    normals : ndarray, shape (3, N)
        Unit normals of the surface afterwards at the vertices; vertices with zeros go all the way back.
    share : float
        From 0 to 1.

    Returns
    -------
    ndarray, shape (3, N)
    """
    motion = points - noisy
    within = motion - normals * np.einsum("cn,cn->n", normals, motion)
    return points - points.dtype.type(share) * within
