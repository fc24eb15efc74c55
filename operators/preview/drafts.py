# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A first picture of a result that takes longer than one waits with a slider. Knows no Blender."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Callable

    from ...core.settings import DenoiseSettings
    from ..run.denoise_job import DenoiseJob, DenoiseOutcome

    Compute = Callable[[DenoiseJob, Callable[[float, float], bool]], DenoiseOutcome]


class Picture(NamedTuple):
    """What came of a job, and whether it is the result or a draft of it."""

    outcome: DenoiseOutcome
    is_final: bool


def draft_of(settings: DenoiseSettings) -> DenoiseSettings | None:
    """Return settings that give a first picture in one pass; None where the result takes no longer."""
    if settings.method != "AUTO" or settings.passes == 1:
        return None
    return settings.with_changes(passes=1)


def compute_pictures(
    job: DenoiseJob,
    compute: Compute,
    show: Callable[[Picture], None],
    note: Callable[[float], None],
    *,
    with_draft: bool = True,
) -> Picture:
    """Carry out a job, after a draft if there is one and it is wanted.

    Parameters
    ----------
    job : DenoiseJob
        What to do.
    compute : callable
        `compute(job, callback)` carries a job out; `callback(fraction, change)` is called meanwhile.
    show : callable
        Gets the draft.
    note : callable
        Gets the share of all work that is done, from 0 to 1.
    with_draft : bool
        Whether a draft is wanted.
    """
    note(0.0)
    draft, start = draft_of(job.settings) if with_draft else None, 0.0
    if draft is not None:
        start = 1.0 / (1 + job.settings.passes)
        show(Picture(compute(replace(job, settings=draft), _between(note, 0.0, start)), is_final=False))
    return Picture(compute(job, _between(note, start, 1.0)), is_final=True)


def _between(note: Callable[[float], None], start: float, end: float) -> Callable[[float, float], bool]:
    """Return a callback that notes a part of the work."""

    def callback(fraction: float, _change: float) -> bool:
        note(start + (end - start) * fraction)
        return False

    return callback
