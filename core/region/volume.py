# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The height of the offset along the normals that keeps the volume of a closed mesh."""

from __future__ import annotations

from collections.abc import Callable

VOLUME_TOLERANCE = 1e-7
"""Relative error of the volume at which the search for the offset ends."""

STEPS = 30


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
        About the area that is offset, which says how the volume changes; of the sign that makes a larger
        offset a larger volume.
    start : float
        Where to begin.

    Returns
    -------
    float
        By secants; where they do not lead to the volume, the offset that came closest.
    """
    tolerance = VOLUME_TOLERANCE * abs(target)
    old, old_error = start, volume_at(start) - target
    best, least = old, abs(old_error)
    if least <= tolerance or not area:
        return best
    new = old - old_error / area
    for _ in range(STEPS):
        error = volume_at(new) - target
        if abs(error) < least:
            best, least = new, abs(error)
        if abs(error) <= tolerance or error == old_error:
            break
        step = error * (new - old) / (error - old_error)
        # A limit on displacements makes the volume flatter; steps then must not grow without bounds.
        longest = 4.0 * abs(new - old)
        old, old_error = new, error
        new -= min(max(step, -longest), longest)
    return best
