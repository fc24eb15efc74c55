# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Results of one mesh at several strengths, and the pictures that lie between them. Knows no Blender."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from ...core.settings import DenoiseSettings

FARTHEST = 2.0
"""Where the slider *Strength* ends: what is known there makes all of its values lie between known ones."""

MOST = 8
"""Results that are kept, of which each has the size of the positions."""


class KnownResults:
    """Results that differ in *Strength* alone.

    A result follows *Strength* smoothly, from the mesh itself at 0. So what lies between two known results is
    a picture that costs nothing, while the right one is computed.

    Parameters
    ----------
    original : ndarray, shape (N, 3), float32
        The mesh itself.
    """

    def __init__(self, original: NDArray[np.float32]) -> None:
        self._original = original
        self._alike: DenoiseSettings | None = None
        self._found: dict[float, NDArray[np.float32]] = {}  # by strength, the one of longest ago first

    def add(self, settings: DenoiseSettings, positions: NDArray[np.float32]) -> None:
        """Keep a result, shape (N, 3); those with other settings than *Strength* are forgotten."""
        if settings.method != "AUTO":
            return
        alike = _without_strength(settings)
        if alike != self._alike:
            self._alike = alike
            self._found.clear()
        self._found.pop(settings.strength, None)
        self._found[settings.strength] = positions
        while len(self._found) > MOST:
            self._found.pop(next(iter(self._found)))

    def between(self, settings: DenoiseSettings) -> NDArray[np.float32] | None:
        """Return the picture, shape (N, 3), on the line between the known results to both sides.

        None if nothing is known of such settings, or nothing as strong as that.
        """
        if not self._knows(settings):
            return None
        strength = settings.strength
        found = {0.0: self._original, **self._found}
        above = min((each for each in found if each >= strength), default=None)
        if above is None:
            return None
        if above == strength:
            return found[above]
        below = max(each for each in found if each < strength)
        share = (strength - below) / (above - below)
        picture: NDArray[np.float32] = found[below] + (found[above] - found[below]) * found[above].dtype.type(
            share
        )
        return picture

    def farthest(self, settings: DenoiseSettings) -> DenoiseSettings | None:
        """Return settings whose result should be known too; None if it is, or if nothing is."""
        if not self._knows(settings) or max(self._found) >= FARTHEST:
            return None
        # One thread: nobody waits for it, and Blender has the others.
        return settings.with_changes(strength=FARTHEST, threads=1)

    def _knows(self, settings: DenoiseSettings) -> bool:
        """Return whether results with such settings are known."""
        return bool(self._found) and settings.method == "AUTO" and _without_strength(settings) == self._alike


def _without_strength(settings: DenoiseSettings) -> DenoiseSettings:
    """Return the settings that have to be the same; the number of threads changes no result."""
    return settings.with_changes(strength=1.0, threads=0)
