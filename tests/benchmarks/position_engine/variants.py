# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is compared: the position engine as it is, and with something changed."""

from typing import Any, NamedTuple

import position_sources  # noqa: F401
from framelet.core import PRESETS, DenoiseSettings

DECAY = 0.4
"""λ of a level over that of the level before: a low-pass of seven taps leaves sqrt(10) / 8 of white noise."""


class Variant(NamedTuple):
    """One way to denoise, of which only λ is free."""

    name: str
    changes: dict[str, Any] = {}
    """Settings that differ from those of Tri-2 or Quad-2."""
    firm: float = 0.0
    """Coefficients that are as long as this many thresholds, or longer, stay whole; 0 for soft shrinkage."""
    rounds: int = 1
    """Runs from the noisy positions, each of which knows the result of the one before."""
    reweights: bool = False
    """Whether a round lowers its thresholds where coefficients of the round before are large."""
    refreshes: bool = False
    """Whether a round chooses its stencils on the result of the round before."""
    decay: float = 1.0
    """λ of each level over that of the level before."""

    def settings(self, is_quad: bool) -> DenoiseSettings:
        """Return the settings on a mesh of quads or of triangles."""
        preset = PRESETS["QUAD_2" if is_quad else "TRI_2"].settings
        return preset.with_changes(**self.changes, threads=1)

    @property
    def is_plain(self) -> bool:
        """Whether the settings say it all, so that `denoise` can do the same."""
        return not self.firm and self.rounds == 1 and self.decay == 1.0


ADAPTIVE = {"frame": "ADAPTIVE", "stencil": "ADAPTIVE"}
PLAIN = Variant("As it is")

VARIANTS = (
    PLAIN,
    Variant("From Noise", {"tuning": "NOISE"}),
    Variant("5 iterations", {"iterations": 5}),
    Variant("7 iterations", {"iterations": 7}),
    Variant("20 iterations", {"iterations": 20}),
    Variant("Bands", {"shrinkage": "BANDS"}),
    Variant("Scalar", {"shrinkage": "SCALAR"}),
    Variant("Firm, 2", firm=2.0),
    Variant("Firm, 4", firm=4.0),
    Variant("Reweighted, 2 rounds", rounds=2, reweights=True),
    Variant("Reweighted, 3 rounds", rounds=3, reweights=True),
    Variant("Refreshed, 2 rounds", rounds=2, refreshes=True),
    Variant("Refreshed, 3 rounds", rounds=3, refreshes=True),
    Variant("Firm, 4, refreshed, 2 rounds", firm=4.0, rounds=2, refreshes=True),
    Variant("Reweighted, refreshed, 2 rounds", rounds=2, reweights=True, refreshes=True),
    Variant("Reweighted, refreshed, 3 rounds", rounds=3, reweights=True, refreshes=True),
    Variant(
        "7 iterations, reweighted, refreshed, 3 rounds",
        {"iterations": 7},
        rounds=3,
        reweights=True,
        refreshes=True,
    ),
    Variant("2 levels", {"levels": 2}),
    Variant("3 levels", {"levels": 3}),
    Variant("2 levels, falling λ", {"levels": 2}, decay=DECAY),
    Variant("3 levels, falling λ", {"levels": 3}, decay=DECAY),
    Variant("Adaptive", ADAPTIVE),
    Variant("Adaptive, From Noise", {**ADAPTIVE, "tuning": "NOISE"}),
    Variant("Adaptive, 20 iterations", {**ADAPTIVE, "iterations": 20}),
    Variant("Adaptive, 40 iterations", {**ADAPTIVE, "iterations": 40}),
    Variant("Adaptive, 20 iterations, firm, 4", {**ADAPTIVE, "iterations": 20}, firm=4.0),
    Variant(
        "Adaptive, 20 iterations, reweighted, 2 rounds",
        {**ADAPTIVE, "iterations": 20},
        rounds=2,
        reweights=True,
    ),
    Variant("Adaptive, 2 levels", {**ADAPTIVE, "levels": 2}),
    Variant(
        "Adaptive, 20 iterations, 2 levels, falling λ",
        {**ADAPTIVE, "levels": 2, "iterations": 20},
        decay=DECAY,
    ),
)
BY_NAME = {variant.name: variant for variant in VARIANTS}
