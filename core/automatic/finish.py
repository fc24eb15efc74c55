# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What may follow recipes: further passes from their own result, and vertices held in place."""

from __future__ import annotations

from typing import NamedTuple


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
        The share of the motion within the surface that is taken back; see `hold.held_in_place`.
    """

    label: str = ""
    passes: tuple[Pass, ...] = ()
    share: float = 1.0
    held: float = 0.0

    @property
    def passed(self) -> tuple[tuple[Pass, ...], float]:
        """The passes and their share."""
        return self.passes, self.share

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
