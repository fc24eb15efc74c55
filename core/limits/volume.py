# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The height of the offset along the normals that keeps the volume of a closed mesh."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

VOLUME_TOLERANCE = 1e-7
"""Relative error of the volume at which the search for the offset ends."""

STEPS = 30

SCAN = (0.0, 0.0625, 0.125, 0.25, 0.5, 1.0, 2.0, 4.0)
"""Offsets in mean edge lengths, to both sides, among which a change of sign is looked for if secants fail."""

BISECTIONS = 50


def volume_offset(
    volume_at: Callable[[float], float], target: float, area: float, start: float = 0.0
) -> float:
    """Return the offset at which a surface has a volume.

    Parameters
    ----------
    volume_at : callable
        `volume_at(offset)`, the volume of the surface with this offset.
    target : float
        The volume that it should have.
    area : float
        About the area that is offset, which says how the volume grows with the offset.
    start : float
        Where to begin.

    Returns
    -------
    float
        By secants, or else by halving an interval around it; where there is none, the closest one seen.
    """
    tolerance = VOLUME_TOLERANCE * abs(target)
    errors: dict[float, float] = {}

    def error_at(offset: float) -> float:
        if offset not in errors:
            errors[offset] = volume_at(offset) - target
        return errors[offset]

    def closest() -> float:
        return min(errors, key=lambda offset: (abs(errors[offset]), abs(offset)))

    if abs(error_at(start)) <= tolerance or not area:
        return start
    old, new = start, start - error_at(start) / area
    for _ in range(STEPS):
        error, old_error = error_at(new), error_at(old)
        if abs(error) <= tolerance or error == old_error:
            break
        # A limit on displacements makes the volume flatter; steps then must not grow without bounds.
        longest = 4.0 * abs(new - old)
        step = error * (new - old) / (error - old_error)
        old, new = new, new - min(max(step, -longest), longest)
    if abs(errors[closest()]) <= tolerance:
        return closest()
    grid = sorted({sign * offset for offset in SCAN for sign in (-1.0, 1.0)})
    brackets = [
        (low, high) for low, high in pairwise(grid) if (error_at(low) < 0.0) != (error_at(high) < 0.0)
    ]
    if brackets:
        low, high = min(brackets, key=lambda pair: abs(pair[0] + pair[1]))
        is_below = error_at(low) < 0.0
        for _ in range(BISECTIONS):
            middle = 0.5 * (low + high)
            if abs(error_at(middle)) <= tolerance:
                break
            low, high = (middle, high) if (error_at(middle) < 0.0) == is_below else (low, middle)
    return closest()
