# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The search for the setting of a baseline that comes closest to the clean model."""

from typing import NamedTuple

from cases import Case, Measurement
from methods import Baseline, Reading

FULL_GRID = 3000
"""Up to this many faces every value of the knob is tried; above, the search walks."""


class Found(NamedTuple):
    """The best reading, how good it is, and how many were tried."""

    reading: Reading
    measured: Measurement
    n_tried: int


def tune(method: Baseline, case: Case, is_full: bool | None = None) -> Found:
    """Return the reading of a baseline with the smallest angle, the default's included.

    On small models every value of the knob is tried. On others the search starts in the middle and walks to
    lower and to higher values as long as the angle falls; large ones have fewer values. In a run with one
    value, readings stop after a number without improvement, the method's patience.

    Parameters
    ----------
    method : Baseline
        The method.
    case : Case
        The case, with its clean model.
    is_full : bool, optional
        Try every value; by default according to the size of the model.
    """
    n_tried = 0
    best_of: dict[int, Found] = {}
    values = method.values_on(case)
    if is_full is None:
        is_full = method.is_quick or case.model.clean.n_faces <= FULL_GRID

    def angle(k: int) -> float:
        nonlocal n_tried
        if k not in best_of:
            best, since = None, 0
            for reading in method.readings(case, values[k]):
                measured = case.measure(reading.positions)
                n_tried += 1
                since += 1
                if best is None or measured.angle < best.measured.angle:
                    best, since = Found(reading, measured, 0), 0
                if since >= method.patience_on(case):
                    break
            best_of[k] = best
        return best_of[k].measured.angle

    last = len(values) - 1
    if is_full:
        for k in range(last + 1):
            angle(k)
    else:
        middle = last // 2
        for step in (-1, 1):
            k = middle
            while 0 <= k + step <= last and angle(k + step) < angle(k):
                k += step
    reading = method.run(case, method.defaults)
    candidates = [*best_of.values(), Found(reading, case.measure(reading.positions), 0)]
    return min(candidates, key=lambda found: found.measured.angle)._replace(n_tried=n_tried + 1)
